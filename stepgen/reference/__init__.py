"""
What the firmware must do, from the contract and the datasheets alone: the oracle.

``integer`` predicts it exactly; ``ideal`` is the physics and the bound between the two.
Nothing here is shared with ``stepgen.plan``: an oracle that shares its arithmetic with
what it checks shares its bugs.
"""
