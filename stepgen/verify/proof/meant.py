"""
The statements of a generated source where losing bits is meant, each with its reason.

A statement stands here as it is written, for a motor called ``motor``. One that changes is no
longer meant: it needs a proof, or a new reason.
"""

import re

_MODULO = "positions count modulo 2**32; that they are the steps made is proven beside it"
_ENDLESS = "without an end point what is left counts modulo 2**32; else it fits, which is proven"
_TIMES = "a difference of two times, or a time a while ahead, of a clock that wraps"
_LOW_BYTES = "the lower bits are what is wanted"
_METRIC = "it wraps where the header says; that it is the position up to there is proven"
_PARTS = "the parts make up the whole, which is proven of the interval or of what is left"
_COUNTS = "counts of a timer, which wraps; no match is as much as half a round ahead: proven"
_AHEAD = "which of two positions lies ahead: those are less than 2**31 apart, or count as backward"
_ENDS = "one comparison, modulo 2**32, for both ends of a range; scenarios ask for both and more"
_LAPS = "0 laps stand for 256; without kLaps none is counted; that they make up the limit is proven"

_METRES = re.compile(r"\b(\w+?)(Read|Current)Position\(\)\) \* \d+UL")
_COUNTER = re.compile(r"\bTCNT\d\b")
_CHANNEL, _FLAGS = re.compile(r"\b(OC[FR])\d[ABC]\b"), re.compile(r"\bTIFR\d\b")

