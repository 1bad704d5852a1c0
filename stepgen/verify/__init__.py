"""
Proof before flashing: compiles with the real core, simulates, compares with the model.
"""
