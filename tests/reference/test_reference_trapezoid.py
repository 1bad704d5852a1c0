"""
Traces of an axis, by hand from the contract.

The ladder of most of them has these levels, with h the steps to climb up to it, p those on it and X
the interval in clocks:

    level      0     1    2    3    4    5
    h          0     1    2    3    5    7
    p          1     1    1    2    2    -
    X       1000   900  800  700  650  600

A call at cycle 1000 sets the channel at 1020 so that the first step is due at 2000, one interval
after the call. ``left`` is counted after the step that was made, slack = left - h.
"""

from itertools import pairwise

import pytest

from stepgen.reference.axis import Turn
from stepgen.reference.contract import Code
from stepgen.reference.facts import MotorFacts
from stepgen.reference.ladder import Ladder, Level, Rung
from stepgen.reference.pulses import PulseFacts
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    AxisStimulus,
    ChannelSet,
    EdgeKind,
    Halt,
    Hold,
    Init,
    Move,
    MoveTo,
    QueueMoveTo,
    Release,
    RunOn,
    SetPace,
    SetPosition,
    Stop,
)
from stepgen.reference.trapezoid import Start, TrapezoidModel

LADDER = Ladder(1000 << 8, (Rung(3, 1, 100 << 8), Rung(2, 2, 50 << 8)))
TABLE, OFF = phases("four-wire", "full"), coils_off("four-wire")


def facts(
    ladder: Ladder = LADDER, cruise_256: int = 600 << 8, *, releases: bool = False, wake: int = 0
) -> MotorFacts:
    """
    Return an axis with *ladder*, at rest without current or with it, and a queue of three.
    """
    return MotorFacts(
        TABLE,
        OFF,
        200,
        "release" if releases else "hold",
        motion="trapezoid",
        timing="wide-compare",
        sees_passed=True,
        ladder=ladder,
        cruise_256=cruise_256,
        queue=3,
        wake_cycles=wake,
    )


def model_of(*stimuli: AxisStimulus, axis: MotorFacts | None = None) -> TrapezoidModel:
    """
    Return the model after *stimuli*.
    """
    model = TrapezoidModel(axis or facts())
    for stimulus in stimuli:
        model.apply(stimulus)
    return model


def started(call: AxisStimulus, *stimuli: AxisStimulus) -> TrapezoidModel:
    """
    Return the model after *call* at 1000, whose first step is due at 2000, and *stimuli*.
    """
    return model_of(call, ChannelSet(1_020, 980), *stimuli)


def steps(model: TrapezoidModel, until: int = 1_000_000) -> list[int]:
    """
    Return when each step is due that the model makes until a cycle.
    """
    return [edge.deadline_cycle for edge in model.advance(until) if edge.kind is EdgeKind.STEP]


def gaps(model: TrapezoidModel, until: int = 1_000_000) -> list[int]:
    """
    Return the interval before each step, the first one counted from cycle 1000.
    """
    deadlines = [1_000, *steps(model, until)]
    return [second - first for first, second in pairwise(deadlines)]


UP = [1000, 900, 800, 700, 700, 650, 650]
DOWN = UP[::-1]


def test_a_ladder_has_these_levels() -> None:
    """
    Rungs spread out to levels; the top has no steps of its own.
    """
    assert LADDER.levels == (
        Level(0, 1, 1000 << 8),
        Level(1, 1, 900 << 8),
        Level(2, 1, 800 << 8),
        Level(3, 2, 700 << 8),
        Level(5, 2, 650 << 8),
        Level(7, 0, 600 << 8),
    )


@pytest.mark.parametrize(
    ("cruise", "goal"),
    [(1, 5), (600, 5), (601, 4), (650, 4), (651, 3), (900, 1), (901, 0), (1000, 0), (5000, 0)],
)
def test_the_goal_is_the_highest_level_that_is_not_too_fast(cruise: int, goal: int) -> None:
    """
    Its interval is that of the cruise or longer; slower than the first one there is level 0.
    """
    assert LADDER.goal(cruise << 8) == goal


