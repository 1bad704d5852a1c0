"""
Where a point is tried: programs compiled with macros, run on one chip of one simulator.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from stepgen.verify.cache import build_once, content_key
from stepgen.verify.compilers import Compiler, run
from stepgen.verify.events import Events, Kind
from stepgen.verify.simulators import Machine, Simulator

PROGRAMS = Path(__file__).parent / "programs"
F_CPU_HZ = 16_000_000


@dataclass(frozen=True)
class Lab:
    """
    One chip of one simulator, and the compiler of the programs.
    """

    simulator: Simulator
    compiler: Compiler
    mcu: str

    @contextmanager
    def running(
        self, program: str, *, watch: Sequence[int] = (), **macros: int
    ) -> Iterator[Machine]:
        """
        Lend a machine with *program*, compiled with *macros*, in its flash.
        """
        elf = compile_program(program, self.compiler, self.mcu, macros)
        with self.simulator.open(elf, mcu=self.mcu, f_cpu_hz=F_CPU_HZ, watch=watch) as machine:
            yield machine

    def differ(self, what: str, expected: Sequence[int], seen: Sequence[int]) -> Iterator[str]:
        """
        Yield a finding unless each of *seen* is as *expected*, within the simulator's tolerance.
        """
        most = self.simulator.tolerance_cycles
        alike = len(expected) == len(seen) and all(
            abs(one - other) <= most for one, other in zip(expected, seen, strict=True)
        )
        if not alike:
            yield f"{what}: {_short(seen)}, but the chip has {_short(expected)}"


def compile_program(program: str, compiler: Compiler, mcu: str, macros: dict[str, int]) -> Path:
    """
    Return *program*, one of the folder ``programs``, compiled for *mcu* with *macros*.

    Raises:
        StepgenError: It does not compile.
    """
    source = PROGRAMS / f"{program}.c"
    defines = [f"-D{name}={value}" for name, value in macros.items()]
    key = content_key([compiler.name, compiler.version, mcu, source.read_bytes(), *defines])

    def make(folder: Path) -> None:
        gcc = str(compiler.bin_dir / "avr-gcc")
        elf = str(folder / "program.elf")
        flags = [f"-mmcu={mcu}", "-Os", "-Wall", "-Werror"]
        run([gcc, *flags, *defines, str(source), "-o", elf], place=str(source))

    return build_once("conformance", key, make) / "program.elf"


def of_kind(machine: Machine, kind: Kind, source: int | None = None) -> Events:
    """
    Return the events of one kind, and of one source if given.
    """
    events = machine.events()
    chosen = events["kind"] == kind
    if source is not None:
        chosen &= events["source"] == source
    rows: Events = events[chosen]
    return rows


def cycles(machine: Machine, kind: Kind, source: int | None = None) -> list[int]:
    """
    Return the cycles of the events of one kind, and of one source if given.
    """
    return [int(cycle) for cycle in of_kind(machine, kind, source)["cycle"]]


def gaps(values: Sequence[int]) -> list[int]:
    """
    Return what lies between each two of *values*.
    """
    return [after - before for before, after in pairwise(values)]


def ram(machine: Machine, name: str, size: int) -> list[int]:
    """
    Return the bytes of the program's variable *name*.
    """
    return list(machine.read_ram(machine.symbol(name), size))


def _short(values: Sequence[int]) -> str:
    shown = ", ".join(str(value) for value in values[:6])
    return f"{shown}, ..." if len(values) > 6 else shown or "nothing"  # noqa: PLR2004 - six shown
