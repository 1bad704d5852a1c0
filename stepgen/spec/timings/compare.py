"""
Compare: a timer runs through, and a compare channel makes the steps of one motor.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from stepgen.spec.base import KindModel


class Compare(KindModel):
    """
    Timing ``compare``: a channel of a 16-bit timer, which other motors share, or all of timer 2.
    """

    kind: Literal["compare"] = "compare"
    timer: int | None = None
    """The number of a timer: 2, which has 8 bits, or a 16-bit one. Without it, the first free."""
    channel: Literal["A", "B", "C"] | None = None
    """Its compare channel; without it the first one that no other motor has."""
    longest_period_s: Annotated[int, Field(ge=5, le=3600)] | None = None
    """How many seconds two steps can be apart, on a 16-bit timer; without it 4.19 at 16 MHz."""

    @model_validator(mode="after")
    def _a_channel_is_one_of_a_timer(self) -> Self:
        if self.channel and self.timer is None:
            raise ValueError("a channel belongs to a timer; name it with `timer`")
        return self


SPEC = Compare