def test_a_long_move_goes_up_cruises_and_comes_down() -> None:
    """
    Twenty steps: seven up, six at 600, seven down.
    """
    # At h = 7: left = 20 - 7 = 13, slack 6: six flat ones, then 0, and down.
    model = started(MoveTo(1_000, 20))

    assert steps(model) == [
        *(2_000, 2_900, 3_700, 4_400, 5_100, 5_750, 6_400),
        *(7_000, 7_600, 8_200, 8_800, 9_400, 10_000),
        *(10_650, 11_300, 12_000, 12_700, 13_500, 14_400, 15_400),
    ]
    assert (model.position, model.target, model.distance, model.running) == (20, 20, 0, False)


@pytest.mark.parametrize(
    ("count", "expected"),
    [
        # left = 1, h = 0: slack 1, no room for 2: flat, and below the goal the level's own.
        (1, [1000]),
        # slack 2: up; then h = 1, left = 1: down.
        (2, [1000, 1000]),
        # h = 1, left = 2: slack 1: flat at 900; then down.
        (3, [1000, 900, 1000]),
        # h = 3, left = 9 - 3 = 6: slack 3, up needs 4: flat three times at 700.
        (9, [1000, 900, 800, 700, 700, 700, 800, 900, 1000]),
        # h = 3, left = 7: slack 4: up, two steps at 700; h = 5, left = 5: down.
        (10, [1000, 900, 800, 700, 700, 700, 700, 800, 900, 1000]),
        # h = 5, left = 8: slack 3, up needs 4: flat three times at 650.
        (13, [1000, 900, 800, 700, 700, 650, 650, 650, 700, 700, 800, 900, 1000]),
        # h = 7, left = 7: down at once.
        (14, [*UP, *DOWN]),
        (15, [*UP, 600, *DOWN]),
    ],
)
@pytest.mark.parametrize("direction", [1, -1])
def test_a_short_move_goes_up_only_as_far_as_it_comes_down_again(
    count: int, expected: list[int], direction: int
) -> None:
    """
    A triangle, flat on top where the next level does not fit twice; the same backwards.
    """
    model = started(Move(1_000, direction * count))

    assert gaps(model) == expected
    assert model.position == direction * count


def test_a_move_to_where_it_is_does_nothing() -> None:
    """
    No current, no step, no fault.
    """
    model = model_of(MoveTo(1_000, 0))

    assert model.advance(100_000) == []
    assert model.return_codes == (Code.FINE,)


def test_a_farther_target_in_flight_prolongs_the_move() -> None:
    """
    On the way down it goes up again from the next step on; where nothing changes, nothing shows.
    """
    # 9 steps; at 6000, after the sixth step at 5800 (2000, 2900, 3700, 4400, 5100, 5800), the way
    # down has begun: h = 2, position 6. To 12: d = 6 > 2, left = 6. At 6600: left 5, slack 3: up
    # from 800 (1 step); h = 3, left 4: slack 1: flat 700; left 3: down 800, 900, 1000.
    model = started(MoveTo(1_000, 9), MoveTo(6_000, 12))

    assert gaps(model)[5:] == [700, 800, 800, 700, 800, 900, 1000]
    assert model.position == 12


def test_a_call_that_changes_nothing_shows_nowhere() -> None:
    """
    A sketch that says the same again and again does not keep the axis from climbing.
    """
    again = [MoveTo(cycle, 20) for cycle in range(1_100, 15_400, 100)]

    assert gaps(started(MoveTo(1_000, 20), *again)) == [*UP, *[600] * 6, *DOWN]


