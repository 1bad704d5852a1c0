"""
What the harness of simavr adds to the conformance suite: its recording, and its timers at random.

Section numbers are those of the ATmega328P datasheet (DS40002061), chapter 16 "16-bit
Timer/Counter1 with PWM" and chapter 12 "Interrupts" with 7.7 "Reset and Interrupt Handling".
"""

import random
import struct
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from stepgen.errors import StepgenError
from stepgen.verify.conformance import lab
from stepgen.verify.events import EVENT, Events, Kind
from stepgen.verify.simavr import Machine, build

PROGRAMS = (Path(__file__).parent / "programs", lab.PROGRAMS)
F_CPU_HZ = 16_000_000

# Data addresses, ATmega328P datasheet chapter 31 "Register Summary".
DDRB, PORTB = 0x24, 0x25
TCCR1A, TCCR1B, TCNT1L, ICR1L, OCR1AL, OCR1BL = 0x80, 0x81, 0x84, 0x86, 0x88, 0x8A
# Vector numbers less one, table 12-6 (ATmega328P).
CAPT, COMPA, COMPB, OVF = 10, 11, 12, 13
# WGM13:0 and CS12:0, tables 16-4 and 16-5.
CTC, CTC_ICR, FAST_ICR, FAST = 4, 12, 14, 15
CLOCKS = {1: 1, 8: 2, 64: 3, 256: 4, 1024: 5}

Start = Callable[..., Machine]


@pytest.fixture
def start(tmp_path: Path) -> Start:
    """
    Return a function that compiles a program with macros and puts it into a machine.
    """

    def run(
        program: str, *, mcu: str = "atmega328p", watch: tuple[int, ...] = (), **macros: int
    ) -> Machine:
        elf = tmp_path / f"{program}.elf"
        defines = [f"-D{name}={value}" for name, value in macros.items()]
        name = f"{program}.c"
        source = next(str(folder / name) for folder in PROGRAMS if (folder / name).is_file())
        subprocess.run(
            ["avr-gcc", f"-mmcu={mcu}", "-Os", "-Wall", "-Werror", *defines, source, "-o", elf],
            check=True,
        )
        return Machine(elf, mcu=mcu, f_cpu_hz=F_CPU_HZ, watch=watch)

    return run


def of_kind(events: Events, kind: Kind) -> Events:
    """
    Return the events of one kind.
    """
    chosen: Events = events[events["kind"] == kind]
    return chosen


def cycles(events: Events, kind: Kind) -> list[int]:
    """
    Return the cycles of the events of one kind.
    """
    return [int(cycle) for cycle in of_kind(events, kind)["cycle"]]


def gaps(events: Events, kind: Kind) -> list[int]:
    """
    Return the cycles between the events of one kind.
    """
    return [int(gap) for gap in np.diff(of_kind(events, kind)["cycle"])]


def marks(machine: Machine) -> dict[int, int]:
    """
    Return the cycle of each mark the program wrote.
    """
    written = of_kind(machine.events(), Kind.MARK)
    return {int(row["value"]): int(row["cycle"]) for row in written}


