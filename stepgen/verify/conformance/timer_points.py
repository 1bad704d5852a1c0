"""
Points about the timers. Sections are those of chapters 16 and 18 of the ATmega328P datasheet.
"""

from collections.abc import Iterator

from stepgen.verify.conformance.lab import Lab, cycles, gaps, of_kind, ram
from stepgen.verify.conformance.point import MEGA_1280_CHIP, MEGA_CHIP, USB_CHIP, Judge, point
from stepgen.verify.events import Kind

# Data addresses, chapter 31 "Register Summary".
TCCR1B, TCCR1C, TCNT1L, OCR1AL, TCCR2B = 0x81, 0x82, 0x84, 0x88, 0xB1
PORTB, OC1A = 0x25, 1 << 1  # OC1A is PB1
TIMER2_COMPA, TIMER1_COMPA, TIMER1_COMPB = 7, 11, 12  # table 12-6, number less one
# WGM13:0 and CS12:0, tables 16-4 and 16-5.
CTC, CTC_ICR, FAST_ICR, FAST = 4, 12, 14, 15
CLOCKS = {1: 1, 8: 2, 64: 3, 256: 4, 1024: 5}


def _period(mode: int) -> Judge:
    """
    Return the judge of the period in *mode*: prescaler * (TOP + 1), with each prescaler.
    """

    def judge(lab: Lab) -> Iterator[str]:
        for prescaler, clock in CLOCKS.items():
            with lab.running("periodic", MODE=mode, CLOCK=clock, TOP_VALUE=51) as machine:
                machine.run_until(5 * prescaler * 52)
                # The counter takes the TOP + 1 values 0 .. TOP.
                expected = [prescaler * 52] * 3
                seen = gaps(cycles(machine, Kind.RAISE))[:3]
                yield from lab.differ(f"cycles between flags at /{prescaler}", expected, seen)

    return judge


period_fast = point("fast-pwm-period", "mode 15: period of p x (OCR1A + 1) cycles", "16.9.3")(
    _period(FAST)
)
period_fast_icr = point(
    "fast-pwm-icr-period", "mode 14: period of p x (ICR1 + 1) cycles", "16.9.3"
)(_period(FAST_ICR))
period_ctc = point("ctc-period", "mode 4: period of p x (OCR1A + 1) cycles", "16.9.2")(_period(CTC))
period_ctc_icr = point(
    "ctc-icr-period", "mode 12: capture flag each p x (ICR1 + 1) cycles", "16.9.2"
)(_period(CTC_ICR))


