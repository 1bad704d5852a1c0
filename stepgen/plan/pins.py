"""
Pins of a board by the names that a spec gives them.
"""

from stepgen.devices import Board


def missing_pin(name: str, board: Board) -> str:
    """
    Return why *name* is no pin of *board* that can be HIGH or LOW, and what to do about it.
    """
    lists = f"`stepgen boards {board.name}` lists them"
    if name.upper() in board.analog_inputs:
        return (
            f"{name} of the {board.title} is an analog input only, which is not HIGH or LOW; take "
            f"another pin, {lists}"
        )
    return f"the {board.title} has no pin {name[:20]}; {lists}"
