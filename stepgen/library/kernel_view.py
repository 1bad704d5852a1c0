"""
The view of a kernel: its tables and port writes as finished C++ text.
"""

from dataclasses import dataclass

from stepgen.devices import Mcu
from stepgen.library.text import comment_lines, hexadecimal, listed
from stepgen.plan.coils import Wire, bits_by_port
from stepgen.plan.kernels import Kernel, PortWrite, Ring, Toggle


@dataclass(frozen=True)
class Bits:
    """
    Bits of one port: its registers, the mask and what hangs on it.
    """

    port: str
    ddr: str
    mask: str
    inverse: str
    comment: str


@dataclass(frozen=True)
class ToggleView:
    """
    What the partial ``toggle`` prints.
    """

    port: str
    pin: str
    phases: str
    keep: str
    both: str
    first: str


@dataclass(frozen=True)
class RingView:
    """
    What the partial ``ring`` prints.
    """

    legend: tuple[str, ...]
    alignment: int
    rows: tuple[str, ...]
    writes: tuple[str, ...]
    row_bytes: int
    phase_bytes: int


KernelView = ToggleView | RingView


def kernel_view(kernel: Kernel) -> KernelView:
    """
    Return the text of *kernel*.
    """
    return _toggle_view(kernel) if isinstance(kernel, Toggle) else _ring_view(kernel)


def bit_groups(wires: tuple[Wire, ...], mcu: Mcu) -> tuple[Bits, ...]:
    """
    Return *wires* as one group of bits for each port.
    """
    groups = []
    for letter, mask in bits_by_port(wires).items():
        port = mcu.port(letter)
        here = [wire for wire in wires if wire.pin.bit.port == letter]
        signals = ", ".join(wire.signal for wire in here)
        groups.append(
            Bits(
                port=port.port.name,
                ddr=port.ddr.name,
                mask=hexadecimal(mask),
                inverse=hexadecimal(~mask & 0xFF),
                comment=f"  // {signals}",
            )
        )
    return tuple(groups)


def _toggle_view(kernel: Toggle) -> ToggleView:
    return ToggleView(
        port=kernel.port.port.name,
        pin=kernel.port.pin.name,
        phases=", ".join(hexadecimal(value) for value in kernel.values),
        keep=hexadecimal(~kernel.both & 0xFF),
        both=hexadecimal(kernel.both),
        first=hexadecimal(kernel.masks[0]),
    )


def _ring_view(kernel: Ring) -> RingView:
    columns = listed([_column(write) for write in kernel.writes])
    legend = (
        "Two rows for each phase: for going on forward and for going on backward. A row begins "
        f"with the distance of the row that follows; then comes {columns}."
    )
    return RingView(
        legend=comment_lines(legend),
        alignment=kernel.alignment_bytes,
        rows=tuple(_row(index, row) for index, row in enumerate(kernel.rows)),
        writes=tuple(_write(index, write) for index, write in enumerate(kernel.writes, start=1)),
        row_bytes=kernel.row_bytes,
        phase_bytes=2 * kernel.row_bytes,
    )


def _column(write: PortWrite) -> str:
    name = write.port.port.name
    return {
        "merge": f"what {name} shows",
        "clear": f"what stays on in {name}",
        "set": f"what goes on in {name}",
    }[write.operation]


def _row(index: int, row: tuple[int, ...]) -> str:
    following, *values = row
    way = "back from" if index % 2 else "phase"
    cells = ", ".join([f"{following:3}", *(hexadecimal(value) for value in values)])
    return f"{cells},  // {way} {index // 2}"


def _write(index: int, write: PortWrite) -> str:
    name = write.port.port.name
    value = f"pgm_read_byte(row + {index})"
    return {
        "clear": f"{name} &= {value};",
        "set": f"{name} |= {value};",
        "merge": f"{name} = ({name} & {hexadecimal(~write.mask & 0xFF)}) | {value};",
    }[write.operation]
