"""
A driver with STEP and DIR inputs, and perhaps ENABLE: one pulse on STEP is one microstep.
"""

from collections import Counter
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from stepgen.spec.base import KindModel, SpecModel
from stepgen.spec.pins import PinName

LONGEST_PULSE_US = 40
_LONGEST_ENABLE_US = 1_000_000

_Pulse = Annotated[float, Field(ge=0, le=LONGEST_PULSE_US)]


class Enable(SpecModel):
    """
    The pin that switches the driver, and the level at which it drives the motor.
    """

    pin: PinName
    active: Literal["low", "high"] | None = None


class Times(SpecModel):
    """
    A driver's least times in microseconds, in place of those that stepgen knows.
    """

    step_high_us: _Pulse | None = None
    step_low_us: _Pulse | None = None
    dir_setup_us: _Pulse | None = None
    dir_hold_us: _Pulse | None = None
    enable_us: Annotated[float, Field(ge=0, le=_LONGEST_ENABLE_US)] | None = None


def _as_enable(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"pin": value} if isinstance(value, int | str) else value


class StepDir(KindModel):
    """
    Drive ``step-dir``: pins of one's own, or a socket such as ``ramps-1.4 Z``.
    """

    kind: Literal["step-dir"] = "step-dir"
    driver: str | None = None
    socket: str | None = None
    step: PinName | None = None
    dir: PinName | None = None
    enable: Annotated[Enable | None, BeforeValidator(_as_enable)] = None
    microsteps: Annotated[int, Field(ge=1, le=256)] = 1
    times: Times = Times()

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
