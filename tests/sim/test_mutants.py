"""
Verification can fail: each planted bug of the templates is caught, by the check that is for it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from stepgen.devices import Mcu
from stepgen.plan import ladder_isr
from stepgen.plan.instructions import Gate, Instruction, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import TimerPlan
from stepgen.plan.planner import make_plan
from stepgen.plan.timings import compare, ladder_compare, wide_compare
from stepgen.spec import load_spec
from stepgen.verify.axis_scenarios import axis_scenarios
from stepgen.verify.firmware import build_firmware
from stepgen.verify.late_scenarios import late_scenarios
from stepgen.verify.passed_scenarios import passed_scenarios
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenarios import Scenario, standard_scenarios
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.verification import scenarios_of, verify_spec
from tests.sim.hazard_trials import batches, sample
from tests.sim.mutant import Mutant
from tests.sim.shrinking import Library

# Not `stepgen verify`, but commands at random clocks near an interrupt: test_hazards.py.
HAZARDS = "hazards"
HAZARD_SEED = 20_260_601
SPECS = Path(__file__).parents[2] / "specs"


MUTANTS = (
    Mutant(
        "TOP for TOP - 1",
        "macros/wide_timer.j2",
        "static_cast<uint16_t>(period - 1)",
        "static_cast<uint16_t>(period)",
        check="a step each 20000 clocks",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a limit that is off by one",
        "motions/constant.j2",
        "const uint32_t rest = limit - 1;",
        "const uint32_t rest = limit;",
        check="single steps both ways",
        finding="that nobody asked for",
    ),
    Mutant(
        "the bytes of OCR swapped",
        "timings/fast_pwm.j2",
        "{{ timer.tcnt }} = elapsed;\n  {{ timer.ocra }} = next.top;",
        "{{ timer.tcnt }} = elapsed;\n  {{ timer.ocra }} = __builtin_bswap16(next.top);",
        check="a step each 20000 clocks",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a position that is read without cli",
        "macros/motion.j2",
        "  const Masked masked;\n  return static_cast<int32_t>(",
        "  return static_cast<int32_t>(",
        check="single steps both ways",
        finding="without masking it",
    ),
    Mutant(
        "a speed that is set without cli",
        "motions/constant.j2",
        "  const Masked masked;\n  const uint8_t before",
        "  const uint8_t before",
        check="stop while running",
        finding="without masking it",
    ),
    Mutant(
        "the pattern table reversed",
        "kernels/ring.j2",
        "for row in motor.kernel.rows",
        "for row in motor.kernel.rows | reverse",
        spec="uno_uln2003_wave",
        check="single steps both ways",
        finding="pattern 0100 at cycle",
    ),
    Mutant(
        "a direction that does not turn round",
        "kernels/toggle.j2",
        "{{ motor.state }} ^= {{ motor.kernel.both }};",
        "{{ motor.state }} ^= 0;",
        check="single steps both ways",
        finding="pattern 1101 at cycle",
    ),
    Mutant(
        "an overflow that still waits after a stop",
        "macros/wide_timer.j2",
        "{{ timer.tifr }} = _BV({{ timer.tov }});",
        "",
        check="stop at every point of a period",
        finding="that nobody asked for",
    ),
    Mutant(
        "a late TOP: the period in progress is not looked at",
        "timings/fast_pwm.j2",
        "if (({{ timer.tccrb }} & 7) != next.select) return;",
        "",
        check="change at every point of a period",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a timer that starts from zero after the step interrupt has set it",
        "timings/fast_pwm.j2",
        "{{ timer.tcnt }} = elapsed;",
        "{{ timer.tcnt }} = elapsed & 0;",
        check="change at every point of a period",
        finding="cycles off",
    ),
    Mutant(
        "an update event after which the timer starts from zero",
        "timings/fast_pwm.j2",
        "{{ timer.tcnt }} = elapsed;",
        "{{ timer.tcnt }} = elapsed & 0;",
        check="motor: an event with each step, each with another prescaler",
        finding="cycles off",
        spec="uno_variable_speed",
    ),
    Mutant(
        "a position that is one off while the motor goes backward",
        "macros/motion.j2",
        "static_cast<int32_t>({{ motor.name }}Position());",
        "static_cast<int32_t>({{ motor.name }}Position() + !!({{ motor.name }}Motion.mode & 8));",
        check="stop while running",
        finding="but the wires made",
    ),
    Mutant(
        "a new period that is left to the timer though the old one is over",
        "timings/fast_pwm.j2",
        "if (!({{ timer.tifr }} & _BV({{ timer.tov }}))) next.select = 0;",
        "next.select = 0;",
        check=HAZARDS,
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "coils that go off with the last step",
        "motions/constant.j2",
        "{{ motor.name }}Reached((mode & kReverse) | kThink | kCoast);",
        "{{ motor.name }}CoilsOff(); {{ motor.name }}Reached((mode & kReverse) | kThink | kCoast);",
        spec="uno_uln2003_28byj48",
        check="single steps both ways",
        finding="pattern 0000 at cycle",
    ),
    Mutant(
        "coils that never go off after a move",
        "motions/constant.j2",
        "        {{ motor.name }}Reached((mode & kReverse) | kThink | kCoast);\n"
        "        motion.rest = motion.restHigh = -1;\n"
        "        {{ motor.count }} = 1;\n",
        "        {{ motor.name }}Halt(mode);\n",
        check="single steps both ways",
        finding="no step interrupt for the coils-off due at",
        spec="uno_uln2003_28byj48",
    ),
    Mutant(
        "a stop that lets go of a motor that holds",
        "macros/motion.j2",
        "    if (!(control & MOTOR_CTRL_DRV_EN)) {{ motor.name }}CoilsOff();",
        "    {{ motor.name }}CoilsOff();",
        check="stop while running",
        finding="the model says",
    ),
    Mutant(
        "a change of speed that switches the coils off and on",
        "timings/fast_pwm.j2",
        "if (before & kRunning) {\n  {{ motor.name }}TakeOver();",
        "if (before & kRunning) {\n  {{ motor.name }}CoilsOff();\n  {{ motor.name }}Energise();\n"
        "  {{ motor.name }}TakeOver();",
        check="restart while running",
        finding="and back",
    ),
    Mutant(
        "an update event that is one too many",
        "motions/update_events.j2",
        "if (--motion.updates == 0)",
        "if (motion.updates-- == 0)",
        spec="uno_variable_speed",
        check="motor: events each few steps, by the sketch",
        finding="status 0x00 at cycle",
    ),
    Mutant(
        "a new TOP that loses a step count when the prescaler changes",
        "timings/fast_pwm.j2",
        "motion.rest += ahead;",
        "motion.rest += ahead - 1;",
        spec="uno_variable_speed",
        check="motor: an event with each step, each with another prescaler",
        finding="position 9 at cycle",
    ),
    Mutant(
        "a clock that is looked at too late",
        "motions/update_events.j2",
        "motion.wake = millisNow() + wait;",
        "motion.wake = millisNow() + wait + 1;",
        spec="uno_variable_speed",
        check="motor: a millisecond limit beside events",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a release that does not look at who else needs the shared enables",
        "src/library.cpp.j2",
        "if ({{ motor.need.anybody }}) return;",
        "",
        spec="mega_stacked_shields",
        check="lower lets go, upper runs",
        finding="PB5 must go LOW at cycle",
    ),
    Mutant(
        "an init that takes the shared enables from a motor that holds",
        "src/library.cpp.j2",
        "  {{ motor.name }}CoilsOff();\n%% endif\n{{ port.write",
        "  enablesNeeded = 0; {{ motor.name }}CoilsOff();\n%% endif\n{{ port.write",
        spec="mega_stacked_shields",
        check="lower lets go, upper stands",
        finding="PB5 must go LOW at cycle",
    ),
    Mutant(
        "an init that leaves a motor without current in the phase where it was",
        "src/library.cpp.j2",
        "{{ port.write(motor.at_start) | block(2) }}",
        "",
        spec="mega_stacked_shields",
        check="lower lets go, upper stands",
        finding="coils-off: 1101 after the call",
    ),
    Mutant(
        "a limit that waits for its very millisecond, which the clock may pass over",
        "motions/update_events.j2",
        "if (gone >= motion.limit) return 0;",
        "if (gone == motion.limit) return 0;",
        spec="pro-mini-8mhz_28byj48",
        check="every short millisecond end point",
        finding="status 0x40 at cycle",
    ),
    Mutant(
        "a millisecond limit that is one step late",
        "motions/constant.j2",
        "Motion.endMillis) >= 0",
        "Motion.endMillis) > 0",
        check="millisecond end points",
        finding="motor: position ",
    ),
    Mutant(
        "a first interval that is a tick too long",
        "timings/compare.j2",
        "motion.next.first - 1;",
        "motion.next.first;",
        spec="uno_servo_beside",
        check="single steps both ways",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a lap too many where their number is a multiple of 256",
        "timings/compare.j2",
        "((laps - 1) >> 8)",
        "(laps >> 8)",
        spec="uno_servo_beside",
        check="restart while running",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "an interval without its odd tick",
        "timings/compare.j2",
        "(rest - first)",
        "(first)",
        spec="uno_servo_beside",
        check="a step each 600011 clocks",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a change of speed that acts in the middle of an interval",
        "timings/compare.j2",
        'RunTimer();") | block(2) }}\n}\n',
        'RunTimer();") | block(2) }}\n} else {\n  motion.now.last = motion.next.last;\n}\n',
        spec="uno_servo_beside",
        check="change at every point of a period",
        finding="no step interrupt for the step due at",
    ),
    Mutant(
        "a new TOP that CTC gets in mid-interval",
        "timings/ctc.j2",
        "{{ motor.timer.timsk }} = _BV({{ motor.timer.toie }});\n}",
        "{{ motor.timer.timsk }} = _BV({{ motor.timer.toie }});\n"
        "} else {\n  {{ motor.timer.ocra }} = setting.top;\n}",
        check="change at every point of a period",
        finding="no step interrupt for the step due at",
        spec="mega_ramps_z",
    ),
    Mutant(
        "a prescaler that CTC keeps",
        "timings/ctc.j2",
        "if (({{ timer.tccrb }} & 7) != next.select) {",
        "if (next.select == 0) {",
        check="change at every point of a period",
        finding="no step interrupt for the step due at",
        spec="mega_ramps_z",
    ),
    Mutant(
        "a compare match of CTC that still waits after a stop",
        "macros/wide_timer.j2",
        "{{ timer.tifr }} = _BV({{ timer.tov }});",
        "",
        check="stop at every point of a period",
        finding="that nobody asked for",
        spec="mega_ramps_z",
    ),
    Mutant(
        "a pulse of the interrupt's rare way that is too short",
        "kernels/pulse.j2",
        "{{ motor.kernel.high_wait }}",
        "",
        check="millisecond end points",
        finding="is 2 cycles long, not 31",
        spec="uno_drv8825",
    ),
    Mutant(
        "a direction that is not written before the step",
        "kernels/pulse.j2",
        "{{ motor.name }}Point(mode);",
        "",
        check="single steps both ways",
        finding="the model says 010",
        spec="mega_ramps_z",
    ),
    Mutant(
        "two pulses for a step",
        "kernels/pulse.j2",
        "{{ motor.kernel.fall }}\n",
        "{{ motor.kernel.fall }}\n{{ motor.kernel.rise }}\n{{ motor.kernel.fall }}\n",
        check="millisecond end points",
        finding="2 pulses on STEP",
        spec="uno_drv8825",
    ),
    Mutant(
        "a driver that is enabled while its neighbour is, but not by itself",
        "macros/port.j2",
        "{{ write(motor.switch_on) }}",
        "",
        check="x lets go, y stands",
        finding="the model says 000",
        spec="uno_cnc_shield",
    ),
    Mutant(
        "a compare match that still waits after a stop",
        "timings/compare.j2",
        "{{ timer.tifr }} = _BV({{ timer.ocf }});",
        "",
        spec="uno_servo_beside",
        check="stop at every point of a period",
        finding="pattern 1100 at cycle",
    ),
    Mutant(
        "a command time-out that a refused call puts off",
        "motions/constant.j2",
        "  if (error) {\n    const Masked masked;\n",
        "  if (error) {\n    const Masked masked;\n    {{ motor.name }}HeardOf();\n",
        check="belt: calls that are no sign of life",
        finding="position",
        spec="uno_command_timeout",
    ),
    Mutant(
        "a command time-out that begins with the first one only",
        "timeouts/command.j2",
        "  const Masked masked;\n  {{ motor.name }}HeardOf();\n",
        "  const Masked masked;\n",
        check="belt: kept alive, then no more",
        finding="no step interrupt for the step due at",
        spec="uno_command_timeout",
    ),
    Mutant(
        "a command time-out that leaves the coils on",
        "timeouts/command.j2",
        "  {{ motor.name }}CoilsOff();\n",
        "",
        check="right: left alone",
        finding="pattern 000 at cycle",
        spec="mega_command_timeouts",
    ),
    Mutant(
        "a command time-out that the interrupt looks for too late",
        "timeouts/command.j2",
        "if (patience < wait) wait = patience;",
        "if (patience < wait) wait = patience + 3;",
        check="left: left alone at any point of a millisecond",
        finding="position",
        spec="mega_command_timeouts",
    ),
    Mutant(
        "a command time-out that is read without cli",
        "timeouts/command.j2",
        "  const Masked masked;  // or a loop that waits for it would look only once\n",
        "",
        check="belt: left alone",
        finding="without masking it",
        spec="uno_command_timeout",
    ),
    Mutant(
        "a command time-out that nobody can read of",
        "timeouts/command.j2",
        "  {{ motor.name }}LeftAlone = 1;\n",
        "",
        check="left: left alone",
        finding="timed out 0 at cycle",
        spec="mega_command_timeouts",
    ),
    Mutant(
        "a count of missed steps that an init leaves",
        "timings/compare.j2",
        "motion.missed = 0;",
        "",
        check="motor: interrupts held up very often",
        finding="missed at cycle",
        spec="uno_servo_beside",
    ),
    Mutant(
        "a count of missed steps that is read without cli",
        "timings/compare.j2",
        "  const Masked masked;\n  return {{ motor.name }}Motion.missed;",
        "  return {{ motor.name }}Motion.missed;",
        check="single steps both ways",
        finding="without masking it",
        spec="uno_servo_beside",
    ),
    Mutant(
        "a lap too many (16 bits)",
        "macros/channel.j2",
        "(high << 2 | ticks >> 14) - 1",
        "high << 2 | ticks >> 14",
        check="a step each 100003 clocks",
        finding="that nobody asked for",
        spec="uno_compare_two",
    ),
    Mutant(
        "a lap too few, where the interval is divided (16 bits)",
        "macros/channel.j2",
        "if (period >= 2UL * kLapTicks) {",
        "if (period > 2UL * kLapTicks + 256) {",
        check="left: interrupts held up for periods and laps",
        finding="the model says",
        spec="uno_compare_two",
    ),
    Mutant(
        "laps that are counted in 16 bits, of 67 s at most",
        "timings/long_compare.j2",
        "__uint24 lapsLeft;",
        "uint16_t lapsLeft;",
        check="motor: more laps than 16 bits count",
        finding="that nobody asked for",
        spec="uno_slow",
    ),
    Mutant(
        "a time limit that is looked at with steps only",
        "timings/long_compare.j2",
        "      {{ motor.name }}CountLap(motion.mode);\n",
        "",
        check="motor: a millisecond end point long before the next step",
        finding="the model says",
        spec="uno_slow",
    ),
    Mutant(
        "a time limit whose comparison comes round before the next step",
        "timings/long_compare.j2",
        "      motion.endMillis = millisCount();",
        "      motion.endMillis += 0;",
        check="motor: a millisecond end point long before the next step",
        finding="the model says",
        spec="uno_slow",
    ),
    Mutant(
        "a compare register that is one tick off (16 bits)",
        "timings/wide_compare.j2",
        "{{ motor.name }}Advance(kLapTicks);",
        "{{ motor.name }}Advance(kLapTicks + 1);",
        check="a step each 600011 clocks",
        finding="no step interrupt for the step due at",
        spec="uno_compare_two",
    ),
    Mutant(
        "a first interval without its start (16 bits)",
        "timings/wide_compare.j2",
        "motion.due = {{ timer.tcnt }};",
        "motion.due = {{ timer.tcnt }} + 300;",
        check="single steps both ways",
        finding="cycles after the call",
        spec="uno_compare_two",
    ),
    Mutant(
        "a match of before a start that makes a step (16 bits)",
        "timings/wide_compare.j2",
        "{{ timer.tifr }} = _BV({{ timer.ocf }});  // a match of before",
        "// a match of before",
        check="single steps both ways",
        finding="that nobody asked for",
        spec="uno_compare_two",
    ),
    Mutant(
        "a stop that stops the other motor of the timer (16 bits)",
        "macros/channel.j2",
        "{{ timer.timsk }} &= ~_BV({{ timer.ocie }});",
        "{{ timer.timsk }} = 0;",
        check="all motors at once",
        finding="no step interrupt for the step due at",
        spec="uno_compare_two",
    ),
    Mutant(
        "a passed compare that the rare way does not notice (16 bits)",
        "timings/wide_compare.j2",
        "if ({{ motor.name }}Passed() && !motion.lapsLeft) {{ motor.name }}Missed();",
        "",
        check="left: interrupts held up for periods and laps",
        finding="the model says",
        spec="uno_compare_two",
    ),
    Mutant(
        "a passed lap that is waited for (16 bits)",
        "timings/wide_compare.j2",
        "  {{ motor.name }}Advance(kLapTicks);\n  {{ motor.name }}Passed();",
        "  {{ motor.name }}Advance(kLapTicks);",
        check="left: interrupts held up for periods and laps",
        finding="no step interrupt for the step due at",
        spec="uno_compare_two",
    ),
    Mutant(
        "a match that is served twice: by its flag, and at once (16 bits)",
        "macros/channel.j2",
        " || ({{ timer.tifr }} & _BV({{ timer.ocf }}))",
        "",
        check="left: interrupts held up for many lengths",
        finding="the model says",
        spec="uno_compare_two",
    ),
    Mutant(
        "a count of missed steps that an init leaves (16 bits)",
        "macros/channel.j2",
        "motion.missed = 0;",
        "",
        check="left: interrupts held up very often",
        finding="missed at cycle",
        spec="uno_compare_two",
    ),
    Mutant(
        "TEMP that an interrupt overwrites while a call uses it (16 bits)",
        "timings/wide_compare.j2",
        "  motion.due = {{ timer.tcnt }};\n  {{ motor.name }}Advance(motion.next.ticks);",
        "  sei();\n  motion.due = {{ timer.tcnt }};\n  {{ motor.name }}Advance(motion.next.ticks);"
        "\n  cli();",
        check="right: starts while the others run",
        finding="no step interrupt for the step due at",
        spec="uno_compare_two",
    ),
    Mutant(
        "a watchdog that nothing feeds",
        "watchdogs/chip.j2",
        "  wdt_reset();\n",
        "",
        check="the watchdog",
        finding="resets at",
        spec="uno_watchdog",
    ),
    Mutant(
        "a watchdog with the next period",
        "watchdogs/chip.j2",
        "wdt_enable({{ watchdog.constant }})",
        "wdt_enable({{ watchdog.constant }} + 1)",
        check="the watchdog",
        finding="resets at []",
        spec="uno_watchdog",
    ),
    Mutant(
        "a watchdog that stays on after its reset",
        "watchdogs/chip.j2",
        "  wdt_disable();\n",
        "",
        check="the watchdog",
        finding="the chip resets again",
        spec="uno_watchdog",
    ),
    Mutant(
        "a watchdog that WDRF keeps on after its reset",
        "watchdogs/chip.j2",
        "  MCUSR = resetCauses & ~_BV(WDRF);\n",
        "",
        check="the watchdog",
        finding="the chip resets again",
        spec="uno_watchdog",
    ),
    Mutant(
        "a watchdog whose reset is forgotten",
        "watchdogs/chip.j2",
        ' __attribute__((section(".noinit")))',
        "",
        check="the watchdog",
        finding="motorWatchdogFired() returns -1",
        spec="uno_watchdog",
    ),
)
# Bugs of the way to the step in timing compare: an instruction, and what stands in its place.
GATE_MUTANTS = {
    "a missed lap that is waited for": ("brsh  9b", "nop"),
    "a missed step that is waited for": ("brsh  8f", "nop"),
    "an overrun that is not counted": ("sts   %[missed], r25", "nop"),
    "an overrun that the status does not tell": ("ori   r25, %[statMissed]", "nop"),
    "a count of overruns without its upper byte": ("sts   %[missed] + 1, r25", "nop"),
    "a match that is served by hand and comes all the same": ("out   %[tifr], r24", "nop"),
    "a last lap that has passed, and the step comes as another": ("ldi   r24, 255", "ldi   r24, 0"),
}


# The same on a 16-bit timer; there each fragment of the interrupt is one.
WIDE_MUTANTS = {
    "a passed step that is waited for": ("brpl  13f", "nop"),
    "a passed step of a boundary that is waited for": ("brpl  16f", "nop"),
    "an interval that is one tick longer": ("add   r24, r25", "sec $ adc r24, r25"),
    "an interval without its carry": ("adc   r24, r25", "add   r24, r25"),
    "the bytes of OCR in the wrong order": ("sts   %[ocrHigh], r24", "nop"),
    "a run that begins without its steps": ("subi  r24, 255", "subi  r24, 254"),
    "a limit that is never looked at": ("brpl  16b", "nop"),
}


# Bugs of an axis; only the check that must catch one is made, for it takes long to make all.
AXIS_MUTANTS = (
    Mutant(
        "a call on the way down after which levels that were not begun count as made",
        "motions/trapezoid.j2",
        "    motion.rung += levels;\n    motion.height += steps;\n",
        "    motion.rung += levels;\n",
        check="slide: turns at every point of a period at full speed",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "levels that follow after a call",
        "motions/trapezoid.j2",
        "  motion.levels = 0;\n  climbs =",
        "  climbs =",
        check="slide: targets that change in flight",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a ramp without room to come down",
        "motions/trapezoid.j2",
        "if (room / 2 < way) way = room / 2;",
        "if (room < way) way = room;",
        check="slide: short moves both ways",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a level that is climbed and makes the way to rest no longer",
        "motions/trapezoid.j2",
        "      motion.height += motion.length;\n      ++motion.rung;",
        "      ++motion.rung;",
        check="slide: short moves both ways",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a direction that is not written",
        "motions/trapezoid.j2",
        "{{ kernel.turn_round(motor) | block(4) }}",
        "",
        check="slide: short moves both ways",
        finding="the model says",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a queue whose last is made first",
        "motions/trapezoid.j2",
        "Queue[{{ motor.name }}First];",
        "Queue[{{ motor.name }}Place({{ motor.name }}Queued - 1)];",
        check="slide: a queue that is full",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a queue that a halt leaves",
        "motions/trapezoid.j2",
        "%% if axis.queue\n  {{ motor.name }}Queued = 0;\n%% endif\n  auto &motion",
        "  auto &motion",
        check="slide: a queue that is full",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a position that is read without cli",
        "motions/trapezoid.j2",
        "  const Masked masked;\n  return {{ motor.name }}Position();",
        "  return {{ motor.name }}Position();",
        check="slide: refused calls",
        finding="without masking it",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a speed that is a little too fast",
        "motions/trapezoid.j2",
        "if (interval < {{ axis.prefix }}CruiseInterval)",
        "if (interval < {{ axis.prefix }}CruiseInterval - 1)",
        check="slide: refused calls",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a speed that is a level too high",
        "motions/trapezoid.j2",
        "if (goal >= motion.height + motion.length) {",
        "if (goal >= motion.height) {",
        check="slide: calls at every point of a period at full speed",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a place that is nearer than the motor can stop, and taken for far enough",
        "motions/trapezoid.j2",
        "  if (ahead >= static_cast<int32_t>(steps)) {\n",
        "  if (ahead > 0) {\n",
        check="slide: targets that change in flight",
        finding="slide: ",
        spec="uno_trapezoid",
    ),
    Mutant(
        "coils that go off with a lap of the last interval left",
        "motions/trapezoid.j2",
        "        ++motion.lapsLeft;\n",
        "        if (!motion.lapsLeft) ++motion.lapsLeft;\n",
        check="slide: short moves both ways",
        finding="coils-off",
        spec="uno_trapezoid",
    ),
    Mutant(
        "a fraction of a clock that is lost where a way begins",
        "timings/ladder_compare.j2",
        "motion.due + ticks + (fraction >> 8);",
        "motion.due + ticks;",
        check="slide: moves that do not come to full speed",
        finding="no step interrupt for the step due at",
        spec="uno_trapezoid",
    ),
)
# The same in the interrupt of an axis, which climbs by itself.
LADDER_MUTANTS = {
    "a fraction of a clock that is lost": (
        "adc   r24, r25",
        "add   r24, r25",
        "slide: a long move at full speed",
    ),
    "a level that lasts as long as the one before": (
        "subi  r24, 1",
        "subi  r24, 2",
        "slide: moves that do not come to full speed",
    ),
    "a level that begins without its steps": (
        "lds   r24, %[length]",
        "ldi   r24, 1",
        "slide: a long move at full speed",
    ),
    "a passed step of an axis that is waited for": (
        "brpl  13f",
        "nop",
        "slide: interrupts held up",
    ),
    "a passed step of an axis that is made at once and not counted": (
        "adiw  r24, 1",
        "adiw  r24, 0",
        "slide: interrupts held up",
    ),
    "a step of an axis that comes meanwhile and counts as passed": (
        "sbic  %[tifr], %[ocf]",
        "sbis  %[tifr], %[ocf]",
        "slide: interrupts held up",
    ),
}


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_planted_bug_is_caught_by_its_check(mutant: Mutant, tmp_path: Path) -> None:
    """
    The library with the bug compiles, and the check that is there for it says what is wrong.
    """
    failed = failures(mutant, mutant.plant(tmp_path))

    assert mutant.check in failed, f"{mutant.name} was not noticed there, but by {list(failed)}"
    assert mutant.finding in failed[mutant.check]


def no_scenario(scenarios: Sequence[Scenario]) -> Iterator[Scenario]:
    """
    Leave out each of *scenarios*.
    """
    return iter(scenarios[:0])


def failures(mutant: Mutant, templates: Path) -> dict[str, str]:
    """
    Return what failed of the scenario that must catch *mutant*; where it is none, of all else.
    """
    if mutant.check == HAZARDS:
        library = Library.of(mutant.spec, templates)
        done = batches(library, 0, HAZARDS, sample(library, 0, HAZARD_SEED, 300))
        found = "; ".join(finding for _, findings, _ in done for finding in findings)
        return {HAZARDS: found} if found else {}
    loaded = load_spec(SPECS / f"{mutant.spec}.yaml")
    plan = make_plan(loaded)
    for scenario, _ in scenarios_of(plan):
        if scenario.name == mutant.check:
            text = loaded.document.text
            bench = build_firmware(plan, text, default_compiler(), templates).bench
            findings = run_scenario(loaded, plan, bench, scenario).findings
            return {scenario.name: "; ".join(findings)} if findings else {}
    report = verify_spec(loaded, default_compiler(), templates=templates, track=no_scenario)

    return {check.name: check.detail for check in report.checks if not check.passed}


@pytest.mark.parametrize("name", GATE_MUTANTS)
def test_a_planted_bug_of_late_steps_is_caught(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    The interrupt does the wrong thing only where it comes too late, and verification sees that.
    """
    old, new = GATE_MUTANTS[name]
    right = compare.gate

    def wrong(timing: TimerPlan, motion: Motion, storage: Storage, mcu: Mcu) -> Gate:
        made = right(timing, motion, storage, mcu)
        lines = [replace(one, text=new) if one.text == old else one for one in made.instructions]
        assert tuple(lines) != made.instructions
        return replace(made, instructions=tuple(lines))

    monkeypatch.setattr(compare, "gate", wrong)
    loaded = load_spec(SPECS / "uno_servo_beside.yaml")
    plan = make_plan(loaded)
    bench = build_firmware(plan, loaded.document.text, default_compiler()).bench

    outcomes = [run_scenario(loaded, plan, bench, one) for one in late_scenarios(plan)]

    assert any(outcome.findings for outcome in outcomes), f"{name} was not noticed"


