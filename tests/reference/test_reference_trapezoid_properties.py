"""
What holds of every ladder and every move, for many of both.
"""

from dataclasses import dataclass
from itertools import accumulate, pairwise

from hypothesis import given
from hypothesis import strategies as st

from stepgen.reference.ladder import Ladder, Rung
from stepgen.reference.stimuli import ChannelSet, Edge, EdgeKind, Move, MoveTo, SetPace, Stop
from stepgen.reference.timer import FRACTIONS, first_match_cycles
from stepgen.reference.trapezoid import TrapezoidModel
from tests.reference.test_reference_trapezoid import facts

SLOWEST_256 = 200_000 * FRACTIONS
FASTEST_256 = 200 * FRACTIONS


@st.composite
def ladders(draw: st.DrawFn) -> Ladder:
    """
    Draw a ladder of a few rungs that stays slower than the fastest interval.
    """
    first = draw(st.integers(2 * FASTEST_256, SLOWEST_256))
    room = first - FASTEST_256
    rungs = []
    for _ in range(draw(st.integers(1, 4))):
        levels = draw(st.integers(1, 6))
        slope = draw(st.integers(0, room // levels))
        room -= levels * slope
        rungs.append(Rung(levels, 1 << draw(st.integers(0, 3)), slope))
    return Ladder(first, tuple(rungs))


@dataclass
class Sketch:
    """
    A model of an axis with *ladder*, whose channel is set as soon as a call asks for it.
    """

    ladder: Ladder
    cruise_256: int

    def __post_init__(self) -> None:
        self.model = TrapezoidModel(facts(self.ladder, self.cruise_256))
        self.cycle = 1_000
        self.edges: list[Edge] = []

    def do(self, call: MoveTo | Move | SetPace | Stop) -> None:
        """
        Make *call*, and set the channel if that began a leg.
        """
        self.edges += self.model.advance(call.cycle)
        before = len(self.model.starts)
        self.model.apply(call)
        if len(self.model.starts) > before:
            interval = self.model.starts[-1].interval_cycles
            self.model.apply(ChannelSet(call.cycle, first_match_cycles(interval)))

    def run_out(self) -> None:
        """
        Let what is under way come to its end.
        """
        while self.model.running:
            self.cycle += 1_000_000
            self.edges += self.model.advance(self.cycle)

    @property
    def gaps(self) -> list[int]:
        """
        Return the intervals between the steps so far.
        """
        made = [edge.deadline_cycle for edge in self.edges if edge.kind is EdgeKind.STEP]
        return [second - first for first, second in pairwise(made)]


CRUISES = st.integers(FASTEST_256, SLOWEST_256)
MOVES = st.integers(-400, 400)


@given(ladders(), CRUISES, MOVES)
def test_a_move_lands_exactly(ladder: Ladder, cruise_256: int, count: int) -> None:
    """
    As many steps as were asked for, none faster than the cruise.
    """
    sketch = Sketch(ladder, cruise_256)
    sketch.do(Move(1_000, count))
    sketch.run_out()

    assert sketch.model.position == count
    steps = sum(edge.kind is EdgeKind.STEP for edge in sketch.edges)
    assert steps == abs(count)
    # The fraction of a clock can be carried into any interval.
    slowest_allowed = min(cruise_256, ladder.first_interval_256) // FRACTIONS
    assert all(gap >= slowest_allowed for gap in sketch.gaps)


@given(ladders(), CRUISES, MOVES)
def test_a_move_is_the_same_backwards(ladder: Ladder, cruise_256: int, count: int) -> None:
    """
    At the same moments, step by step.
    """
    there, back = Sketch(ladder, cruise_256), Sketch(ladder, cruise_256)
    there.do(Move(1_000, count))
    back.do(Move(1_000, -count))
    there.run_out()
    back.run_out()

    assert there.gaps == back.gaps


@given(ladders(), CRUISES, st.integers(1, 400))
def test_up_and_down_mirror_each_other(ladder: Ladder, cruise_256: int, count: int) -> None:
    """
    The exact intervals of a move, the first included, are the same read from the end.
    """
    sketch = Sketch(ladder, cruise_256)
    sketch.do(Move(1_000, count))
    sketch.run_out()

    # The model's deadlines are exact sums cut off to whole clocks: those of the mirrored intervals
    # differ by less than a clock at each step, as the cut does.
    first = sketch.model.starts[0].interval_cycles
    ends = list(accumulate([first, *sketch.gaps]))
    total = ends[-1]
    mirrored = [total - end for end in reversed(ends[:-1])]
    assert all(abs(a - b) <= 1 for a, b in zip(ends, mirrored, strict=False))


@given(
    ladders(),
    CRUISES,
    st.lists(
        st.tuples(st.integers(0, 2_000_000), MOVES, st.none() | CRUISES), min_size=1, max_size=6
    ),
)
def test_whatever_is_changed_in_flight_the_last_target_is_reached(
    ladder: Ladder, cruise_256: int, changes: list[tuple[int, int, int | None]]
) -> None:
    """
    Targets and paces at any moment: it comes to rest at the last target.
    """
    sketch = Sketch(ladder, cruise_256)
    for wait, target, pace in changes:
        sketch.cycle += wait
        if pace is not None:
            sketch.do(SetPace(sketch.cycle, pace))
        sketch.do(MoveTo(sketch.cycle, target))
    sketch.run_out()

    assert sketch.model.position == changes[-1][1]
    assert sketch.model.distance == 0


@given(ladders(), CRUISES, st.integers(0, 3_000_000))
def test_a_stop_ends_where_it_said(ladder: Ladder, cruise_256: int, wait: int) -> None:
    """
    The target that is read after a stop is the position at rest.
    """
    sketch = Sketch(ladder, cruise_256)
    sketch.do(MoveTo(1_000, 100_000))
    sketch.do(Stop(1_000 + wait))
    target = sketch.model.target
    sketch.cycle = 1_000 + wait
    sketch.run_out()

    assert sketch.model.position == target