class PlainTimer:
    """
    Timer 1 of chapter 16, cycle by cycle, without compare outputs and phase correct modes.
    """

    def __init__(self) -> None:
        self.cycle = 0
        self.bytes = bytearray(OCR1BL + 2 - TCCR1A)
        self.temp = 0
        self.count = 0
        self.capture = 0
        self.active = [0, 0]
        self.buffer = [0, 0]
        self.blocked = False
        self.raised: list[tuple[int, int]] = []

    @property
    def mode(self) -> int:
        """
        WGM13:0.
        """
        return self.bytes[0] & 3 | self.bytes[1] >> 1 & 12

    def run_to(self, cycle: int) -> None:
        """
        Take every tick up to the one at *cycle*.
        """
        for edge in range(self.cycle + 1, cycle + 1):
            prescaler = (0, 1, 8, 64)[self.bytes[1] & 3]
            if prescaler and edge % prescaler == 0:
                self.tick(edge)
        self.cycle = cycle

    def tick(self, edge: int) -> None:
        """
        Leave the count for the next one (figures 16-10 to 16-13).
        """
        fast, by_capture = self.mode >= FAST_ICR, self.mode in {CTC_ICR, FAST_ICR}
        matches = [not self.blocked and self.count == value for value in self.active]
        at_top = self.mode != 0 and (self.count == self.capture if by_capture else matches[0])
        flags = {
            COMPA: matches[0],
            COMPB: matches[1],
            CAPT: at_top and by_capture,
            OVF: at_top if fast else self.count == 0xFFFF,
        }
        self.raised += [(edge, vector) for vector, is_set in flags.items() if is_set]
        self.blocked = False
        self.count = 0 if at_top else (self.count + 1) & 0xFFFF
        if fast and self.count == 0:
            self.active = list(self.buffer)

    def write(self, offset: int, value: int) -> None:
        """
        Write the register that lies *offset* bytes after TCCR1A.
        """
        both = self.temp << 8 | value
        self.bytes[offset] = value
        if offset == TCNT1L - TCCR1A:
            self.count, self.blocked = both, True
        elif offset == ICR1L - TCCR1A:
            if self.mode in {CTC_ICR, FAST_ICR}:
                self.capture = both
        elif offset in {OCR1AL - TCCR1A, OCR1BL - TCCR1A}:
            channel = (offset + TCCR1A - OCR1AL) // 2
            self.buffer[channel] = both
            if self.mode < FAST_ICR:
                self.active[channel] = both
        elif offset > TCNT1L - TCCR1A:
            self.temp = value


def random_writes(rng: random.Random) -> Iterator[bytes]:
    """
    Yield rows of the table in script.c: settings of timer 1, few values, so that they meet.
    """
    mode = 0
    for _ in range(200):
        wait = rng.choice((0, 0, 1, 5, 60))
        if rng.random() < 0.3:  # one in three changes mode and clock
            before, mode = mode, rng.choice((0, CTC, CTC_ICR, FAST_ICR, FAST, FAST))
            clock = rng.choice((1, 1, 1, 2, 3, 0))
            if before >> 2 != mode >> 2 and before & 3 != mode & 3:
                # A third mode in between would be one that the plain model has not.
                yield struct.pack("<HBB", TCCR1B, 0, 0)
            yield struct.pack("<HBB", TCCR1A, mode & 3, 0)
            yield struct.pack("<HBB", TCCR1B, mode >> 2 << 3 | clock, wait)
            continue
        low = rng.choice((OCR1AL, OCR1AL, OCR1BL, ICR1L, TCNT1L))
        value = rng.choice((0, 1, 7, 30, 100, 200, 0xFFF0))
        yield struct.pack("<HBB", low + 1, value >> 8, 0)
        yield struct.pack("<HBB", low, value & 0xFF, wait)


@pytest.mark.parametrize("mode", [0, 1, CTC, FAST])
def test_looking_at_the_count_changes_nothing(start: Start, mode: int) -> None:
    """
    The counter is computed lazily: asking for it at odd moments leaves every event as it was.
    """
    runs: list[Events] = []
    for asked in (False, True):
        machine = start("periodic", MODE=mode, CLOCK=CLOCKS[8], TOP_VALUE=77)
        for until in range(0, 100_000, 97):
            machine.run_until(until)
            if asked:
                machine.register(TCNT1L)
        machine.run_until(600_000)
        runs.append(machine.events())

    assert len(runs[0]) > 2
    assert (runs[0] == runs[1]).all()


