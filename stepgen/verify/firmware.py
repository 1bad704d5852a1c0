"""
From a plan to firmware: the generated library, compiled with the bench and with its example.
"""

from dataclasses import dataclass
from pathlib import Path

from stepgen.devices import Mcu, Port
from stepgen.library.motor_view import has_long_periods
from stepgen.library.render import environment, render_library, spec_hash
from stepgen.library.text import hexadecimal
from stepgen.library.view import make_view
from stepgen.plan.model import Plan
from stepgen.verify.bench import is_axis
from stepgen.verify.cache import build_once, content_key
from stepgen.verify.toolchain import Build, Compiler, Target, build, empty_sketch

BENCH_TEMPLATE = "verify/bench.cpp.j2"
_ARGUMENTS = "control, top, limit"
_MORE_ARGUMENTS = ", modification, interval, count"


@dataclass(frozen=True)
class FreeBits:
    """
    Bits of a motor's port that the motor does not use, for the sketch to play with.
    """

    port: str
    mask: str
    inverse: str


@dataclass(frozen=True)
class BenchView:
    """
    What the bench sketch may do beside the motors, and how it calls each of them.
    """

    free_bits: tuple[FreeBits, ...]
    free_groups: tuple[FreeBits, ...]
    free_pins: tuple[int, ...]
    changing: tuple[str, ...]
    arguments: dict[str, str]
    inits: tuple[str, ...]
    axes: bool
    guards: bool
    limits: bool
    long_periods: bool


@dataclass(frozen=True)
class Firmware:
    """
    Two programs with the same library: the bench, and the example that users see first.

    *flash_bytes* and *ram_bytes* are those of the example over an empty sketch.
    """

    bench: Path
    example: Path
    flash_bytes: int
    ram_bytes: int


def build_firmware(
    plan: Plan, spec_text: str, compiler: Compiler, templates: Path | None = None
) -> Firmware:
    """
    Generate the library of *plan* and compile it, unless the very same was compiled before.

    Args:
        plan: What to build.
        spec_text: The spec that it came from.
        compiler: Which avr-gcc.
        templates: Templates that replace stepgen's own, for mutants.

    Raises:
        StepgenError: It does not compile without a warning.
    """
    files = render_library(plan, spec_text, templates)
    bench = _bench_source(plan, spec_text, templates)
    key = content_key([compiler.name, compiler.version, plan.board.fqbn, bench, *_flat(files)])
    target = Target.from_fqbn(plan.board.fqbn)

    def make(folder: Path) -> None:
        for path, text in {**files, "bench/bench.cpp": bench}.items():
            file = folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        sources = sorted((folder / "src").glob("*.cpp"))
        includes = [folder / "src"]
        sketches = {"bench": folder / "bench/bench.cpp", "example": _example(folder)}
        for name, sketch in sketches.items():
            made = build([sketch, *sources], includes, target, compiler, folder / "build" / name)
            made.elf.rename(folder / f"{name}.elf")
            (folder / f"{name}.sizes").write_text(f"{made.flash_bytes} {made.ram_bytes}")

    folder = build_once("firmware", key, make)
    empty = empty_sketch(target, compiler)
    example = _sizes(folder, "example")
    return Firmware(
        bench=folder / "bench.elf",
        example=folder / "example.elf",
        flash_bytes=example.flash_bytes - empty.flash_bytes,
        ram_bytes=example.ram_bytes - empty.ram_bytes,
    )


def _example(folder: Path) -> Path:
    return folder / "examples/Turn/Turn.ino"


def _sizes(folder: Path, name: str) -> Build:
    flash, ram = (folder / f"{name}.sizes").read_text().split()
    return Build(folder / f"{name}.elf", int(flash), int(ram))


def _flat(files: dict[str, str]) -> list[str]:
    return [part for pair in sorted(files.items()) for part in pair]


def _bench_source(plan: Plan, spec_text: str, templates: Path | None) -> str:
    template = environment(templates).get_template(BENCH_TEMPLATE)
    library = make_view(plan, spec_hash(spec_text))
    return template.render(library=library, bench=_bench_view(plan))


def _bench_view(plan: Plan) -> BenchView:
    """
    Return the bits that no motor uses, on ports that no motor owns.
    """
    masks = _free_masks(plan)
    mcu = plan.board.mcu
    bits = [
        _free(mcu.port(letter), 1 << bit)
        for letter, mask in masks.items()
        for bit in range(8)
        if mask >> bit & 1 and _single_bit_is_atomic(mcu, letter)
    ]
    pins = [pin.number for pin in plan.board.pins if masks.get(pin.bit.port, 0) >> pin.bit.bit & 1]
    changing = tuple(m.name for m in plan.motors if m.motion.kind == "update-events")
    arguments = {
        motor.name: _ARGUMENTS + (_MORE_ARGUMENTS if motor.name in changing else "")
        for motor in plan.motors
        if not is_axis(motor)
    }
    return BenchView(
        changing=changing,
        arguments=arguments,
        inits=tuple(m.name + ("Init" if is_axis(m) else "ShieldInit") for m in plan.motors),
        axes=len(arguments) < len(plan.motors),
        guards=any(motor.end_stops for motor in plan.motors),
        limits=bool(arguments),
        long_periods=has_long_periods(plan),
        free_bits=tuple(bits),
        free_groups=tuple(_free(mcu.port(letter), mask) for letter, mask in masks.items() if mask),
        free_pins=tuple(pins),
    )


def _free_masks(plan: Plan) -> dict[str, int]:
    used: dict[str, int] = {}
    owned: set[str] = set()
    for motor in plan.motors:
        switches = motor.end_stops.switches if motor.end_stops else ()
        for pin in (*(w.pin for w in motor.drive.every_wire), *(s.pin for s in switches)):
            bit = pin.bit
            used[bit.port] = used.get(bit.port, 0) | 1 << bit.bit
        if motor.owns_ports:
            owned.update(wire.pin.bit.port for wire in motor.drive.wires)
    serial = {pin.bit for pin in plan.board.pins if {"Serial RX", "Serial TX"} & set(pin.uses)}
    for bit in serial:
        if bit.port in used:
            used[bit.port] |= 1 << bit.bit
    existing = {port.letter: sum(1 << bit for bit in port.bits) for port in plan.board.mcu.ports}
    return {p: existing[p] & ~mask for p, mask in sorted(used.items()) if p not in owned}


def _single_bit_is_atomic(mcu: Mcu, letter: str) -> bool:
    return mcu.port(letter).port.bit_addressable


def _free(port: Port, mask: int) -> FreeBits:
    return FreeBits(port.port.name, hexadecimal(mask), hexadecimal(~mask & 0xFF))
