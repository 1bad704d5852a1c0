"""
``stepgen boards``: the boards, and what one of them has to offer.
"""

from collections.abc import Iterable
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import print_tables
from stepgen.devices import (
    SKETCH_LIBRARIES,
    Board,
    LibraryClaims,
    PortBit,
    Timer,
    Timer16,
    library_claims,
)

EXAMPLE = "Example: stepgen boards uno"

Row = tuple[str, ...]
_KIB = 1024


def boards(
    board: Annotated[
        str | None, typer.Argument(metavar="[BOARD]", help="A board, as a spec names it.")
    ] = None,
) -> None:
    """
    List the boards, or show one's pins, ports and timers and what else uses them.
    """
    if board is None:
        print_tables([("", _HEADING, map(_board_row, api.boards()))])
        return
    found = api.board(board)
    print_tables(
        [
            ("", _HEADING, [_board_row(found)]),
            ("Pins", ("Pin", "Port bit", "Also"), _pin_rows(found)),
            ("Ports", ("Port", "PIN", "DDR", "PORT", "Header pins"), _port_rows(found)),
            (
                "Timers",
                ("Timer", "Bits", "Compare pins", "Capture", "Vectors", "Also used by"),
                _timer_rows(found),
            ),
            (
                "Other libraries (a spec's `uses`)",
                ("Library", "Timers", "Pins", "Vectors"),
                _library_rows(found),
            ),
        ]
    )


_HEADING = ("Board", "Title", "Chip", "Clock", "Flash", "RAM", "16-bit timers")


def _board_row(board: Board) -> Row:
    mcu = board.mcu
    return (
        board.name,
        board.title,
        mcu.title,
        f"{board.f_cpu_hz / 1e6:g} MHz",
        f"{mcu.flash_bytes // _KIB} KiB",
        f"{mcu.ram_bytes / _KIB:g} KiB",
        ", ".join(str(timer.number) for timer in mcu.timers16),
    )


def _pin_rows(board: Board) -> Iterable[Row]:
    yield from ((pin.label, pin.bit.name, ", ".join((*pin.also, *pin.uses))) for pin in board.pins)
    yield from ((label, "-", "analog input only") for label in board.analog_inputs)


def _port_rows(board: Board) -> Iterable[Row]:
    for port in board.mcu.ports:
        labels = [pin.label for pin in board.pins if pin.bit.port == port.letter]
        registers = (port.pin, port.ddr, port.port)
        yield (
            port.letter,
            *(f"{register.address:#04x}" for register in registers),
            ", ".join(labels),
        )


def _timer_rows(board: Board) -> Iterable[Row]:
    others = _claims(board)
    for timer in board.mcu.timers:
        takers = [claims for claims in others if timer.number in claims.timers]
        capture = timer.capture_input if isinstance(timer, Timer16) else None
        yield (
            str(timer.number),
            str(8 * timer.counter_bytes),
            "\n".join(f"{channel} {_pin(board, bit)}" for channel, bit in timer.outputs),
            _pin(board, capture) if capture else "",
            "\n".join(_vectors(timer)),
            "\n".join(_taker(claims, timer.number) for claims in takers),
        )


def _vectors(timer: Timer) -> Iterable[str]:
    more = (timer.compc, timer.capt) if isinstance(timer, Timer16) else ()
    vectors = (timer.ovf, timer.compa, timer.compb, *more)
    return (vector.name for vector in vectors if vector)


def _taker(claims: LibraryClaims, timer: int) -> str:
    """
    Return the library's name and, where it takes its timers one by one, from which object on.
    """
    earlier = claims.timers.index(timer)
    if claims.objects_per_timer is None or not earlier:
        return claims.name
    return f"{claims.name} ({earlier * claims.objects_per_timer + 1} or more)"


def _library_rows(board: Board) -> Iterable[Row]:
    for claims in _claims(board):
        yield (
            claims.name,
            ", ".join(str(number) for number in claims.timers),
            ", ".join(_label(board, bit) for bit in claims.pins),
            "\n".join(vector.name for vector in claims.vectors),
        )


def _claims(board: Board) -> tuple[LibraryClaims, ...]:
    found = (library_claims(name, board) for name in SKETCH_LIBRARIES)
    return tuple(claims for claims in found if claims)


def _label(board: Board, bit: PortBit) -> str:
    pin = board.find_pin(bit.name)
    return pin.label if pin else bit.name


def _pin(board: Board, bit: PortBit) -> str:
    """
    Return the header's label and the port bit, or just ``(PD4)`` where no header has it.
    """
    pin = board.find_pin(bit.name)
    return f"{pin.label} ({bit.name})" if pin else f"({bit.name})"
