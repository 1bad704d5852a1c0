"""
Verification can fail: each planted bug of the templates is caught.
"""

import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from stepgen.library.render import template_dir
from stepgen.spec import load_spec
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.verification import verify_spec

SPECS = Path(__file__).parents[2] / "specs"


@dataclass(frozen=True)
class Mutant:
    """
    A bug: one text of one template replaced by another, and the spec that shows it.
    """

    name: str
    template: str
    old: str
    new: str
    spec: str = "uno_motor_shield"


MUTANTS = (
    Mutant(
        "TOP for TOP - 1",
        "timings/fast_pwm.j2",
        "static_cast<uint16_t>(period - 1)",
        "static_cast<uint16_t>(period)",
    ),
    Mutant(
        "a limit that is off by one",
        "motions/constant.j2",
        "const uint32_t rest = limit - 1;",
        "const uint32_t rest = limit;",
    ),
    Mutant(
        "the bytes of OCR swapped",
        "timings/fast_pwm.j2",
        "{{ timer.ocra }} = next.top;",
        "{{ timer.ocra }} = __builtin_bswap16(next.top);",
    ),
    Mutant(
        "a position that is read without cli",
        "macros/motion.j2",
        "  const Masked masked;\n  return static_cast<int32_t>(",
        "  return static_cast<int32_t>(",
    ),
    Mutant(
        "a speed that is set without cli",
        "motions/constant.j2",
        "  const Masked masked;\n  const uint8_t before",
        "  const uint8_t before",
    ),
    Mutant(
        "the pattern table reversed",
        "kernels/ring.j2",
        "for row in motor.kernel.rows",
        "for row in motor.kernel.rows | reverse",
        spec="uno_uln2003_wave",
    ),
    Mutant(
        "a direction that does not turn round",
        "kernels/toggle.j2",
        "{{ motor.state }} ^= {{ motor.kernel.both }};",
        "{{ motor.state }} ^= 0;",
    ),
    Mutant(
        "an overflow that still waits after a stop",
        "timings/fast_pwm.j2",
        "{{ timer.tifr }} = _BV({{ timer.tov }});",
        "",
    ),
    Mutant(
        "a late TOP: the period in progress is not looked at",
        "timings/fast_pwm.j2",
        "if (({{ timer.tccrb }} & 7) != next.select) return;",
        "",
    ),
    Mutant(
        "a timer that starts from zero after the step interrupt has set it",
        "timings/fast_pwm.j2",
        "{{ timer.tcnt }} = elapsed;",
        "{{ timer.tcnt }} = elapsed & 0;",
    ),
    Mutant(
        "coils that go off with the last step",
        "motions/constant.j2",
        "{{ motor.name }}Reached((mode & kReverse) | kThink | kCoast);",
        "{{ motor.name }}CoilsOff(); {{ motor.name }}Reached((mode & kReverse) | kThink | kCoast);",
        spec="uno_uln2003_28byj48",
    ),
    Mutant(
        "an update event that is one too many",
        "motions/update_events.j2",
        "if (--motion.updates == 0)",
        "if (motion.updates-- == 0)",
        spec="uno_variable_speed",
    ),
    Mutant(
        "a new TOP that loses a step count when the prescaler changes",
        "timings/fast_pwm.j2",
        "motion.rest += ahead;",
        "motion.rest += ahead - 1;",
        spec="uno_variable_speed",
    ),
    Mutant(
        "a clock that is looked at too late",
        "motions/update_events.j2",
        "motion.wake = millisNow() + wait;",
        "motion.wake = millisNow() + wait + 1;",
        spec="uno_variable_speed",
    ),
    Mutant(
        "a release that does not look at who else needs the shared enables",
        "src/library.cpp.j2",
        "if (enablesNeeded) return;",
        "",
        spec="mega_stacked_shields",
    ),
    Mutant(
        "an init that takes the shared enables from a motor that holds",
        "src/library.cpp.j2",
        "  {{ motor.name }}CoilsOff();\n%% endif\n{{ port.clear",
        "  enablesNeeded = 0; {{ motor.name }}CoilsOff();\n%% endif\n{{ port.clear",
        spec="mega_stacked_shields",
    ),
    Mutant(
        "an init that leaves a motor without current in the phase where it was",
        "src/library.cpp.j2",
        "{{ port.clear(motor.low_at_start) | block(2) }}",
        "",
        spec="mega_stacked_shields",
    ),
    Mutant(
        "a limit that waits for its very millisecond, which the clock may pass over",
        "motions/update_events.j2",
        "if (gone >= motion.limit) return 0;",
        "if (gone == motion.limit) return 0;",
        spec="pro-mini-8mhz_28byj48",
    ),
    Mutant(
        "a millisecond limit that is one step late",
        "motions/constant.j2",
        "Motion.endMillis) >= 0",
        "Motion.endMillis) > 0",
    ),
    Mutant(
        "a first interval that is a tick too long",
        "timings/compare.j2",
        "motion.next.first - 1;",
        "motion.next.first;",
        spec="uno_servo_beside",
    ),
    Mutant(
        "a lap too many where their number is a multiple of 256",
        "timings/compare.j2",
        "((laps - 1) >> 8)",
        "(laps >> 8)",
        spec="uno_servo_beside",
    ),
    Mutant(
        "an interval without its odd tick",
        "timings/compare.j2",
        "(rest - first)",
        "(first)",
        spec="uno_servo_beside",
    ),
    Mutant(
        "a change of speed that acts in the middle of an interval",
        "timings/compare.j2",
        "{{ motor.name }}RunTimer();\n}\n",
        "{{ motor.name }}RunTimer();\n} else {\n  motion.now.last = motion.next.last;\n}\n",
        spec="uno_servo_beside",
    ),
    Mutant(
        "a compare match that still waits after a stop",
        "timings/compare.j2",
        "{{ timer.tifr }} = _BV({{ timer.ocf }});",
        "",
        spec="uno_servo_beside",
    ),
)


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_planted_bug_is_caught(mutant: Mutant, tmp_path: Path) -> None:
    """
    The library with the bug compiles, and verification says that it is wrong.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / mutant.template
    text = file.read_text(encoding="utf-8")
    assert mutant.old in text
    file.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    loaded = load_spec(SPECS / f"{mutant.spec}.yaml")

    report = verify_spec(loaded, default_compiler(), templates=templates)

    failed = [check.name for check in report.checks if not check.passed]
    assert failed, f"{mutant.name} was not noticed"
