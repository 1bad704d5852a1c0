"""
What stepgen decides: timer settings, phase tables, kernels, storage, and conflicts.
"""
