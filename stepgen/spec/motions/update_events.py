"""
Update events: the speed changes by itself, every so many milliseconds or steps (system 1).
"""

from typing import Literal

from stepgen.spec.base import KindModel


class UpdateEvents(KindModel):
    """
    Motion ``update-events``: what ``constant`` does, and speeds that change while running.

    With *debug* the library has a function that prints the state of the motion.
    """

    kind: Literal["update-events"] = "update-events"
    debug: bool = False
    """Whether the library gets a function that prints the state of the motion."""


SPEC = UpdateEvents
