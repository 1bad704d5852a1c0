"""
One module per chip, each with its facts as ``MCU``.
"""