def test_a_level_that_there_is_no_room_to_leave_stays() -> None:
    """
    The next step is the last of the visit: what comes then is decided with what is left.
    """
    # To 40: steps at 2000, 2900, 3700; h = 3, on two steps at 700. At 4000 to 9: a = 6, and
    # climbing on takes 2 + 3 + 2. At 4400: left 5, slack 2: flat twice; then down.
    model = started(MoveTo(1_000, 40), MoveTo(4_000, 9))

    assert gaps(model) == [1000, 900, 800, 700, 700, 700, 800, 900, 1000]
    # To 10: a = 7, and it climbs on: at 5100 left 5, h = 5: down.
    model = started(MoveTo(1_000, 40), MoveTo(4_000, 10))
    assert gaps(model) == [1000, 900, 800, 700, 700, 700, 700, 800, 900, 1000]


def test_a_level_that_is_walked_down_is_walked_to_its_end() -> None:
    """
    So long it takes at least to come to rest.
    """
    # To 14: down from 6400 on, at h = 5: 650 twice, then h = 3: 7700. At 6500 position 7: c = 2,
    # h = 5: to 14 is reached, to 13 only by turning round.
    model = started(MoveTo(1_000, 14), MoveTo(6_500, 14))
    assert gaps(model) == [*UP, *DOWN]

    model = started(MoveTo(1_000, 14), MoveTo(6_500, 13))
    assert gaps(model) == [*UP, *DOWN, 1000]
    assert model.position == 13


def test_stop_on_the_way_down_changes_nothing() -> None:
    """
    It comes to rest where it does anyhow.
    """
    model = started(MoveTo(1_000, 14), Stop(6_500))

    assert model.target == 14
    assert gaps(model) == [*UP, *DOWN]


def test_a_nearer_target_that_can_be_reached_is_reached() -> None:
    """
    From h = 7 at position 8 it needs eight steps: to 16 it goes.
    """
    # At 7100: position 8 (2000 ... 6400 are seven, 7000 the eighth). a = 8 = h + 1: left 8. At
    # 7600: left 7: down.
    model = started(MoveTo(1_000, 100), MoveTo(7_100, 16))

    assert gaps(model)[7:] == [600, 600, *DOWN]
    assert model.position == 16


@pytest.mark.parametrize("target", [15, 8, 0, -5])
def test_a_target_too_near_or_behind_is_reached_by_turning_round(target: int) -> None:
    """
    It comes to rest first, where it would stop, and then makes a leg of its own back.
    """
    # As above, but a < 8: eight steps more to 16, the last 1000 after the one before; then back.
    model = started(MoveTo(1_000, 100), MoveTo(7_100, target))

    assert model.target == target
    forward = gaps(model, 7_600 + sum(DOWN))
    assert forward[8:] == [600, *DOWN]
    assert model.position == 16
    assert model.running
    back = [7_600 + sum(DOWN), *steps(model)]
    assert len(back) - 1 == 16 - target
    assert back[1] - back[0] == 1000
    assert model.position == target
    assert not model.running


def test_a_turn_that_ends_where_it_should_ends_there() -> None:
    """
    A way that is just too short, but whose turn ends at it all the same, cannot be: one step less.
    """
    # At 7100 position 8 and h = 7: where it stops is 16, so 15 is one back.
    model = started(MoveTo(1_000, 100), MoveTo(7_100, 15))

    assert len(steps(model)) == 16 + 1
    assert model.position == 15


def test_a_turn_can_be_taken_back() -> None:
    """
    A target in front again, far enough, and it goes on without coming to rest.
    """
    # Turning at 7100; at 7700 it has position 9 and walks two steps at 650 down to h = 5. To 30:
    # a = 21; at 8900: left 19, slack 14: up, 650 twice: 10200; then 600.
    model = started(MoveTo(1_000, 100), MoveTo(7_100, -5), MoveTo(7_700, 30))

    assert gaps(model)[8:14] == [600, 650, 650, 650, 650, 600]
    assert model.position == 30


