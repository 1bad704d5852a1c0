"""
The runs of real hardware that systems/1-motor-driver.md records, in the model.

The call comes at cycle 150 000, when ``millis()`` returns 9 as in the log (its first event is
due at 1009). ``millis()`` follows the core at 16 MHz: each overflow of timer 0, 16384 cycles, is
1 ms and 3/125 of one. No other clock than that of the start is told to the model: across
prescalers it then counts the new interval from the very step, as a perfect re-arm would.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import pytest

from stepgen.reference.contract import Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    CallBack,
    Callbacks,
    ClockOn,
    MillisTick,
    SetSpeed,
    UpdateCheck,
)

SHIELD = MotorFacts(
    phases("motor-shield", "full"), coils_off("motor-shield"), 640, "hold", "update-events"
)
F_CPU_HZ = 16_000_000
CALL_CYCLE = 150_000
CHECK_EACH_MS = 50

# One print's delay, from the stamps in the log. The host stamps lines in lumps up to 54 ms
# apart (18:01:59.067, .121), and one dump of ten lines lasts up to 101 ms from its first stamp to
# its last (18:02:05.182 to 05.283): a printed value may be as much older or younger than its stamp.
STAMP_MS = 54
DUMP_MS = 101 + STAMP_MS


@dataclass
class Record:
    """
    What one run showed: rows (milliseconds since the call, virtual value, modification).
    """

    model: MotorModel
    rows: list[tuple[int, int, int]] = field(default_factory=list)
    step_cycles: list[int] = field(default_factory=list)

    def step_ms(self, number: int) -> int:
        """
        Return the milliseconds from the call to step *number*, the first being 1.
        """
        return _since_call_ms(self.step_cycles[number - 1])


def _since_call_ms(cycle: int) -> int:
    return (cycle - CALL_CYCLE) * 1000 // F_CPU_HZ


def _millis_ticks(first: int, until_cycle: int) -> Iterator[MillisTick]:
    for overflow in range(first, until_cycle // 16_384 + 1):
        yield MillisTick(overflow * 16_384, overflow + overflow * 3 // 125)


def _record(call: SetSpeed, prescaler: int, seconds: int, *, checks: bool = False) -> Record:
    """
    Run *call* for so many seconds, with a check of the updates each 50 ms if *checks*.
    """
    record = Record(MotorModel(SHIELD))
    model = record.model
    for stimulus in (
        Callbacks(0, reached=True, fault=True),
        MillisTick(9 * 16_384, 9),
        call,
        ClockOn(CALL_CYCLE + 60, prescaler, 0),
    ):
        assert model.apply(stimulus) == 0
    checked = 9
    for tick in _millis_ticks(10, CALL_CYCLE + seconds * F_CPU_HZ):
        model.apply(tick)
        if checks and tick.millis - checked >= CHECK_EACH_MS:
            checked = tick.millis
            model.apply(UpdateCheck(tick.cycle + 100))
            model.apply(CallBack(tick.cycle + 100))
        steps = [edge for edge in model.advance(tick.cycle + 100) if edge.kind == "step"]
        record.step_cycles += [edge.deadline_cycle for edge in steps]
        row = (model.virtual_cycles, model.modification)
        if not record.rows or record.rows[-1][1:] != row:
            record.rows.append((_since_call_ms(tick.cycle), *row))
    return record


@pytest.fixture(scope="module")
def slowing_down() -> Record:
    """
    Case 1.
    """
    return _record(SetSpeed(CALL_CYCLE, 0xF0, 15_000, 8900, 64, 1000, 19), 1, 14)


def test_case_1_columns(slowing_down: Record) -> None:
    """
    Slowing down shows the recorded TOP and modification columns, one row a second.
    """
    assert [row[1:] for row in slowing_down.rows] == [
        (15_000, 64),
        (15_064, 128),
        (15_192, 256),
        (15_448, 512),
        (15_960, 1024),
        (16_984, 2048),
        (19_032, 4096),
        (23_128, 8192),
        (31_320, 16_384),
        (47_704, 32_768),
        (80_472, 65_536),
        (146_008, 131_072),
        (277_080, 262_144),
    ]
    # Late by at most the interval in progress (9.2 ms) and two ticks of millis.
    for second, row in enumerate(slowing_down.rows[1:], start=1):
        assert 0 <= row[0] - 1000 * second <= 12


def test_case_1_halts_after_its_steps(slowing_down: Record) -> None:
    """
    It halts 12.8 to 13.0 s after the call with 8900 steps made and 7 of 19 updates unused.
    """
    assert len(slowing_down.step_cycles) == slowing_down.model.position == 8900
    assert 12_800 <= slowing_down.step_ms(8900) <= 13_000
    assert slowing_down.model.updates_left == 7
    assert (slowing_down.model.status, slowing_down.model.running) == (Status.REACHED, False)


@pytest.mark.parametrize(
    ("printed_ms", "steps_left", "virtual_cycles", "delay_ms"),
    [
        (50, 8844, 15_000, STAMP_MS),
        (1160, 7656, 15_064, STAMP_MS),
        (2150, 6594, 15_192, STAMP_MS),
        (3160, 5543, 15_448, STAMP_MS),
        (4160, 4512, 15_960, STAMP_MS),
        (5160, 3519, 16_984, STAMP_MS),
        (6160, 2593, 19_032, STAMP_MS),
        (7220, 1777, 23_128, STAMP_MS),
        (8220, 1116, 31_320, STAMP_MS),
        (9220, 634, 47_704, STAMP_MS),
        # From here on the recorded motor lags: its slow steps at a change (weakness 4), first
        # 47704 * 8 cycles = 24 ms instead of 5 ms, when the prescaler 8 acts on the old TOP.
        (10_210, 326, 80_472, DUMP_MS),
        (11_230, 143, 146_008, DUMP_MS),
        (12_230, 42, 277_080, DUMP_MS),
    ],
)
def test_case_1_steps_left(
    slowing_down: Record, printed_ms: int, steps_left: int, virtual_cycles: int, delay_ms: int
) -> None:
    """
    The printed steps are left at the printed time, but for the delay of one print.
    """
    made = 8900 - steps_left
    begin_ms, end_ms = slowing_down.step_ms(made), slowing_down.step_ms(made + 1)
    shown = [row[1] for row in slowing_down.rows if row[0] <= begin_ms]

    assert begin_ms - delay_ms <= printed_ms <= end_ms + delay_ms
    assert shown[-1] == virtual_cycles


SPEEDING_UP_ROWS = [
    (4_800_000, 2_385_000),
    (2_415_000, 1_192_500),
    (1_222_500, 596_250),
    (626_250, 298_125),
    (328_125, 149_062),
    (179_063, 74_531),
    (104_532, 37_265),
    (67_267, 18_632),
    (48_635, 9316),
    (39_319, 4658),
    (34_661, 2329),
    (32_332, 1164),  # the eleventh halving, 2329 / 2; no event uses it
]


def test_case_2_columns() -> None:
    """
    Speeding up without end shows the recorded columns, 11 updates, then 32332 for ever.
    """
    record = _record(SetSpeed(CALL_CYCLE, 0xF2, 4_800_000, 0, 2_385_000, 1000, 11), 256, 15)

    assert [row[1:] for row in record.rows] == SPEEDING_UP_ROWS
    # Each at the first step once it is due; steps are at most 300 ms apart.
    for second, row in enumerate(record.rows[1:], start=1):
        assert 0 <= row[0] - 1000 * second <= 302
    gaps = {two - one for one, two in pairwise(record.step_cycles[-1000:])}
    assert gaps == {32_332}
    assert (record.model.status, record.model.updates_left) == (Status.SPIN_FIXED, 0)


def test_case_3_is_timed_from_the_loop_and_calls_back() -> None:
    """
    Without IRQ_TIMING the checks apply the updates, and one makes the callback at the end.
    """
    call = SetSpeed(CALL_CYCLE, 0xE2, 4_800_000, 10_000, 2_385_000, 1000, 11)

    record = _record(call, 256, 30, checks=True)

    assert [row[1:] for row in record.rows] == SPEEDING_UP_ROWS
    for second, row in enumerate(record.rows[1:], start=1):
        assert 0 <= row[0] - 1000 * second <= CHECK_EACH_MS + 2
    ((callback_cycle, which),) = record.model.callbacks
    assert which == "reached"
    assert 27_500 <= _since_call_ms(callback_cycle) <= 28_200
    assert 0 <= _since_call_ms(callback_cycle) - record.step_ms(10_000) <= CHECK_EACH_MS + 2
    assert len(record.step_cycles) == 10_000
    assert record.model.status == Status.REACHED | Status.REACH_CALLED


def test_equal_changes() -> None:
    """
    6 to 800 steps/s in 29 updates of 91264, 250 ms apart, reaches 20000 but for rounding.
    """
    record = _record(SetSpeed(CALL_CYCLE, 0xD2, 2_666_666, 0, 91_264, 250, 29), 64, 8)

    values = [row[1] for row in record.rows]
    assert values[0] == 2_666_666
    assert {one - two for one, two in pairwise(values)} == {91_264}
    assert len(values) == 30
    assert values[-1] == 20_010  # 2666666 - 29 * 91264; 2646666 / 29 is 91264.3
    assert record.model.status == Status.SPIN_FIXED