@point("prescaler-phase", "The prescaler runs on, whenever the clock is switched on", "16.4")
def prescaler_phase(lab: Lab) -> Iterator[str]:
    """
    See that the first period ends at a multiple of the prescaler, the 21st after the clock was set.
    """
    for prescaler, clock in CLOCKS.items():
        for nops in (0, 1, 5):
            macros = {"MODE": FAST, "CLOCK": clock, "TOP_VALUE": 20, "NOPS": nops}
            with lab.running("periodic", watch=(TCCR1B,), **macros) as machine:
                machine.run_until(30 * prescaler + 2000)
                clock_on = cycles(machine, Kind.REGISTER)[-1]
                expected = (clock_on // prescaler + 21) * prescaler
                seen = cycles(machine, Kind.RAISE)[:1]
                what = f"first flag, clock /{prescaler} on at cycle {clock_on}"
                yield from lab.differ(what, [expected], seen)


@point("double-buffer", "mode 15: a new OCR1A acts one period later", "16.9.3")
def double_buffer(lab: Lab) -> Iterator[str]:
    """
    See that the period in which OCR1A is written keeps its 1000 cycles; the next has 500.
    """
    change = {"MODE": FAST, "FROM": 999, "TO": 499, "DELAY": 0, "CLOCK_TO": 1}
    with lab.running("change", watch=(OCR1AL,), **change) as machine:
        machine.run_until(8000)
        written = cycles(machine, Kind.REGISTER)[-1]
        raised = cycles(machine, Kind.RAISE)
        last = max(cycle for cycle in raised if cycle <= written)
        after = [cycle for cycle in raised if cycle >= last]
        yield from lab.differ("periods from the write on", [1000, 500, 500], gaps(after)[:3])


def _change_of_prescaler(lab: Lab, **change: int) -> Iterator[str]:
    """
    See that a new prescaler goes on from the count, while TOP stays until BOTTOM.

    The period then has count ticks of the old clock, of which there is one in each cycle, and
    9999 - count ticks of the new one to reach TOP, and one to leave it.
    """
    with lab.running("change", watch=(TCCR1B,), MODE=FAST, FROM=9999, TO=99, **change) as machine:
        slow = next(p for p, clock in CLOCKS.items() if clock == change["CLOCK_TO"])
        machine.run_until(60_000 + 10_000 * slow)
        switched = cycles(machine, Kind.REGISTER)[-1]
        raised = cycles(machine, Kind.RAISE)
        last = max(cycle for cycle in raised if cycle <= switched)
        count = switched - last
        end = (switched // slow + 10_000 - count) * slow
        after = [cycle for cycle in raised if cycle > last]
        what = f"end of the period whose clock became /{slow} at count {count}"
        yield from lab.differ(what, [end, end + 100 * slow], after[:2])


@point(
    "slow-step", "A new prescaler acts at once, the old TOP stays: one slow step", "16.4, 16.9.3"
)
def slow_step(lab: Lab) -> Iterator[str]:
    """
    From /1, TOP 9999, to /8, TOP 99, early in a period: a step of about 80 000 cycles.
    """
    yield from _change_of_prescaler(lab, CLOCK_TO=CLOCKS[8], DELAY=10)


@point("count-kept", "A new prescaler in mid-period goes on from the count", "16.4")
def count_kept(lab: Lab) -> Iterator[str]:
    """
    Do the same in the middle of a period, to /8 and to /64.
    """
    for prescaler in (8, 64):
        yield from _change_of_prescaler(lab, CLOCK_TO=CLOCKS[prescaler], DELAY=5000)


@point("count-zero-loads-nothing", "mode 15: TCNT1 = 0 by the CPU loads no buffer", "16.9.3")
def count_zero_loads_nothing(lab: Lab) -> Iterator[str]:
    """
    Only the clock after TOP does: so the period that is restarted has 10 000 ticks of /8.
    """
    change = {"MODE": FAST, "FROM": 9999, "TO": 99, "DELAY": 5000, "CLOCK_TO": CLOCKS[8]}
    with lab.running("change", watch=(TCNT1L,), RESTART=1, **change) as machine:
        machine.run_until(130_000)
        restarted = cycles(machine, Kind.REGISTER)[-1]
        after = [cycle for cycle in cycles(machine, Kind.RAISE) if cycle > restarted]
        expected = (restarted // 8 + 10_000) * 8
        yield from lab.differ("end of the restarted period", [expected], after[:1])


@point("start-order", "Stopped and set anew through mode 12: right from the first period", "16.9")
def start_order(lab: Lab) -> Iterator[str]:
    """
    See the new TOP in force at once, and the first period without the ticks given to TCNT1.
    """
    for prescaler, clock in CLOCKS.items():
        macros = {"FROM": 2999, "TO": 79, "ELAPSED": 33, "CLOCK": clock}
        with lab.running("start", watch=(TCCR1B,), **macros) as machine:
            machine.run_until(20_000 + 300 * prescaler)
            clock_on = cycles(machine, Kind.REGISTER)[-1]
            after = [cycle for cycle in cycles(machine, Kind.RAISE) if cycle > clock_on]
            first = (clock_on // prescaler + 80 - 33) * prescaler
            expected = [first, first + 80 * prescaler, first + 160 * prescaler]
            yield from lab.differ(f"flags after a start at /{prescaler}", expected, after[:3])


@point("late-compare-shows", "OCR1A written after mode 15: an early extra overflow", "16.9.3")
def late_compare_shows(lab: Lab) -> Iterator[str]:
    """
    See that the comparator still has 0: the first tick is BOTTOM already, and loads the buffer.
    """
    with lab.running("start", watch=(TCCR1B,), LATE=1, TO=79, CLOCK=1) as machine:
        machine.run_until(1000)
        clock_on = cycles(machine, Kind.REGISTER)[-1]
        expected = [clock_on + 1, clock_on + 81, clock_on + 161]
        yield from lab.differ("flags", expected, cycles(machine, Kind.RAISE)[:3])


@point("ctc-wrap", "mode 4: OCR1A below TCNT1 is met after a lap of 65 536", "16.9.2")
def ctc_wrap(lab: Lab) -> Iterator[str]:
    """
    Datasheet: "The counter will then have to count to its maximum value (0xFFFF) and wrap around".
    """
    change = {"MODE": CTC, "FROM": 999, "TO": 10, "DELAY": 100, "CLOCK_TO": 1}
    with lab.running("change", watch=(), **change) as machine:
        machine.run_until(75_000)
        seen = gaps(cycles(machine, Kind.RAISE))[:4]
        # 65 536 ticks, and 11 to leave the value 10.
        yield from lab.differ("cycles between flags", [1000, 1000, 65_536 + 11, 11], seen)


@point("normal-compare", "mode 0: OCR1A += n is exact; missed, it comes a lap later", "16.9.1")
def normal_compare(lab: Lab) -> Iterator[str]:
    """
    See that compares are n apart; one whose OCR1A came too late waits for the counter to wrap.
    """
    with lab.running("normal", STEP=1000, SLOW_AT=4) as machine:
        machine.run_until(80_000)
        seen = gaps(cycles(machine, Kind.RAISE))[:5]
        yield from lab.differ("cycles between flags", [1000, 1000, 1000, 65_536 + 1000, 1000], seen)


@point("two-channels", "mode 0: two channels are exact, whoever uses TEMP between", "16.3, 16.9.1")
def two_channels(lab: Lab) -> Iterator[str]:
    """
    See OCR1A and OCR1B move on by 700 and 900 for several laps, each on its own.
    """
    steps = {TIMER1_COMPA: 700, TIMER1_COMPB: 900}
    with lab.running("channels", STEP_A=700, STEP_B=900) as machine:
        machine.run_until(200_000)
        for vector, step in steps.items():
            seen = gaps(cycles(machine, Kind.RAISE, vector))[:200]
            yield from lab.differ(f"cycles between flags of {vector}", [step] * 200, seen)


@point("compare-flag-edge", "The compare flag comes with the tick after the match", "16.9.1")
def compare_flag_edge(lab: Lab) -> Iterator[str]:
    """
    Figures 16-10 and 16-11: at OCR1A = 251 with the 252nd tick.
    """
    macros = {"MODE": CTC, "CLOCK": CLOCKS[8], "TOP_VALUE": 251}
    with lab.running("periodic", watch=(TCCR1B,), **macros) as machine:
        machine.run_until(4000)
        clock_on = cycles(machine, Kind.REGISTER)[-1]
        expected = (clock_on // 8 + 252) * 8
        yield from lab.differ("first flag", [expected], cycles(machine, Kind.RAISE)[:1])


@point("timer2-compare", "Timer 2: a compare match each 256 ticks of its own prescaler", "18.7.1")
def timer2_compare(lab: Lab) -> Iterator[str]:
    """
    See the first match where OCR2A is left, counted from the tick after the start, then one a lap.
    """
    with lab.running("timer2", watch=(TCCR2B,), CLOCK=2, MATCH=200, NOPS=1001) as machine:
        machine.run_until(12_000)
        clock_on = cycles(machine, Kind.REGISTER)[-1]
        first = (clock_on // 8 + 201) * 8
        expected = [first + lap * 256 * 8 for lap in range(4)]
        seen = cycles(machine, Kind.RAISE, TIMER2_COMPA)[:4]
        yield from lab.differ("matches", expected, seen)


@point("timer2-moves", "Timer 2: OCR2A += n is exact; missed, it comes a lap later", "18.5, 18.7.1")
def timer2_moves(lab: Lab) -> Iterator[str]:
    """
    See matches 150 ticks of /8 apart; one whose OCR2A comes 200 ticks late waits for the wrap.
    """
    moves = {"MATCH": 149, "NOPS": 0, "STEP": 150, "SLOW_AT": 4, "SLOW": 200 * 8}
    with lab.running("timer2", watch=(), CLOCK=2, **moves) as machine:
        machine.run_until(12_000)
        seen = gaps(cycles(machine, Kind.RAISE, TIMER2_COMPA))[:5]
        expected = [150 * 8, 150 * 8, 150 * 8, (256 + 150) * 8, 150 * 8]
        yield from lab.differ("cycles between matches", expected, seen)


def _all_timers(*vectors: int) -> Judge:
    """
    Return the judge of all 16-bit timers at once, each with its vector and its period.
    """

    def judge(lab: Lab) -> Iterator[str]:
        with lab.running("all_timers") as machine:
            machine.run_until(30_000)
            for vector, period in zip(vectors, (1000, 2000, 3000, 4000), strict=False):
                seen = gaps(cycles(machine, Kind.RAISE, vector))[:4]
                yield from lab.differ(f"periods of vector {vector}", [period] * 4, seen)

    return judge


# Table 14-1, numbers less one.
four_timers = point(
    "four-timers", "Timers 1, 3, 4 and 5 of the ATmega2560 run at once", "17", MEGA_CHIP
)(_all_timers(20, 35, 45, 50))
four_timers_1280 = point(
    "four-timers-1280", "Timers 1, 3, 4 and 5 of the ATmega1280 run at once", "17", MEGA_1280_CHIP
)(_all_timers(20, 35, 45, 50))
# Atmel-7766, table "Reset and Interrupt Vectors", numbers less one.
two_timers_32u4 = point(
    "two-timers-32u4", "Timers 1 and 3 of the ATmega32U4 run at once", "Atmel-7766: 14", USB_CHIP
)(_all_timers(20, 35))


@point("compare-pins", "Compare outputs are set, toggled and cleared", "16.8")
def compare_pins(lab: Lab) -> Iterator[str]:
    """
    OC1A after a match: set, toggled twice, cleared (table 16-1).
    """
    with lab.running("pins") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen = ram(machine, "levels", 4)
        if seen != [1, 0, 1, 0]:
            yield f"levels of OC1A: {seen}, but the chip has [1, 0, 1, 0]"


@point("compare-pin-edges", "OC1A is set by a match with its flag, cleared by FOC1A", "16.7, 16.8")
def compare_pin_edges(lab: Lab) -> Iterator[str]:
    """
    See OC1A rise with each of four flags and fall where TCCR1C is written; it stays LOW after that.

    Figure 16-10 sets the flag with the clock that leaves OCR1A, and the same match is what the
    waveform generator gets.
    """
    with lab.running("outputs", watch=(TCCR1C,), STEP=300, LAST=4) as machine:
        machine.run_until(3_000)
        flags = cycles(machine, Kind.RAISE, TIMER1_COMPA)[:4]
        strobes = cycles(machine, Kind.REGISTER, TCCR1C)[:4]
        port = of_kind(machine, Kind.PORT, PORTB)
        ups = [int(row["cycle"]) for row in port if row["value"] == OC1A]
        downs = [int(row["cycle"]) for row in port if row["value"] == 0]
        yield from lab.differ("cycles between flags", [300] * 3, gaps(flags))
        yield from lab.differ("OC1A rises", flags, sorted(ups))
        yield from lab.differ("OC1A falls", strobes, sorted(downs))


@point("compare-force", "FOC1A acts as a match, at once and without the flag", "16.7.2, 16.11.3")
def compare_force(lab: Lab) -> Iterator[str]:
    """
    OC1A after a strobe: set, PORTB1, set, toggled twice, cleared, PORTB1; OCF1A stays 0.
    """
    with lab.running("force") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen, expected = ram(machine, "levels", 7), [1, 0, 1, 0, 1, 0, 1]
        if seen != expected:
            yield f"levels of OC1A: {seen}, but the chip has {expected}"
        if ram(machine, "flag", 1) != [0]:
            yield "FOC1A set OCF1A, which it does not on the chip"


@point("millis-period", "Timer 0 overflows each 64 x 256 cycles", "15.7.3")
def millis_period(lab: Lab) -> Iterator[str]:
    """
    See the interrupt of the Arduino core's millis(); the main loop is one rjmp of 2 cycles.
    """
    with lab.running("millis") as machine:
        machine.run_until(100_000)
        entered = [int(cycle) for cycle in of_kind(machine, Kind.ISR_ENTER)["cycle"]]
        late = [abs(gap - 64 * 256) for gap in gaps(entered)]
        if len(late) < 4 or max(late) > 2:  # noqa: PLR2004 - five overflows, one instruction
            yield f"interrupts {gaps(entered)} cycles apart, on the chip 16384"
