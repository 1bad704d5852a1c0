"""
How fast things are on this machine; no figure of it is a test.
"""
