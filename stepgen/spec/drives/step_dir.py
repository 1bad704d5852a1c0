"""
A driver with STEP and DIR inputs, and perhaps ENABLE: one pulse on STEP is one microstep.
"""

from collections import Counter
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from stepgen.spec.base import KindModel, SpecModel, short_form
from stepgen.spec.pins import PinName

LONGEST_PULSE_US = 40
_LONGEST_ENABLE_US = 1_000_000

_Pulse = Annotated[float, Field(ge=0, le=LONGEST_PULSE_US)]


class Enable(SpecModel):
    """
    The pin that switches the driver, and the level at which it drives the motor.
    """

    pin: PinName
    """The pin."""
    active: Literal["low", "high"] | None = None
    """The level at which the driver drives the motor; what the driver needs, if not given."""


class Times(SpecModel):
    """
    A driver's least times in microseconds, in place of those that stepgen knows.
    """

    step_high_us: _Pulse | None = None
    """How long STEP must be HIGH."""
    step_low_us: _Pulse | None = None
    """How long STEP must be LOW."""
    dir_setup_us: _Pulse | None = None
    """How long DIR must stand before STEP rises."""
    dir_hold_us: _Pulse | None = None
    """How long DIR must stand after STEP has risen."""
    enable_us: Annotated[float, Field(ge=0, le=_LONGEST_ENABLE_US)] | None = None
    """How long after ENABLE the first step may come."""


def _as_enable(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"pin": value} if isinstance(value, int | str) else value


class StepDir(KindModel):
    """
    Drive ``step-dir``: pins of one's own, or a socket such as ``ramps-1.4 Z``.
    """

    asked = ("driver", "socket", "step", "dir", "enable", "microsteps")
    kind: Literal["step-dir"] = "step-dir"
    driver: str | None = None
    """The driver, such as a4988, from which its times follow."""
    socket: str | None = None
    """A socket of a shield, such as `ramps-1.4 Z` or `cnc-shield X`, instead of pins."""
    step: PinName | None = None
    """The pin of STEP."""
    dir: PinName | None = None
    """The pin of DIR."""
    enable: Annotated[Enable | None, short_form(_as_enable, Enable | str | int | None)] = None
    """The pin of ENABLE, if it is connected; a mapping with pin and active, too."""
    microsteps: Annotated[int, Field(ge=1, le=256)] = 1
    """Steps of the driver in one full step of the motor, as its jumpers say."""
    times: Times = Times()
    """The driver's least times, in place of those that stepgen knows."""

    @model_validator(mode="after")
    def _pins_are_given_once(self) -> Self:
        own = [name for name in ("step", "dir", "enable") if getattr(self, name) is not None]
        if self.socket is not None and own:
            raise ValueError(
                f"{own[0]} is given beside socket, which has it already; remove one of them"
            )
        if self.socket is None and not (self.step and self.dir):
            raise ValueError(
                "needs pins: write `step: D2` and `dir: D5`, or `socket: cnc-shield X`"
            )
        pins = [pin for pin in (self.step, self.dir, self.enable and self.enable.pin) if pin]
        repeated = sorted(pin for pin, n in Counter(pins).items() if n > 1)
        if repeated:
            raise ValueError(
                f"pin {repeated[0]} is given twice; give STEP, DIR and ENABLE a pin of its own each"
            )
        return self

    @model_validator(mode="after")
    def _times_are_known(self) -> Self:
        needed = ("step_high_us", "step_low_us", "dir_setup_us", "dir_hold_us")
        missing = [name for name in needed if getattr(self.times, name) is None]
        if self.driver is None and missing:
            raise ValueError(
                f"names no driver, so {missing[0]} is missing; write `driver: a4988`, or all of "
                f"`times: {{{', '.join(f'{name}: ...' for name in needed)}}}`"
            )
        return self


SPEC = StepDir