@pytest.mark.parametrize(
    ("mode", "lap"),
    # TOP + 1 ticks; in normal mode MAX + 1; in phase correct mode 2 TOP, with TOP = 255.
    [(0, 65_536), (1, 510), (CTC, 7), (CTC_ICR, 7), (FAST_ICR, 7), (FAST, 7)],
)
def test_long_idle_counting_is_exact(start: Start, mode: int, lap: int) -> None:
    """
    A timer that no interrupt watches counts right for seconds, and costs next to nothing.
    """
    macros = {"MODE": mode, "CLOCK": 1, "TOP_VALUE": 6, "UNWATCHED": 1}
    machine = start("periodic", watch=(TCCR1B,), **macros)
    machine.run_until(3 * F_CPU_HZ)
    clock_on = cycles(machine.events(), Kind.REGISTER)[-1]
    count = machine.register(TCNT1L) | machine.register(TCNT1L + 1) << 8

    # Tables 16-4 and 16.9.1 to 16.9.4; in phase correct mode the second half counts down.
    position = (machine.cycle - clock_on) % lap
    expected = lap - position if mode == 1 and position > lap // 2 else position
    assert count == expected


@pytest.mark.parametrize("seed", range(24))
def test_random_writes_do_what_a_plain_model_does(start: Start, seed: int) -> None:
    """
    After any writes to timer 1, every flag comes at the edge a model of single ticks gives.
    """
    rng = random.Random(seed)  # noqa: S311  # reproducible cases, not secrets
    machine = start("script", watch=tuple(range(TCCR1A, OCR1BL + 2)))
    assert machine.run_until_mark(2, limit_cycles=20_000)
    machine.write_ram(machine.symbol("script"), b"".join(random_writes(rng))[: 200 * 4])
    assert machine.run_until_mark(1, limit_cycles=10_000_000)

    model = PlainTimer()
    events = machine.events()
    for row in of_kind(events, Kind.REGISTER):
        model.run_to(int(row["cycle"]))
        model.write(int(row["source"]) - TCCR1A, int(row["value"]))
    model.run_to(machine.cycle)
    raised = of_kind(events, Kind.RAISE)

    assert len(raised) > 5
    assert sorted(zip(raised["cycle"], raised["source"], strict=True)) == sorted(model.raised)
    assert machine.register(TCNT1L) | machine.register(TCNT1L + 1) << 8 == model.count


@pytest.mark.parametrize(
    ("mcu", "vector", "response"),
    [("atmega328p", OVF, 4), ("atmega1280", 20, 4), ("atmega2560", 20, 5)],
)
def test_interrupt_response(start: Start, mcu: str, vector: int, response: int) -> None:
    """
    From an instruction boundary the vector is reached in 4 cycles, in 5 on the ATmega2560.
    """
    machine = start("periodic", mcu=mcu, MODE=FAST, CLOCK=1, TOP_VALUE=999)
    machine.run_until(10_000)
    entered = of_kind(machine.events(), Kind.ISR_ENTER)
    port = of_kind(machine.events(), Kind.PORT)[1:]
    left = of_kind(machine.events(), Kind.ISR_EXIT)

    # 7.7.1, and 7.8.1 of the ATmega2560's: then jmp (3), sbi (2) and reti (4 or 5).
    count = len(left)
    assert count == 9
    assert set(entered["source"]) == set(left["source"]) == {vector}
    assert set(port["cycle"][:count] - entered["cycle"][:count]) == {response + 3 + 2}
    assert set(left["cycle"] - entered["cycle"][:count]) == {response + 3 + 2 + response}
    assert (left["since"] == entered["cycle"][:count]).all()
    # The loop is a rjmp of 2 cycles: the flag waits for its end at most.
    assert set(entered["cycle"] - entered["since"]) <= {0, 1}


def test_simavrs_own_timer_wakes_with_the_same_delay(start: Start) -> None:
    """
    Timer 0, which simavr itself simulates, wakes from sleep with the chip's response, too.
    """
    machine = start("all_timers", mcu="atmega2560")
    machine.run_until(100_000)
    events = machine.events()
    left = of_kind(events, Kind.ISR_EXIT)
    of_timer_0 = left[left["source"] == 23]

    # The ISR is empty: response (5) and 4 for waking, jmp (3), reti (5); without the 4 where
    # another ISR has woken the CPU before.
    lengths = (of_timer_0["cycle"] - of_timer_0["since"]).tolist()
    assert lengths.count(5 + 4 + 3 + 5) > lengths.count(5 + 3 + 5)
    assert set(lengths) <= {17, 13}


