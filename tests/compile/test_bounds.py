"""
The longest way through an interrupt, found in the linked program, is the one found by hand.

Cycles in the comments are those of the AVR Instruction Set Manual (DS40002198). Before the first
of them come the response, 4 cycles on the ATmega328P and 5 on the ATmega2560 (datasheets,
"Interrupt Response Time"), and the JMP in the vector table with 3.
"""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.devices import Mcu
from stepgen.devices.mcus.atmega328p import MCU as UNO
from stepgen.devices.mcus.atmega2560 import MCU as MEGA
from stepgen.errors import StepgenError
from stepgen.verify.bounds.cycles import Core
from stepgen.verify.bounds.disassembly import disassemble, parse
from stepgen.verify.bounds.graph import Graph
from stepgen.verify.bounds.machine import Memory
from stepgen.verify.bounds.masked import MaskedSections
from stepgen.verify.bounds.search import Search
from stepgen.verify.bounds.worst_case import WorstCase
from stepgen.verify.compilers import Compiler, find_compilers

VECTOR = "TIMER1_OVF_vect"
ENTRY = 4 + 3
PROGRAM = """\
.text
vectors: jmp main
.org {place}
jmp isr
.org 0x100
main: rjmp main
{code}
"""

Assemble = Callable[..., WorstCase]


@pytest.fixture(params=find_compilers(), ids=lambda compiler: compiler.name)
def compiler(request: pytest.FixtureRequest) -> Compiler:
    """
    Return each compiler in turn: both versions of objdump must be understood.
    """
    found: Compiler = request.param
    return found


def assemble(code: str, mcu: Mcu, compiler: Compiler, folder: Path) -> Path:
    """
    Return the program whose timer 1 interrupt is the label ``isr`` of *code*.
    """
    source, elf = folder / "program.S", folder / "program.elf"
    place = 4 * mcu.vector(VECTOR).number
    source.write_text(PROGRAM.format(place=place, code=code), encoding="utf-8")
    gcc = str(compiler.bin_dir / "avr-gcc")
    command = [gcc, f"-mmcu={mcu.name}", "-g", "-nostdlib", str(source), "-o", str(elf)]
    subprocess.run(command, check=True)
    return elf


@pytest.fixture
def worst_case(compiler: Compiler, tmp_path: Path) -> Assemble:
    """
    Return a function that assembles code and returns its worst case.
    """

    def make(code: str, mcu: Mcu = UNO) -> WorstCase:
        return WorstCase(assemble(code, mcu, compiler, tmp_path), mcu, compiler)

    return make


def test_the_longer_side_of_a_branch_counts(worst_case: Assemble) -> None:
    """
    A branch costs one more when it is taken; the longer of both ways is the bound.
    """
    bound = worst_case("""
isr:  push r24        ; 2
      lds  r24, 0x100 ; 2
      tst  r24        ; 1
      breq 1f         ; 1, or 2 when taken
      nop             ; 1
      rjmp 2f         ; 2: 1 + 1 + 2 = 4 on this side
1:    nop             ; 1
      nop             ; 1
      nop             ; 1: 2 + 3 = 5 on this one
2:    pop  r24        ; 2
      reti            ; 4
""").interrupt(VECTOR)

    assert bound.cycles == ENTRY + 2 + 2 + 1 + 5 + 2 + 4
    assert bound.stack_bytes == 2 + 1  # the return address and r24


def test_a_skip_takes_a_cycle_for_each_word(worst_case: Assemble) -> None:
    """
    SBRC takes 1 and the 2 of STS where it does not skip, and 3 where it skips STS.
    """
    bound = worst_case("""
isr:  sbrc r24, 0     ; 1, or 3 over two words
      sts  0x100, r24 ; 2: both ways take 3
      cpse r24, r25   ; 1, or 2 over one word
      rjmp 1f         ; 2
      reti            ; 4: 2 + 4 = 6 with the skip
1:    reti            ; 4: 1 + 2 + 4 = 7 without
""").interrupt(VECTOR)

    assert bound.cycles == ENTRY + 3 + 7


