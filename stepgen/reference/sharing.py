"""
Enables that two stacked shields share: the pins are HIGH while either motor needs its current.

Source: systems' electrical facts: the enables of a second shield are those of the lower one,
D3 and D11, unless they are cut and wired elsewhere.
"""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Need:
    """
    From this cycle on a motor needs current, or needs it no longer.

    It needs it from a start or a hold to the release, the stop or the Init that ends it, whether
    it runs or stands.

    Args:
        cycle: The service of the interrupt that makes it so, or the commit of the call.
        on: Whether it is needed from then on.
    """

    cycle: int
    on: bool


def shared_changes(motors: Iterable[Iterable[Need]]) -> list[Need]:
    """
    Return when pins that all *motors* share change: HIGH as soon as one needs them, LOW with none.

    Args:
        motors: The needs of each motor, in the order of their cycles; all begin without.
    """
    rows = [(need.cycle, index, need.on) for index, needs in enumerate(motors) for need in needs]
    needing: set[int] = set()
    changes = []
    for cycle, index, on in sorted(rows, key=lambda row: row[0]):
        before = bool(needing)
        (needing.add if on else needing.discard)(index)
        if bool(needing) != before:
            changes.append(Need(cycle, on))
    return changes