def test_idle_sleep_adds_four_cycles_and_no_real_time(start: Start) -> None:
    """
    A minute of idle sleep passes at once, and waking makes the response 4 cycles longer.
    """
    machine = start("periodic", MODE=FAST, CLOCK=CLOCKS[1024], TOP_VALUE=15_624, IDLE=1)
    machine.run_until(60 * F_CPU_HZ + 100)
    entered = of_kind(machine.events(), Kind.ISR_ENTER)
    port = of_kind(machine.events(), Kind.PORT)[1:]

    # 1024 * 15 625 cycles are 1 s. 7.7.1: "If an interrupt occurs when the MCU is in sleep mode,
    # the interrupt execution response time is increased by four clock cycles".
    assert len(entered) == 60
    assert (entered["cycle"] == entered["since"]).all()
    assert set(port["cycle"] - entered["cycle"]) == {4 + 4 + 3 + 2}


def test_masked_flag_stays_pending_once(start: Start) -> None:
    """
    A flag that comes while I is clear waits, a second one is lost, and sei lets it in.
    """
    machine = start("masked")
    assert machine.run_until_mark(2, limit_cycles=10_000)
    first, second = of_kind(machine.events(), Kind.RAISE)
    entered = of_kind(machine.events(), Kind.ISR_ENTER)

    assert second["cycle"] - first["cycle"] == 1000
    assert (first["value"], second["value"]) == (0, 1)
    assert len(entered) == 1
    assert entered["since"][0] == first["cycle"]
    # 7.7: "the instruction following SEI will be executed before any pending interrupts":
    # a nop of one cycle.
    assert entered["masked_until"][0] == entered["cycle"][0] - 1
    assert entered["masked_until"][0] > second["cycle"]


def test_flag_fires_when_its_enable_bit_is_set(start: Start) -> None:
    """
    With OCIE1A clear a raised flag waits; setting the bit lets the interrupt in at once.
    """
    machine = start("masked")
    assert machine.run_until_mark(8, limit_cycles=20_000)
    at = marks(machine)
    entered = of_kind(machine.events(), Kind.ISR_ENTER)
    late = entered[entered["cycle"] > at[6]]

    assert len(late) == 1
    assert at[7] < late["cycle"][0] < at[8]
    assert late["since"][0] < at[6]
    assert late["masked_until"][0] == late["cycle"][0]


@pytest.mark.parametrize("mcu", ["atmega328p", "atmega1280", "atmega2560"])
def test_writing_ones_to_pinx_toggles_those_bits(start: Start, mcu: str) -> None:
    """
    `out` and `sts` to PINx toggle the bits of the mask, `sbi` just its one, `cbi` none.
    """
    machine = start("ports", mcu=mcu)
    assert machine.run_until_mark(1, limit_cycles=1000)
    port = of_kind(machine.events(), Kind.PORT)
    values = [int(v) for v in port["value"][port["source"] == PORTB]]

    # 14.2.2; and 14.4: "SBI and CBI instructions will only operate on the specified bit".
    # 0x24 ^ 0x0C = 0x28, ^ 0x10 = 0x38, ^ 0x21 = 0x19, | 0x04 = 0x1D.
    assert values == [0x24, 0x28, 0x38, 0x19, 0x1D]
    assert machine.register(PORTB) == 0x1D
    assert port["source"][0] == DDRB
    if mcu != "atmega328p":  # port H is beyond in and out: 0x102
        assert [int(v) for v in port["value"][port["source"] == 0x102]] == [0x18, 0x08]


