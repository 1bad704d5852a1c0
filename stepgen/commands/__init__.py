"""
The commands of stepgen, one module each; `stepgen.cli` puts them together.
"""
