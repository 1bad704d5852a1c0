"""
One module per board, each with its facts as ``BOARD``; a new file here is a new board.
"""