def test_three_bytes_of_program_counter_take_longer(worst_case: Assemble) -> None:
    """
    With more than 128 KiB of flash each call, return and response takes one cycle more.
    """
    code = """
isr:  rcall inner     ; 3, and 4 on the ATmega2560
      reti            ; 4, and 5
inner: push r0        ; 2
      pop  r0         ; 2
      ret             ; 4, and 5
"""

    uno, mega = (worst_case(code, mcu).interrupt(VECTOR) for mcu in (UNO, MEGA))

    assert uno.cycles == 4 + 3 + 3 + 2 + 2 + 4 + 4
    assert mega.cycles == 5 + 3 + 4 + 2 + 2 + 5 + 5
    assert (uno.stack_bytes, mega.stack_bytes) == (2 + 2 + 1, 3 + 3 + 1)


def test_tests_that_contradict_each_other_cut_a_way_off(worst_case: Assemble) -> None:
    """
    The same bit of a variable cannot be 1 for the first test and 0 for the second.
    """
    bound = worst_case(CONTRADICTION).interrupt(VECTOR)

    # Bit 3 is 0: 3 + 2 + 12 = 17; it is 1: 6 + 2 + 5 = 13. Both long sides would be 20.
    assert bound.cycles == ENTRY + 2 + 17


CONTRADICTION = """
isr:  lds  r24, 0x100 ; 2
      sbrs r24, 3     ; 1, or 2 if bit 3 is 1
      rjmp 1f         ; 2
      mul  r0, r1     ; 2 and
      mul  r0, r1     ; 2 if it is 1: 2 + 4 = 6, else 1 + 2 = 3
1:    lds  r25, 0x100 ; 2
      sbrc r25, 3     ; 1, or 2 if bit 3 is 0
      reti            ; 4: 1 + 4 = 5 if it is 1
      lpm  r0, Z      ; 3
      lpm  r0, Z      ; 3
      reti            ; 4: 2 + 6 + 4 = 12 if it is 0
"""


def test_a_compare_of_two_bytes_is_one_fact(worst_case: Assemble) -> None:
    """
    Two variables that were found to be 0 together are 0 at the next test too.
    """
    bound = worst_case("""
isr:  clr  r1         ; 1
      lds  r24, 0x100 ; 2
      lds  r25, 0x101 ; 2
      cp   r24, r1    ; 1
      cpc  r25, r1    ; 1
      brne 1f         ; 1, or 2 if they are not 0
      lpm  r0, Z      ; 3: 1 + 3 = 4 if they are 0
1:    or   r24, r25   ; 1
      breq 2f         ; 1, or 2 if they are 0
      lpm  r0, Z      ; 3: 1 + 3 = 4 if they are not
2:    reti            ; 4
""").interrupt(VECTOR)

    # They are 0: 4 and 2; they are not: 2 and 4.
    assert bound.cycles == ENTRY + 1 + 2 + 2 + 1 + 1 + 6 + 1 + 4


def test_an_io_register_may_change_between_two_reads(worst_case: Assemble) -> None:
    """
    What a pin was tells nothing of what it is; only the GPIORs keep what is in them.
    """
    code = """
isr:  in   r24, {io}  ; 1
      sbrs r24, 0     ; 1, or 2
      lpm  r0, Z      ; 3: 1 + 3 = 4, or 2
      in   r24, {io}  ; 1
      sbrc r24, 0     ; 1, or 2
      lpm  r0, Z      ; 3: 1 + 3 = 4, or 2
      reti            ; 4
"""

    pin = worst_case(code.format(io="0x03")).interrupt(VECTOR)
    gpior = worst_case(code.format(io="0x1e")).interrupt(VECTOR)

    assert pin.cycles == ENTRY + 1 + 4 + 1 + 4 + 4
    assert gpior.cycles == ENTRY + 1 + 4 + 1 + 2 + 4