def test_stop_comes_down_from_where_it_is() -> None:
    """
    The next step as planned, then down; the target is where that ends.
    """
    # At 7100 position 8, h = 7: left 8.
    model = started(RunOn(1_000, 1), Stop(7_100))

    assert model.target == 16
    assert gaps(model)[7:] == [600, 600, *DOWN]
    assert model.position == 16


def test_stop_on_the_way_up_comes_down_at_once() -> None:
    """
    A level that is not complete plays no part.
    """
    # At 4000 position 3, h = 3, on its first step at 700: left 4; 4400; then 800, 900, 1000.
    model = started(RunOn(1_000, -1), Stop(4_000))

    assert gaps(model) == [1000, 900, 800, 700, 800, 900, 1000]
    assert model.position == -7


def test_stop_before_the_first_step_leaves_that_one() -> None:
    """
    The interval in progress ends as it was, with its step.
    """
    model = started(MoveTo(1_000, 100), Stop(1_500))

    assert gaps(model) == [1000]
    assert (model.position, model.target) == (1, 1)


@pytest.mark.parametrize("releases", [False, True])
def test_halt_makes_no_step_any_more(*, releases: bool) -> None:
    """
    The position is kept, the queue is not; the next leg begins from rest.
    """
    model = model_of(
        MoveTo(1_000, 100),
        ChannelSet(1_020, 980),
        QueueMoveTo(1_100, 7),
        Halt(7_100),
        axis=facts(releases=releases),
    )

    edges = model.advance(50_000)
    assert sum(edge.kind is EdgeKind.STEP for edge in edges) == 8
    assert (edges[-1].kind is EdgeKind.COILS_OFF) == releases
    assert (model.position, model.target, model.running) == (8, 8, False)
    model.apply(Move(60_000, 2))
    model.apply(ChannelSet(60_010, 990))
    assert steps(model) == [61_000, 62_000]


def test_a_faster_pace_goes_on_up_and_a_slower_one_comes_down_to_it() -> None:
    """
    A pace between two levels is that of the cruise; the levels are those of the ladder.
    """
    # 750 is slower than level 3: goal 2 (800). From h = 2 flat at 750. At 6000 (2000, 2900, 3700,
    # 4450, 5200, 5950): 660, goal 3; at 6700: up 800 (1 step): 7500; flat at 660: 8160. At 8200
    # 850, goal 1: at 8820 h = 3: down 800: 9620; down 900: 10520; flat 850: 11370.
    model = model_of(
        SetPace(900, 750 << 8),
        RunOn(1_000, 1),
        ChannelSet(1_020, 980),
        SetPace(6_000, 660 << 8),
        SetPace(8_200, 850 << 8),
    )

    assert gaps(model, 11_370)[3:] == [750, 750, 750, 750, 800, 660, 660, 800, 900, 850]


@pytest.mark.parametrize(
    ("pace", "expected"),
    [
        # At 4000 h = 3, two steps at 700, c = 2. 620: goal 4, h = 5: climbs on.
        (620, [700, 700, 620]),
        # 660: goal 3: the level stays, and from the next step on it is that of the cruise.
        (660, [700, 660, 660]),
    ],
)
def test_a_pace_lets_a_level_be_climbed_from_or_not(pace: int, expected: list[int]) -> None:
    """
    A visit on the way up goes on to its end unless what follows is beyond the new goal.
    """
    model = started(RunOn(1_000, 1), SetPace(4_000, pace << 8))

    assert gaps(model, 5_800)[3:6] == expected


def test_a_pace_slower_than_the_first_interval_is_that_of_level_0() -> None:
    """
    In flight it comes down to rest, as it were, and goes on more slowly than it began.
    """
    # At 3000 h = 2 (2000, 2900): 3700. Down: 900: 4600; 1000: 5600; flat 5000: 10600.
    model = started(RunOn(1_000, 1), SetPace(3_000, 5_000 << 8))

    assert gaps(model, 20_000) == [1000, 900, 800, 900, 1000, 5000, 5000]


