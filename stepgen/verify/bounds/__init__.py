"""
Worst-case bounds of interrupts, worked out from the linked program without running it.
"""