def test_serial_line_goes_both_ways(start: Start) -> None:
    """
    Bytes that are sent to USART0 arrive one by one, and what it sends is recorded.
    """
    machine = start("serial")
    machine.send_serial(b"HAL")
    machine.run_until(10_000)

    sent = of_kind(machine.events(), Kind.UART)

    # 19.3.1: 16 (UBRR + 1) cycles per bit, 10 bits per byte; the ISRs answer at once.
    assert bytes(sent["value"].astype("u1")) == b"IBM"
    assert np.diff(sent["cycle"]).tolist() == pytest.approx([640, 640], abs=3)
    assert (machine.serial_waiting, machine.serial_lost) == (0, 0)


def test_nothing_passes_over_usb_before_somebody_opens_the_port(start: Start) -> None:
    """
    No request comes by itself; once the port is open, what waits arrives, and the answer.
    """
    machine = start("usb_port", mcu="atmega32u4")
    machine.run_until(50 * F_CPU_HZ // 1000)
    asked = machine.read_ram(machine.symbol("count"), 1)
    machine.send_usb(b"HAL")
    waiting = machine.usb_waiting
    machine.run_until(130 * F_CPU_HZ // 1000)

    sent = of_kind(machine.events(), Kind.UART)
    assert asked == b"\0"
    assert (waiting, machine.usb_waiting) == (3, 0)
    assert bytes(sent["value"].astype("u1")) == b"IBM"
    assert set(sent["source"]) == {0xF1}  # UEDATX


def test_a_board_that_refuses_a_request_stops_the_run(start: Start) -> None:
    """
    A STALL (22.11) to SET_CONTROL_LINE_STATE is an error that names the request.
    """
    machine = start("usb_port", mcu="atmega32u4", STALLS=1)
    machine.send_usb(b"HAL")
    with pytest.raises(StepgenError, match="refuses request 34 of 21 over USB"):
        machine.run_until(130 * F_CPU_HZ // 1000)


def test_a_chip_without_usb_has_no_port_there(start: Start) -> None:
    """
    Typing over USB to an ATmega328P is an error.
    """
    machine = start("serial")
    machine.send_usb(b"HAL")
    with pytest.raises(StepgenError, match="the chip has no USB"):
        machine.run_until(10_000)


def test_stack_of_an_isr_counts_its_return_address(start: Start) -> None:
    """
    The stack of an ISR goes from its return address to the deepest push.
    """
    machine = start("stack")
    machine.run_until(100_000)

    # 2 return address + 1 push + 2 rcall + 3 pushes; main is called (2) before.
    assert machine.isr_stack == {OVF: 8}
    assert machine.stack_deepest == 2 + 8
    assert {int(v) for v in of_kind(machine.events(), Kind.ISR_EXIT)["value"]} == {8}


def test_variables_can_be_read_and_written(start: Start) -> None:
    """
    The test sees the program's variables by name and may change them.
    """
    machine = start("stack")
    machine.run_until(1000)
    assert machine.read_ram(machine.symbol("answered"), 2) == b"\x03\x01"

    machine.write_ram(machine.symbol("asked"), b"\xff\x0f")
    assert machine.run_until_mark(9, limit_cycles=200)
    assert not machine.run_until_mark(10, limit_cycles=200)


def test_fine_recording_shows_when_interrupts_are_off(start: Start) -> None:
    """
    With fine recording each cli and sei of the main program leaves an event.
    """
    machine = start("masked")
    machine.fine = True
    assert machine.run_until_mark(4, limit_cycles=10_000)
    machine.run_until(machine.cycle + 10)
    events = machine.events()
    kinds = [Kind(k) for k in events["kind"] if k in {Kind.MASKED, Kind.UNMASKED}]

    assert kinds == [Kind.UNMASKED, Kind.MASKED] * 2
    # sei, nop, nop, cli: 3 cycles from the end of sei to the end of cli, and the ISR between.
    on, off = cycles(events, Kind.UNMASKED)[0], cycles(events, Kind.MASKED)[0]
    inside = cycles(events, Kind.ISR_EXIT)[0] - cycles(events, Kind.ISR_ENTER)[0]
    assert off - on == 3 + inside


def test_without_recording_the_program_runs_the_same(start: Start) -> None:
    """
    Nothing is recorded while it is off, and what comes after is at the cycles that it has anyway.
    """
    seen = []
    for on in (True, False):
        machine = start("periodic", MODE=15, CLOCK=1, TOP_VALUE=999)
        machine.record(on=on)
        machine.run_until(20_000)
        assert bool(len(machine.events())) == on
        machine.record(on=True)
        machine.clear_events()
        machine.run_until(40_000)
        seen.append(machine.events().tolist())

    assert seen[0] == seen[1]
    assert len(seen[0]) > 40


def test_fine_recording_changes_no_cycle(start: Start) -> None:
    """
    Looking at each instruction alone gives the same events at the same cycles.
    """
    runs: list[Events] = []
    for fine in (False, True):
        machine = start("masked")
        machine.fine = fine
        machine.run_until(20_000)
        events = machine.events()
        runs.append(events[~np.isin(events["kind"], [Kind.MASKED, Kind.UNMASKED])])

    assert (runs[0] == runs[1]).all()


@pytest.mark.parametrize("macros", [{}, {"LOST": 1}])
def test_crash_is_an_error(start: Start, macros: dict[str, int]) -> None:
    """
    A program that sleeps for ever or leaves its code raises, and says where.
    """
    machine = start("crash", **macros)

    with pytest.raises(StepgenError, match="the program crashed at cycle"):
        machine.run_until(100_000)


def test_two_machines_do_not_disturb_each_other(start: Start) -> None:
    """
    Two machines run in turns in one process, each with its own events.
    """
    one = start("periodic", MODE=FAST, CLOCK=1, TOP_VALUE=999)
    two = start("periodic", MODE=FAST, CLOCK=1, TOP_VALUE=499)
    for until in range(1000, 20_000, 777):
        one.run_until(until)
        two.run_until(until)

    assert set(gaps(one.events(), Kind.RAISE)) == {1000}
    assert set(gaps(two.events(), Kind.RAISE)) == {500}


def test_events_outlive_their_machine(start: Start) -> None:
    """
    An array of events stays valid after close(), and a closed machine says so.
    """
    with start("periodic", MODE=FAST, CLOCK=1, TOP_VALUE=999) as machine:
        machine.run_until(5000)
        events = machine.events()

    assert events.dtype == EVENT
    assert len(cycles(events, Kind.RAISE)) == 4
    with pytest.raises(StepgenError, match="closed"):
        machine.run_until(6000)


def test_unknown_chip_is_refused(start: Start, tmp_path: Path) -> None:
    """
    A chip without a table of facts is refused by name.
    """
    start("stack").close()

    with pytest.raises(
        StepgenError, match=r"attiny13.* atmega328p, atmega32u4, atmega1280 and atmega2560"
    ):
        Machine(tmp_path / "stack.elf", mcu="attiny13", f_cpu_hz=F_CPU_HZ)


def test_kinds_are_those_of_the_header() -> None:
    """
    The numbers of the kinds and the size of a record agree between C and Python.
    """
    harness = build.load()

    assert {kind: getattr(harness.lib, f"EVENT_{kind.name}") for kind in Kind} == {
        kind: kind.value for kind in Kind
    }
    assert harness.ffi.sizeof("event") == EVENT.itemsize


def test_missing_headers_name_the_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Without a compiler or libsimavr the error says which Debian packages to install.
    """
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    build.load.cache_clear()
    try:
        for compiler, reason in (("no-such-compiler", "not here"), ("false", "does not compile")):
            monkeypatch.setenv("CC", compiler)
            with pytest.raises(StepgenError, match=rf"{reason}.*apt install .*libsimavr-dev"):
                build.load()
    finally:
        build.load.cache_clear()
