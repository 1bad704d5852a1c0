"""
Driver chips with STEP and DIR inputs: what their datasheets ask of the pulses.

A figure that could not be confirmed is a conservative one, and its comment says so.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

_TO_16 = (1, 2, 4, 8, 16)
_TO_32 = (*_TO_16, 32)
_TO_256 = (*_TO_32, 64, 128, 256)


@dataclass(frozen=True)
class PulseTimes:
    """
    The least times of a driver's inputs, in nanoseconds.

    Args:
        step_high_ns: How long STEP is HIGH; step_low_ns: how long it is LOW between two steps.
        dir_setup_ns: From a change of DIR to the rising edge of STEP.
        dir_hold_ns: From the rising edge of STEP to a change of DIR.
        enable_ns: From ENABLE to the first rising edge of STEP.
    """

    step_high_ns: int
    step_low_ns: int
    dir_setup_ns: int
    dir_hold_ns: int
    enable_ns: int


@dataclass(frozen=True)
class StepDriver:
    """
    A driver chip, or a module of one; all of them drive the motor while ENABLE is LOW.

    Args:
        title: What people call it.
        times: What it asks of its inputs.
        microsteps: Into how many microsteps it can divide a full step.
    """

    title: str
    times: PulseTimes
    microsteps: tuple[int, ...]


DRIVERS: Mapping[str, StepDriver] = MappingProxyType(
    {
        # Allegro A4988 datasheet, Figure 1, "Logic Interface Timing": tA 1 us, tB 1 us, tC 200 ns,
        # tD 200 ns. Its 1 ms of wake-up is that of SLEEP, which is tied HIGH on carriers and which
        # this drive does not switch. ENABLE has no time of its own; that of DIR is taken.
        "a4988": StepDriver("A4988", PulseTimes(1_000, 1_000, 200, 200, 200), _TO_16),
        # TI DRV8825 datasheet (SLVSA73), "Timing Requirements": tWH and tWL 1.9 us, tSU and tH 650
        # ns, tENBL 650 ns. (tWAKE, 1.7 ms, is that of nSLEEP.)
        "drv8825": StepDriver("DRV8825", PulseTimes(1_900, 1_900, 650, 650, 650), _TO_32),
        # Trinamic TMC2208 and TMC2209 datasheets, "STEP/DIR Interface", "Timing": tSH and tSL at
        # least tFILTSD (100 ns) or tCLK + 20 ns, 103 ns at the internal 12 MHz; tDSU and tDSH
        # 20 ns. The clock varies, so 120 ns are taken. ENN has no time of its own: 120 ns too.
        "tmc2208": StepDriver("TMC2208", PulseTimes(120, 120, 20, 20, 120), _TO_256),
        "tmc2209": StepDriver("TMC2209", PulseTimes(120, 120, 20, 20, 120), _TO_256),
        # ON Semiconductor LV8729: tSTEPH, tSTEPL, tDS and tDH 500 ns, as RepRapFirmware's table of
        # driver timings has them; its enable is taken likewise.
        "lv8729": StepDriver("LV8729", PulseTimes(500, 500, 500, 500, 500), _TO_256[:-1]),
        # Modules called TB6600 hold several chips behind optocouplers, and their leaflets differ or
        # say nothing. Conservative, not confirmed: 5 us each. ENA+ LOW or open drives the motor.
        "tb6600": StepDriver(
            "TB6600 module", PulseTimes(5_000, 5_000, 5_000, 5_000, 5_000), _TO_32
        ),
        # Leadshine and StepperOnline DM542T manual, "Sequence Chart of Control Signals": pulse and
        # pause 2.5 us, DIR 5 us ahead of PUL, ENA 200 ms ahead of DIR. It gives no time to hold
        # DIR; 5 us are a conservative figure. The chart has not been at hand to confirm it.
        "dm542t": StepDriver(
            "DM542T",
            PulseTimes(2_500, 2_500, 5_000, 5_000, 200_000_000),
            (1, 2, 4, 5, 8, 10, 16, 20, 25, 32, 40, 50, 64, 100, 125, 128),
        ),
    }
)
"""The drivers by the name that a spec gives them."""

UNFIT_DRIVERS: Mapping[str, str] = MappingProxyType(
    {
        # ST L6470 datasheet, "Step-clock mode" and "StepClock (DIR)": STCK makes the microsteps,
        # and the direction is the parameter of that command.
        "l6470": (
            "the L6470 has no DIR: in its step-clock mode the direction is a command over SPI, "
            "which a library of stepgen does not send"
        )
    }
)
"""Why a driver that people may ask for cannot be one of them, by its name."""