def test_a_pace_that_is_too_fast_is_refused() -> None:
    """
    The cruise speed of the spec is the highest. Nothing is cut: the two steps of a level go on.
    """
    model = started(MoveTo(1_000, 40), SetPace(4_000, (600 << 8) - 1))

    assert model.return_codes[-1] == Code.TOO_FAST
    assert steps(model, 6_000) == [2_000, 2_900, 3_700, 4_400, 5_100, 5_750]
    assert model.apply(SetPace(6_000, 600 << 8)) == Code.FINE
    assert model.apply(SetPace(6_100, 0xFFFF_FFFF)) == Code.FINE


def test_running_the_other_way_turns_round() -> None:
    """
    Down to rest, then up in the other direction, without an end; the target is where it is.
    """
    # At 7100 position 8, h = 7: to 16, then back.
    model = started(RunOn(1_000, 1), RunOn(7_100, -1))

    assert gaps(model, 30_000)[8:22] == [600, *DOWN, *UP[:6]]
    assert model.running
    assert model.target == model.position
    assert model.distance == 0


def test_running_on_while_it_turns_takes_the_turn_back() -> None:
    """
    Wanted the other way and then this way again, it climbs from where it is.
    """
    # As with a turn that is taken back by a target.
    model = started(RunOn(1_000, 1), RunOn(7_100, -1), RunOn(7_700, 1))

    assert gaps(model, 10_800)[8:] == [600, 650, 650, 650, 650, 600]


def test_a_queue_of_three_is_made_one_after_the_other() -> None:
    """
    Each leg from rest to rest, the next step an interval after the last; a fourth has no place.
    """
    # To 2, then 3 (one step), back to 1 (two steps), and to 2 (one step).
    queued = [QueueMoveTo(1_100 + place, to) for place, to in enumerate((3, 1, 2, 9))]
    model = started(MoveTo(1_000, 2), *queued)

    assert model.return_codes[1:] == (Code.FINE, Code.FINE, Code.FINE, Code.QUEUE_FULL)
    assert (model.target, model.distance) == (2, 2)
    assert gaps(model) == [1000, 1000, 1000, 1000, 1000, 1000]
    assert (model.position, model.running) == (2, False)


def test_a_target_that_is_the_last_already_takes_no_place() -> None:
    """
    Neither that of the leg under way nor one that waits is asked for twice.
    """
    queued = [QueueMoveTo(1_100 + place, to) for place, to in enumerate((2, 3, 3, 1, 2, 2, 9))]
    model = started(MoveTo(1_000, 2), *queued)

    assert model.return_codes[1:] == (*[Code.FINE] * 6, Code.QUEUE_FULL)
    assert gaps(model) == [1000, 1000, 1000, 1000, 1000, 1000]


def test_a_place_in_the_queue_is_free_when_its_leg_begins() -> None:
    """
    Not when that leg ends.
    """
    # The first leg ends at 3000; the one to 5 begins then.
    queued = (QueueMoveTo(1_100 + place, place) for place in (5, 6, 7))
    model = started(MoveTo(1_000, 2), *queued)

    assert model.apply(QueueMoveTo(2_999, 8)) == Code.QUEUE_FULL
    assert model.apply(QueueMoveTo(3_000, 8)) == Code.FINE


def test_a_queue_at_rest_begins_to_move_and_without_an_end_is_refused() -> None:
    """
    At rest there is nothing to wait for; what never ends lets nothing come after it.
    """
    model = started(QueueMoveTo(1_000, 2))
    assert gaps(model, 5_000) == [1000, 1000]

    model = started(RunOn(1_000, 1), QueueMoveTo(1_100, 2))
    assert model.return_codes[-1] == Code.RUNNING