@pytest.mark.parametrize("name", WIDE_MUTANTS)
def test_a_planted_bug_of_a_compare_channel_is_caught(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    The interrupt sets its channel wrongly, or does not see that it was too late.
    """
    old, new = WIDE_MUTANTS[name]
    right = wide_compare.gate

    def planted(lines: tuple[Instruction, ...]) -> tuple[Instruction, ...]:
        return tuple(replace(one, text=new) if one.text == old else one for one in lines)

    def wrong(timing: TimerPlan, motion: Motion, storage: Storage, mcu: Mcu) -> Gate:
        made = right(timing, motion, storage, mcu)
        bad = replace(
            made,
            advance=planted(made.advance),
            check=planted(made.check),
            go_on=planted(made.go_on),
            look=planted(made.look),
        )
        assert bad != made
        return bad

    monkeypatch.setattr(wide_compare, "gate", wrong)
    loaded = load_spec(SPECS / "uno_compare_two.yaml")
    plan = make_plan(loaded)
    bench = build_firmware(plan, loaded.document.text, default_compiler()).bench
    scenarios = (*passed_scenarios(plan), *standard_scenarios(plan))

    outcomes = (run_scenario(loaded, plan, bench, one) for one in scenarios)

    assert any(outcome.findings for outcome in outcomes), f"{name} was not noticed"


@pytest.mark.parametrize("mutant", AXIS_MUTANTS, ids=lambda mutant: mutant.name)
def test_a_planted_bug_of_an_axis_is_caught_by_its_scenario(mutant: Mutant, tmp_path: Path) -> None:
    """
    The library of an axis with the bug compiles, and the scenario for it says what is wrong.
    """
    loaded = load_spec(SPECS / f"{mutant.spec}.yaml")
    plan = make_plan(loaded)
    templates = mutant.plant(tmp_path)
    bench = build_firmware(plan, loaded.document.text, default_compiler(), templates).bench
    (scenario,) = (one for one in axis_scenarios(plan) if one.name == mutant.check)

    findings = run_scenario(loaded, plan, bench, scenario).findings

    assert mutant.finding in "; ".join(findings), f"{mutant.name}: {findings}"


@pytest.mark.parametrize("name", LADDER_MUTANTS)
def test_a_planted_bug_of_the_interrupt_of_an_axis_is_caught(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    The interrupt of an axis does the wrong thing by itself, and the scenario for it sees that.
    """
    old, new, check = LADDER_MUTANTS[name]
    right = ladder_compare.gate
    at_once = ladder_isr.at_once()

    def planted(lines: tuple[Instruction, ...]) -> tuple[Instruction, ...]:
        return tuple(replace(one, text=new) if one.text == old else one for one in lines)

    def wrong(timing: TimerPlan, motion: Motion, storage: Storage, mcu: Mcu) -> Gate:
        made = right(timing, motion, storage, mcu)
        bad = replace(
            made,
            advance=planted(made.advance),
            check=planted(made.check),
            go_on=planted(made.go_on),
        )
        assert bad != made or planted(at_once) != at_once
        return bad

    monkeypatch.setattr(ladder_compare, "gate", wrong)
    monkeypatch.setattr(ladder_isr, "at_once", lambda: planted(at_once))
    loaded = load_spec(SPECS / "uno_trapezoid.yaml")
    plan = make_plan(loaded)
    bench = build_firmware(plan, loaded.document.text, default_compiler()).bench
    (scenario,) = (one for one in axis_scenarios(plan) if one.name == check)

    assert run_scenario(loaded, plan, bench, scenario).findings, f"{name} was not noticed"
