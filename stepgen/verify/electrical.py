"""
What coils may see for the few cycles between two writes of one step.
"""

from collections.abc import Sequence

from stepgen.verify.subject import Subject

Levels = Sequence[bool]


def is_between(subject: Subject, old: Levels, new: Levels, seen: Levels) -> bool:
    """
    Tell whether *seen* only switches off, from *old* to *new*: no coil is driven as in neither.

    Four wires: what is driven is driven in *old*, or all of it in *new*. Motor shield: each
    coil is off, or has the current that it has in *old* or in *new*.
    """
    if subject.is_shield:
        return all(
            _coil(seen, coil) in (None, _coil(old, coil), _coil(new, coil)) for coil in (0, 1)
        )
    return any(
        all(not now or allowed for now, allowed in zip(seen, pattern, strict=True))
        for pattern in (old, new)
    )


def _coil(levels: Levels, coil: int) -> bool | None:
    """
    Return the direction of the current of *coil*, None without current.

    The shield's wires are PWM A, PWM B, DIR A, DIR B.
    """
    return levels[2 + coil] if levels[coil] else None