def test_a_new_move_empties_the_queue() -> None:
    """
    So do all calls that are not in the queue.
    """
    for call in (MoveTo(2_100, 4), Move(2_100, 3), Stop(2_100), RunOn(2_100, 1)):
        model = started(MoveTo(1_000, 10), QueueMoveTo(1_100, -50), call, Stop(2_200))
        steps(model)
        assert model.position > 0


def test_fractions_of_a_clock_add_up() -> None:
    """
    Of an interval of 1000 and 100/256 every third or second one is a clock longer.
    """
    # The first step is due at 2000 with a fraction of 100; then 200, 300 - 256 = 44: a clock more.
    # 144, 244, 344 - 256 = 88: a clock more.
    ladder = Ladder((1000 << 8) + 100, (Rung(1, 1, 0),))
    axis = facts(ladder, (1000 << 8) + 100)
    model = model_of(MoveTo(1_000, 6), ChannelSet(1_020, 980), axis=axis)

    assert steps(model) == [2_000, 3_000, 4_001, 5_001, 6_001, 7_002]


def test_slow_intervals_have_laps_and_fractions() -> None:
    """
    100 003 and a half clocks are a first match after 18 083 and five laps of 16 384.
    """
    # 100003 = 6 * 16384 + 1699: the first match 16384 + 1699 = 18083 after the call. Set at 1020
    # for 19083: 18063 ahead. The step 5 * 16384 = 81920 later: 101003. The fraction was 128: the
    # second comes 100004 later: 201007, the third 100003: 301010, with 50001 and a half in between.
    ladder = Ladder((100_003 << 8) + 128, (Rung(1, 1, 50_002 << 8),))
    axis = facts(ladder, (50_001 << 8) + 128)
    model = model_of(MoveTo(1_000, 2), ChannelSet(1_020, 18_063), axis=axis)
    assert steps(model) == [101_003, 201_007]

    # 101003 (128); 50001 and a half: 151005 (0); 100003 and a half: 251008 (128).
    model = model_of(MoveTo(1_000, 3), ChannelSet(1_020, 18_063), axis=axis)
    assert steps(model) == [101_003, 151_005, 251_008]


def test_the_coils_go_off_an_interval_after_the_last_step() -> None:
    """
    With the interval before the last step once more; the axis does not count as running then.
    """
    model = model_of(MoveTo(1_000, 1), ChannelSet(1_020, 980), axis=facts(releases=True))

    assert [(edge.deadline_cycle, str(edge.kind)) for edge in model.advance(2_999)] == [
        (1_000, "energise"),
        (2_000, "step"),
    ]
    assert not model.running
    assert [edge.deadline_cycle for edge in model.advance(3_000)] == [3_000]


def test_a_driver_that_wakes_up_gets_a_longer_first_interval() -> None:
    """
    Only from rest, not where a leg begins with the end of another.
    """
    # 5000 after the call: 1020 + 4980. Then two steps back at 1000 each, the last of a leg of one
    # step being the first of the next.
    model = model_of(
        MoveTo(1_000, 1), ChannelSet(1_020, 4_980), QueueMoveTo(1_100, -1), axis=facts(wake=5_000)
    )

    assert model.starts == (Start(1_000, 5_000),)
    assert steps(model) == [6_000, 7_000, 8_000]


def test_the_ramp_of_a_driver_that_wakes_up_begins_with_the_second_step() -> None:
    """
    Of nine steps the first comes by itself, and eight go up and down the ladder.
    """
    model = model_of(MoveTo(1_000, 9), ChannelSet(1_020, 4_980), axis=facts(wake=5_000))
    deadlines = steps(model)

    assert deadlines[0] == 6_000
    assert [after - before for before, after in pairwise(deadlines)] == [
        *(1_000, 900, 800),
        *(700, 700),
        *(800, 900, 1_000),
    ]