MEANT = {
    # Positions and what is left.
    "return motion.rest + GPIOR1;": _ENDLESS,
    "return motion.rest + motorCount;": _ENDLESS,
    "return (static_cast<uint32_t>(motion.restHigh) << 16 | motion.rest) + GPIOR1;": _ENDLESS,
    "return (static_cast<uint32_t>(motion.restHigh) << 16 | motion.rest) + motorCount;": _ENDLESS,
    "return motion.target + (motion.mode & kReverse ? left : -left);": _MODULO,
    "return static_cast<int32_t>(motorPosition());": _MODULO,
    "return static_cast<int32_t>(static_cast<uint32_t>(motorPosition()) * 1UL);": _METRIC,
    "motorShow(motorPosition());": "a phase is the position modulo the phases, a power of two here",
    "motion.rest = steps - 1;": _ENDLESS,
    "const uint32_t rest = limit - 1;": _ENDLESS,
    "steps = -steps;": _MODULO,
    "motion.target = here + steps;": _MODULO,
    "motion.target = mode & kReverse ? here - limit : here + limit;": _MODULO,
    "motion.rest = rest;": "its upper half is in the next line",
    "--motion.restHigh;": _ENDLESS,
    "motion.rest = rest - run;": _ENDLESS,
    "motion.rest += ahead;": _ENDLESS,
    "motion.rest = -1;": "with the one that is counted down, no step is left",
    "motion.rest = motion.restHigh = -1;": "with the one that is counted down, no step is left",
    # Times.
    "const uint32_t gone = timer0_millis - motion.start;": _TIMES,
    "const int32_t left = near(motorMotion).eventAt - motorEventClock();": _TIMES,
    "motion.eventAt = count + motion.interval;": _TIMES,
    "motion.wake = motion.start;": _TIMES,
    "motion.wake = millisNow() + wait;": _TIMES,
    "motion.endMillis = millisCount() + wait;": _TIMES,
    "motion.endMillis += 0x4000;": _TIMES,
    "return static_cast<int16_t>(millisCount() - motorMotion.endMillis) >= 0;": _TIMES,
    "motion.laps = laps;": _LAPS,
    "motion.lapsHigh = (laps - 1) >> 8;": _LAPS,
    "if (--motion.laps) return;": _LAPS,
    "uint16_t wait = millis & 0x3FFF;": _LOW_BYTES,
    "motorDeadline = static_cast<uint16_t>(timer0_millis) + motorTimeout;": _TIMES,
    "return static_cast<int16_t>(motorDeadline - static_cast<uint16_t>(timer0_millis));": _TIMES,
    # Intervals of the timing compare.
    "const uint8_t rest = ticks;": _LOW_BYTES,
    "return {first, static_cast<uint8_t>(rest - first), static_cast<uint8_t>(laps), "
    "static_cast<uint8_t>((laps - 1) >> 8)};": _PARTS,
    # A compare channel of a 16-bit timer.
    "uint16_t ticks = period;": _PARTS,
    "laps = (high << 2 | ticks >> 14) - 1;": _PARTS,
    "const uint16_t due = motion.due + ticks;": _COUNTS,
    "if (static_cast<int16_t>(now - motion.due) < 0 || (TIFR1 & _BV(OCF1A))) "
    "return false;": _COUNTS,
    "OCR1A = now + kSoonTicks;": _COUNTS,
    "++motion.missed;": "it wraps at 16 bits, as the header says",
    "motion.rest += run - 1;": _ENDLESS,
    # An axis.
    "if (motorPassed() && !lapped && !motion.lapsLeft) ++motion.missed;": (
        "it wraps at 16 bits, as the header says"
    ),
    "return motion.rest + static_cast<uint16_t>(steps + count);": (
        "a motor that coasts has 1 and -1 left; else it fits, which is proven"
    ),
    "return motion.mode & kReverse ? motion.end + left : motion.end - left;": _MODULO,
    "return motorPosition();": _MODULO,
    "return motorTarget();": _MODULO,
    "return motorTarget() - motorPosition();": _MODULO,
    "motion.end = motion.destination = position;": _MODULO,
    "motorAim(target, 0);": _MODULO,
    "motorAim(motorPosition() + steps, 0);": _MODULO,
    "motorAim(motorPosition() + kFar, kEndless);": _MODULO,
    "motorAim(motorPosition() - kFar, kEndless);": _MODULO,
    "return motorGo(motorPosition() + steps, 0);": _MODULO,
    "motorAim(motorPosition() + kMotorTravel, 0);": _MODULO,
    "motion.destination = motorContact + kMotorBackOff;": _MODULO,
    "motion.destination -= 2 * kMotorBackOff;": _MODULO,
    "motion.end += kMotorHome - motorContact;": _MODULO,
    "const uint32_t destination = target;": _MODULO,
    "motion.end = motion.mode & kReverse ? here - steps : here + steps;": _MODULO,
    "motion.end += motion.mode & kReverse ? -kFar : kFar;": _MODULO,
    "uint32_t way = motion.destination - motion.end;": _MODULO,
    "if (way >> 31) {": _AHEAD,
    "way = -way;": _MODULO,
    "const int32_t ahead = mode & kReverse ? here - destination : destination - here;": _AHEAD,
    "first = others % kFlatSteps + 1;": _LOW_BYTES,
    "change = -change;": "it is added modulo 2**32; that it is the ramp's is proven",
    "pace += motion.change;": "the same",
    "uint16_t ticks = interval >> 8;": _PARTS,
    "const uint16_t fraction = motion.dueFraction + static_cast<uint8_t>(interval);": _PARTS,
    "motion.dueFraction = fraction;": "its upper bit is in the next line",
    "const uint16_t due = motion.due + ticks + (fraction >> 8);": _COUNTS,
    "motion.due += kLapTicks;": _COUNTS,
    "OCR1A = TCNT1 + kSoonTicks;": _COUNTS,
    "if (position < kMotorLowest || position > kMotorHighest) return MOTOR_ERROR_RANGE;": _ENDS,
    "if (destination < kMotorLowest || destination > kMotorHighest) return MOTOR_ERROR_RANGE;": (
        _ENDS
    ),
    "if (target < kMotorLowest || target > kMotorHighest) return MOTOR_ERROR_RANGE;": _ENDS,
}


_NAMES = (
    *("Position", "ReadPosition", "Show", "EventClock", "Count", "Motion"),
    *("Left", "Target", "Queue", "Queued", "Place", "Aim", "Passed"),
    *("Deadline", "Timeout", "Go", "Contact"),
)


def is_meant(text: str, motors: tuple[str, ...], used: set[str]) -> bool:
    """
    Tell whether the statement *text* may lose bits, and note its use in *used*.
    """
    line = for_motor(text, motors)
    if line not in MEANT:
        return False
    used.add(line)
    return True


def for_motor(text: str, motors: tuple[str, ...]) -> str:
    """
    Return *text* of a library of *motors* as it were for one called ``motor``, on channel 1A.
    """
    text = _METRES.sub(r"\1Position()) * 1UL", text)
    for motor in motors:
        title = motor[0].upper() + motor[1:]
        text = re.sub(rf"\bk{title}(Lowest|Highest|Travel|BackOff|Home)\b", r"kMotor\1", text)
        for after in _NAMES:
            text = re.sub(rf"\b{motor}{after}\b", f"motor{after}", text)
    text = _COUNTER.sub("TCNT1", _CHANNEL.sub(r"\g<1>1A", text))
    return _FLAGS.sub("TIFR1", text)
