"""
The view of a kernel: its tables and port writes as finished C++ text.
"""

from dataclasses import dataclass

from stepgen.library.text import comment_lines, hexadecimal, listed
from stepgen.plan.kernels import Kernel, PortWrite, Ring, Toggle
from stepgen.plan.pulses import Pulse


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


@dataclass(frozen=True)
class PulseView:
    """
    What the partial ``pulse`` prints.
    """

    legend: tuple[str, ...]
    rise: str
    fall: str
    high_wait: str
    low_wait: str
    forward: str
    backward: str
    hold_wait: str
    setup_wait: str


KernelView = ToggleView | RingView | PulseView


def kernel_view(kernel: Kernel) -> KernelView:
    """
    Return the text of *kernel*.
    """
    match kernel:
        case Toggle():
            return _toggle_view(kernel)
        case Ring():
            return _ring_view(kernel)
        case Pulse():
            return _pulse_view(kernel)


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


def _pulse_view(kernel: Pulse) -> PulseView:
    cycles = kernel.cycles
    name, mask = kernel.port.port.name, 1 << kernel.bit
    rise, fall = _bit_changes(name, mask)
    if kernel.toggles:
        rise = fall = f"{kernel.port.pin.name} = {hexadecimal(mask)};"
    backward, forward = _bit_changes(kernel.direction_port.port.name, 1 << kernel.direction.bit)
    legend = (
        f"A step is a pulse on STEP, HIGH for {cycles.high} cycles at least and LOW for "
        f"{cycles.low} before the next. DIR is written at least {cycles.setup} "
        f"before STEP rises and {cycles.hold} after it."
    )
    return PulseView(
        legend=comment_lines(legend),
        rise=rise,
        fall=fall,
        high_wait=_wait(cycles.high - kernel.fall_cycles),
        low_wait=_wait(kernel.low_wait_cycles),
        forward=forward,
        backward=backward,
        hold_wait=_wait(kernel.hold_wait_cycles),
        setup_wait=_wait(kernel.setup_wait_cycles),
    )


def _bit_changes(port: str, mask: int) -> tuple[str, str]:
    """
    Return the statements that set and clear *mask*.
    """
    return f"{port} |= {hexadecimal(mask)};", f"{port} &= {hexadecimal(~mask & 0xFF)};"


def _wait(cycles: int) -> str:
    return f"__builtin_avr_delay_cycles({cycles});" if cycles > 0 else ""