def test_dir_turns_with_the_last_step_of_a_leg() -> None:
    """
    The next leg begins then; from rest it turns with the call.
    """
    pulse = PulseFacts(20, 40, 20, 20, 20, 20, enabled_level=False)
    axis = MotorFacts(
        pulse.phases,
        pulse.coils_off,
        200,
        "hold",
        motion="trapezoid",
        timing="wide-compare",
        has_direction=True,
        ladder=LADDER,
        cruise_256=600 << 8,
        queue=3,
    )
    model = model_of(MoveTo(1_000, -1), ChannelSet(1_020, 980), QueueMoveTo(1_100, 0), axis=axis)

    model.advance(50_000)

    assert model.turns == (Turn(1_000, -1), Turn(2_000, 1))


def test_only_at_rest_it_is_told_where_it_is_and_switched() -> None:
    """
    While it runs these calls are refused and change nothing.
    """
    model = started(MoveTo(1_000, 2))
    calls = (SetPosition(1_500, 77), Hold(1_600), Release(1_700))
    assert [model.apply(call) for call in calls] == [Code.RUNNING] * 3
    assert model.position == 0

    at_rest = (SetPosition(5_000, 77), Release(5_100), Hold(5_200), Init(5_300))
    model.advance(4_000)
    assert [model.apply(call) for call in at_rest[:1]] == [Code.FINE]
    assert (model.position, model.target) == (77, 77)
    assert [model.apply(call) for call in at_rest[1:3]] == [Code.FINE] * 2
    assert [str(edge.kind) for edge in model.advance(5_299)] == ["coils-off", "energise"]
    model.apply(at_rest[3])
    assert (model.position, model.target, model.running) == (0, 0, False)


def test_init_is_the_beginning_again() -> None:
    """
    The pace of the spec, no queue, no step, nothing missed.
    """
    model = started(RunOn(1_000, -1), SetPace(1_500, 900 << 8), Init(7_100), MoveTo(8_000, 20))
    model.apply(ChannelSet(8_020, 980))
    assert model.position == 0

    deadlines = steps(model)
    # The last seven steps are those down from the cruise.
    assert deadlines[-8] - deadlines[-9] == 600
    assert model.position == 20


@pytest.mark.parametrize(("set_cycle", "missed"), [(2_899, 0), (2_900, 1)])
def test_a_step_that_is_due_before_its_channel_is_set_is_missed(
    set_cycle: int, missed: int
) -> None:
    """
    The step after that at 2000 is due at 2900: a channel matches from the clock after its setting.
    """
    sets = {2_000: set_cycle}
    model = TrapezoidModel(facts(), set_cycle=lambda deadline: sets.get(deadline, deadline + 40))
    model.apply(MoveTo(1_000, 20))
    model.apply(ChannelSet(1_020, 980))

    assert len(steps(model)) == 20
    assert model.overruns == missed


def test_positions_wrap_at_32_bits() -> None:
    """
    From the highest number one step on is the lowest; half way round counts as backward.
    """
    highest = (1 << 31) - 1
    model = TrapezoidModel(facts(), position=highest)
    model.apply(MoveTo(1_000, -(1 << 31)))
    model.apply(ChannelSet(1_020, 980))
    assert steps(model, 3_000) == [2_000]
    assert model.position == -(1 << 31)

    model.apply(MoveTo(5_000, 0))
    model.apply(ChannelSet(5_020, 980))
    steps(model, 6_000)
    assert model.position == highest


def test_facts_without_a_ladder_are_of_no_axis() -> None:
    """
    The model needs one.
    """
    with pytest.raises(ValueError, match="no ladder"):
        TrapezoidModel(MotorFacts(TABLE, OFF, 200, "hold"))


def test_time_does_not_run_backwards() -> None:
    """
    What happens before what has happened is an error of who tells it.
    """
    model = started(MoveTo(1_000, 1))

    with pytest.raises(ValueError, match="cycle 900 lies before cycle 1020"):
        model.advance(900)
