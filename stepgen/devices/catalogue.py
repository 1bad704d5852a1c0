"""
The boards that stepgen knows: every module of the folder ``boards`` is one.
"""

import pkgutil
from importlib import import_module

from stepgen.devices.model import Board


def _load_boards() -> tuple[Board, ...]:
    folder = import_module("stepgen.devices.boards")
    modules = (
        import_module(f"{folder.__name__}.{module.name}")
        for module in pkgutil.iter_modules(folder.__path__)
    )
    return tuple(sorted((module.BOARD for module in modules), key=lambda board: board.name))


# Loaded here, not on the first call: importing the folder `boards` binds that name in
# `stepgen.devices`, and the function of the same name has to come after it.
_BOARDS = _load_boards()


def boards() -> tuple[Board, ...]:
    """
    Return all boards, by name.
    """
    return _BOARDS


def find_board(name: str) -> Board | None:
    """
    Return the board that a spec calls *name* (lower case, exact), or None.
    """
    return next((board for board in _BOARDS if board.name == name), None)