def test_a_store_through_an_unknown_pointer_may_hit_any_variable(worst_case: Assemble) -> None:
    """
    After it nothing is known of memory; after a store to a known address all else is.
    """
    code = """
isr:  {point}
      lds  r24, 0x100 ; 2
      sbrs r24, 0     ; 1, or 2
      lpm  r0, Z      ; 3: 1 + 3 = 4, or 2
      st   X, r1      ; 2
      lds  r24, 0x100 ; 2
      sbrc r24, 0     ; 1, or 2
      lpm  r0, Z      ; 3: 1 + 3 = 4, or 2
      reti            ; 4
"""

    unknown = worst_case(code.format(point="nop\n nop")).interrupt(VECTOR)  # 2
    known = worst_case(code.format(point="ldi r26, 1\n ldi r27, 1")).interrupt(VECTOR)  # 2

    assert unknown.cycles == ENTRY + 2 + 2 + 4 + 2 + 2 + 4 + 4
    assert known.cycles == ENTRY + 2 + 2 + 4 + 2 + 2 + 2 + 4


def test_a_counted_loop_needs_no_stated_bound(worst_case: Assemble) -> None:
    """
    LDI before it and DEC, BRNE at its end say how often it goes round.
    """
    bound = worst_case("""
isr:  ldi  r20, 6     ; 1
1:    lsr  r25        ; 1
      ror  r24        ; 1
      dec  r20        ; 1
      brne 1b         ; 2, and 1 the last time: 6 * 5 - 1 = 29
      reti            ; 4
""").interrupt(VECTOR)

    assert bound.cycles == ENTRY + 1 + 29 + 4


@pytest.mark.parametrize(
    "body",
    [
        "sbrc r24, 0\n rjmp around\n dec r20\n brne around",  # back without DEC
        "sbrc r24, 0\n dec r20\n brne around",  # DEC is skipped
        "sbrc r24, 0\n rjmp 1f\n dec r20\n 1: brne around",  # or jumped over
        "lds r20, 0x100\n dec r20\n brne around",  # the counter is set anew
        "movw r20, r24\n dec r20\n brne around",  # and as one of a pair
        "dec r21\n brne around",  # another register is counted
    ],
)
def test_a_loop_that_only_looks_counted_is_refused(worst_case: Assemble, body: str) -> None:
    """
    Whatever can go round without counting needs a stated bound.
    """
    with pytest.raises(StepgenError, match="nobody has stated a bound"):
        worst_case(f"isr: ldi r20, 6\naround: lsr r24\n {body}\n reti").interrupt(VECTOR)


def test_loops_within_a_loop_multiply(worst_case: Assemble) -> None:
    """
    Each round of the outer loop takes all rounds of the inner one.
    """
    bound = worst_case("""
isr:  ldi  r20, 3     ; 1
1:    ldi  r21, 4     ; 1
2:    lsr  r24        ; 1
      dec  r21        ; 1
      brne 2b         ; 2, and 1 the last time: 4 * 4 - 1 = 15
      dec  r20        ; 1
      brne 1b         ; 2, and 1 the last time: 3 * (1 + 15 + 1 + 2) - 1 = 56
      reti            ; 4
""").interrupt(VECTOR)

    assert bound.cycles == ENTRY + 1 + 56 + 4


LOOP = """
isr:  lds  r20, 0x100 ; 2
around: lsr  r24      ; 1
      dec  r20        ; 1
      brne around     ; 2, and 1 the last time
      reti            ; 4
"""


def test_a_loop_without_a_bound_is_refused(worst_case: Assemble) -> None:
    """
    How often this one goes round, only memory knows: the message says where it begins.
    """
    with pytest.raises(StepgenError, match=r"around .*`lsr r24`.* nobody has stated a bound"):
        worst_case(LOOP).interrupt(VECTOR)


def test_a_stated_bound_is_taken(compiler: Compiler, tmp_path: Path) -> None:
    """
    With at most 5 rounds stated, the loop takes 5 * 4 - 1 cycles at most.
    """
    program = disassemble(assemble(LOOP, UNO, compiler, tmp_path), compiler)
    (start,) = (address for address, name in program.functions.items() if name == "isr")
    graph = Graph(program, Core.of(UNO), {"around": 5})

    assert graph.reach(start).to_end[start] == 2 + 19 + 4


