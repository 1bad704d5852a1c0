"""
Compare on a 16-bit timer: it runs through without a prescaler; each motor has a compare channel.

At a step OCRnx goes on by the interval, so that each step is due at its very clock, whatever the
other channels do. An interval of 32 768 clocks or more begins with one of 16 384 to 32 767 and
goes on in laps of 16 384, each an interrupt without a step.

A compare register that is written after its moment has passed would be met a lap of 65 536 clocks
later. So each interrupt looks at the counter after it has written OCRnx: where that moment has
passed and no flag is set, the interrupt is asked for once more, at once. That can be told as
long as the counter is less than half round.

Source: ATmega328P datasheet, "16-bit Timer/Counter1 with PWM", Normal Mode, Output Compare Units,
Accessing 16-bit Registers.
"""

from collections.abc import Iterator

from stepgen.devices import Board, Mcu
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import Cadence, Left, Setting, TimerPlan
from stepgen.plan.wide_gate import wide_gate
from stepgen.spec.timings.compare import Compare

LAP_CYCLES = 16_384
LONGEST_SINGLE_CYCLES = 32_767
"""The longest interval that is not divided into laps: the counter's half round."""
LONGEST_WAIT_CYCLES = 32_000
"""How long an interrupt may be held up for a moment that has passed to be seen and served."""
SMALLEST_PERIOD_CYCLES = 100
LARGEST_PERIOD_CYCLES = 65_535 * 1024  # that of fast PWM: the motions' clocks need a step so often
_SHARING = "a timer that runs through, of several motors"


def with_channels(board: Board, left: Left) -> Iterator[int]:
    """
    Yield the 16-bit timers that have a channel *left*: first those that motors share already.
    """
    for number, taken in left.channels.items():
        timer = board.mcu.timer16(number)
        if timer and set(timer.compare_channels) - set(taken):
            yield number
    yield from (number for number in left.free if board.mcu.timer16(number))


def plan_wide(
    spec: Compare, wanted: int | None, board: Board, left: Left, faults: Faults
) -> TimerPlan | None:
    """
    Return the timer *wanted* with the channel of *spec*, or its first one that is *left*.

    Returns None after reporting why it cannot be.
    """
    if wanted is None:
        faults.at("kind").report(
            f"the {board.title} has no compare channel left for this motor; take a larger board, "
            "or remove a motor or a library from `uses`"
        )
        return None
    timer = board.mcu.timer16(wanted)
    if timer is None:
        numbers = [str(each.number) for each in board.mcu.timers]
        faults.at("timer").report(
            f"compare does not run on timer {wanted} of the {board.title}, only on timer "
            f"{' or '.join(numbers)}"
        )
        return None
    channels = timer.compare_channels
    taken = left.channels.get(timer.number, ())
    wish: str | None = spec.channel
    chosen = wish or next((name for name in channels if name not in taken), next(iter(channels)))
    if chosen not in channels:
        faults.at("channel").report(
            f"timer {timer.number} of the {board.title} has no channel {chosen}; take "
            f"{' or '.join(channels)}"
        )
        return None
    return TimerPlan(
        kind="compare",
        timer=timer,
        vector=channels[chosen][1].name,
        event=f"compare match {chosen}",
        instant="the match",
        smallest_period_cycles=SMALLEST_PERIOD_CYCLES,
        largest_period_cycles=_largest_period_cycles(spec, board),
        rule=(
            "A step that was already due when the one before was made is made at once and "
            "counted; all others stay where they are due. But after "
            f"more than {LONGEST_WAIT_CYCLES} clocks with interrupts off a step, and all that "
            "follow it, can come 65536 clocks late, and nothing tells."
        ),
        is_set_anew=False,
        form="wide-compare" if spec.longest_period_s is None else "long-compare",
        channel=chosen,
        sharing=_SHARING,
    )


def _largest_period_cycles(spec: Compare, board: Board) -> int:
    """
    Return the clocks of the longest period of *spec*, never less than those without one.
    """
    return max((spec.longest_period_s or 0) * board.f_cpu_hz, LARGEST_PERIOD_CYCLES)


def way_out(board: Board, free: tuple[int, ...]) -> str:
    """
    Return what a motor can take in place of its timer: the first of those that are *free*.
    """
    if free:
        return f"take `timing: {{kind: compare, timer: {free[0]}}}`"
    return f"take a larger board than the {board.title}, since no timer that fits is left on it"


def gate(timing: TimerPlan, motion: Motion, storage: Storage, _mcu: Mcu) -> Gate:
    """
    Return how the interrupt sets its compare register, and what it does about laps.
    """
    return wide_gate(timing, motion, storage)


def cadence(period_cycles: int) -> Cadence:
    """
    Return how often its interrupt comes, and how long one may wait without being lost.
    """
    spacing = period_cycles if period_cycles <= LONGEST_SINGLE_CYCLES else LAP_CYCLES
    return Cadence(spacing, LONGEST_WAIT_CYCLES)


def choose_setting(period_cycles: int) -> Setting:
    """
    Return the clocks of *period_cycles*: exactly as many; they may be many laps of the timer.
    """
    return Setting(1, period_cycles - 1)