def test_a_search_that_is_given_up_has_a_looser_bound(compiler: Compiler, tmp_path: Path) -> None:
    """
    Without a look at what the tests say of each other, both long sides count.
    """
    elf = assemble(CONTRADICTION, UNO, compiler, tmp_path)
    program = disassemble(elf, compiler)
    (start,) = (address for address, name in program.functions.items() if name == "isr")
    graph = Graph(program, Core.of(UNO), {})

    given_up = Search(graph, Memory.of(UNO), most_forks=1).longest(start, graph.reach(start))
    through = Search(graph, Memory.of(UNO)).longest(start, graph.reach(start))

    assert (given_up.cycles, given_up.is_exact) == (2 + 6 + 2 + 12, False)
    assert (through.cycles, through.is_exact) == (2 + 17, True)


@pytest.mark.parametrize(
    ("code", "why"),
    [
        ("isr: rcall isr\n reti", "calls itself"),
        ("isr: icall\n reti", "only the running program knows"),
        ("isr: sei\n reti", "lets other interrupts in"),
        ("isr: rjmp isr", "nobody has stated a bound"),
        ("isr: sleep\n reti", "no fixed length"),
        ("isr: out 0x3d, r28\n reti", "moves the stack pointer"),
        ("isr: sbrc r24, 0\n push r24\n reti", "more or less on the stack"),
    ],
)
def test_what_has_no_bound_is_refused(worst_case: Assemble, code: str, why: str) -> None:
    """
    A way that cannot be followed, or an interrupt that lets others in, is an error.
    """
    with pytest.raises(StepgenError, match=why):
        worst_case(code).interrupt(VECTOR)


def test_interrupts_stay_off_until_the_caller_restores_them(worst_case: Assemble) -> None:
    """
    A stretch that begins in a function which returns goes on in whoever called it.
    """
    bound = worst_case("""
isr:  reti
mask: in   r24, 0x3f  ; before CLI: not counted
      cli             ; 1
      ret             ; 4
user: rcall mask
      lpm  r0, Z      ; 3
      out  0x3f, r24  ; 1
      ret
other: rcall mask
      nop             ; 1
      out  0x3f, r24  ; 1
      lpm  r0, Z      ; interrupts are on again: not counted
      ret
""").masked("program.S")

    assert bound.cycles == 1 + 4 + 3 + 1


def test_switching_interrupts_off_twice_is_refused(worst_case: Assemble) -> None:
    """
    Which of two restores ends the stretch cannot be told.
    """
    with pytest.raises(StepgenError, match="where they are off"):
        worst_case("isr: reti\nuser: cli\n cli\n out 0x3f, r24\n ret").masked("program.S")


def test_the_longest_path_is_told_in_functions_and_lines(worst_case: Assemble) -> None:
    """
    Each function on the way with its cycles, and the source lines that it passes.
    """
    response, vector, *path = (
        worst_case("isr: nop\n rjmp on\n.org 0x200\non: nop\n reti").interrupt(VECTOR).path
    )

    # The program begins with six lines of its own; isr is line 7.
    assert response == "response: 4 cycles"
    assert vector.endswith(": 3 cycles (program.S:4)")
    assert path == ["isr: 3 cycles (program.S:7-8)", "on: 5 cycles (program.S:10-11)"]


def test_the_guard_counts_where_its_line_is_taken_for_the_sketchs() -> None:
    """
    Link-time optimisation writes a sketch's line before an inlined CLI; the guard's name stays.
    """
    program = parse(
        "00000100 <main>:\nloop():\n/tmp/sketch.cpp:34\n"
        " 100:\tf8 94       \tcli\n 102:\t8f bf       \tout\t0x3f, r24\t; 63\n"
        "_ZN6MaskedC2Ev():\n"
        " 104:\tf8 94       \tcli\n 106:\t00 00       \tnop\n"
        " 108:\t8f bf       \tout\t0x3f, r24\t; 63\n"
        " 10a:\t08 95       \tret\n"
    )

    sections = MaskedSections(program, Core.of(UNO), Memory.of(UNO), "Pan.cpp")

    assert [start for start, _ in sections.each()] == [0x104]
