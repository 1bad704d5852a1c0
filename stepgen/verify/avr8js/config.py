"""
The chip as avr8js wants it described: made from the device tables, the same for every chip.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from stepgen.devices import Mcu, Timer, Timer8, Timer16, Vector

_WORDS_PER_VECTOR = 2
_TIMER0 = {"TIFR": 0x35, "OCRA": 0x47, "OCRB": 0x48, "TCNT": 0x46, "TCCRA": 0x44, "TCCRB": 0x45}
_TIMER0_TIMSK = 0x6E
# Data addresses of UCSRnA, and where the others are from there.
_USARTS = {"USART": 0xC0, "USART0": 0xC0, "USART1": 0xC8}
_USART = {"UCSRA": 0, "UCSRB": 1, "UCSRC": 2, "UBRRL": 4, "UBRRH": 5, "UDR": 6}
_CLOCK_SELECTS = range(8)
_NO_16_BIT_REGISTERS = {"OCRC": 0, "ICR": 0, "TCCRC": 0, "captureInterrupt": 0}
_USB = {"PLLCSR": 0x49, "UDCON": 0xE0, "UDINT": 0xE1, "UDIEN": 0xE2}
# Bits of TIFRn and of TIMSKn, and the vectors behind them.
_TOV, _OCFA, _OCFB, _OCFC = 1, 2, 4, 8
# Pin change interrupts of port B, the same registers on each chip: PCICR bit 0.
_PIN_CHANGE_B = {"PCIE": 0, "PCICR": 0x68, "PCIFR": 0x3B, "PCMSK": 0x6B, "mask": 0xFF, "offset": 0}


def describe(mcu: Mcu) -> dict[str, Any]:
    """
    Return ports, timers, first USART, USB and watchdog of *mcu* as the driver hands them to avr8js.

    The ADC, SPI and TWI are left out: a program that waits for them hangs.
    """
    return {
        "flash_bytes": mcu.flash_bytes,
        "ram_start": mcu.ram_start,
        "ram_end": mcu.ram_start + mcu.ram_bytes - 1,
        "response_cycles": mcu.response_cycles,
        "ports": list(_ports(mcu)),
        "timers": [
            _timer0(mcu),
            *(_timer8(timer, mcu) for timer in mcu.timers8),
            *(_timer16(timer, mcu) for timer in mcu.timers16),
        ],
        "usart": _usart(mcu),
        "usb": _usb(mcu),
        "watchdog": _address(mcu.vector("WDT_vect")),
    }


def _ports(mcu: Mcu) -> Iterator[dict[str, Any]]:
    for port in mcu.ports:
        config: dict[str, Any] = {
            "PIN": port.pin.address,
            "DDR": port.ddr.address,
            "PORT": port.port.address,
            "externalInterrupts": [],
        }
        if port.letter == "B":
            vector = mcu.vector("PCINT0_vect")
            config["pinChange"] = {**_PIN_CHANGE_B, "pinChangeInterrupt": _address(vector)}
        yield config


def _timer0(mcu: Mcu) -> dict[str, Any]:
    vectors = [mcu.vector(f"TIMER0_{name}_vect") for name in ("OVF", "COMPA", "COMPB")]
    return {
        **_common(8, _TIMER0_TIMSK, dict(zip((_TOV, _OCFA, _OCFB), vectors, strict=True))),
        **_TIMER0,
        **_NO_16_BIT_REGISTERS,
        "dividers": _dividers(Timer16.prescalers),  # it shares theirs
        "recorded": False,  # it is the core's
    }


def _timer8(timer: Timer8, mcu: Mcu) -> dict[str, Any]:
    vectors = {_TOV: timer.ovf, _OCFA: timer.compa, _OCFB: timer.compb}
    return {
        **_common(8, timer.timsk.address, vectors),
        **_registers_and_outputs(timer, mcu),
        **_NO_16_BIT_REGISTERS,
    }


def _timer16(timer: Timer16, mcu: Mcu) -> dict[str, Any]:
    vectors = {_TOV: timer.ovf, _OCFA: timer.compa, _OCFB: timer.compb}
    if timer.compc:
        vectors[_OCFC] = timer.compc
    return {
        **_common(16, timer.timsk.address, vectors),
        **_registers_and_outputs(timer, mcu),
        "TCCRC": timer.tccrc.address,
        "ICR": timer.icr.address,
        "OCRC": timer.ocrc.address if timer.ocrc else 0,
        "captureInterrupt": _address(timer.capt),
    }


def _registers_and_outputs(timer: Timer, mcu: Mcu) -> dict[str, Any]:
    outputs: dict[str, int] = {}
    for channel, bit in timer.outputs:
        outputs[f"compPort{channel}"] = mcu.port(bit.port).port.address
        outputs[f"compPin{channel}"] = bit.bit
    return {
        "TIFR": timer.tifr.address,
        "TCCRA": timer.tccra.address,
        "TCCRB": timer.tccrb.address,
        "TCNT": timer.tcnt.address,
        "OCRA": timer.ocra.address,
        "OCRB": timer.ocrb.address,
        "dividers": _dividers(timer.prescalers),
        "recorded": True,
        **outputs,
    }


def _dividers(prescalers: Sequence[int]) -> dict[int, int]:
    """
    Return what each clock select divides by; 0 where the timer stands still.
    """
    taps = dict(enumerate(prescalers, start=1))
    return {select: taps.get(select, 0) for select in _CLOCK_SELECTS}


def _common(bits: int, timsk: int, vectors: dict[int, Vector]) -> dict[str, Any]:
    has_c = _OCFC in vectors
    bits_used = (_TOV, _OCFA, _OCFB, _OCFC if has_c else 0)
    return {
        "bits": bits,
        "TIMSK": timsk,
        "externalClockPort": 0,
        "externalClockPin": 0,
        **{f"compPort{channel}": 0 for channel in "ABC"},
        **{f"compPin{channel}": 0 for channel in "ABC"},
        "ovfInterrupt": _address(vectors[_TOV]),
        "compAInterrupt": _address(vectors[_OCFA]),
        "compBInterrupt": _address(vectors[_OCFB]),
        "compCInterrupt": _address(vectors[_OCFC]) if has_c else 0,
        **dict(zip(("TOV", "OCFA", "OCFB", "OCFC"), bits_used, strict=True)),
        **dict(zip(("TOIE", "OCIEA", "OCIEB", "OCIEC"), bits_used, strict=True)),
        "enables": [[mask, vector.number] for mask, vector in vectors.items()],
    }


def _usart(mcu: Mcu) -> dict[str, int]:
    """
    Return the first USART: USART where there is one, else USART0 or, on the ATmega32U4, USART1.
    """
    vectors = {vector.name: vector for vector in mcu.vectors}
    name = next(name for name in _USARTS if f"{name}_RX_vect" in vectors)
    return {
        **{register: _USARTS[name] + offset for register, offset in _USART.items()},
        "rxCompleteInterrupt": _address(vectors[f"{name}_RX_vect"]),
        "dataRegisterEmptyInterrupt": _address(vectors[f"{name}_UDRE_vect"]),
        "txCompleteInterrupt": _address(vectors[f"{name}_TX_vect"]),
    }


def _usb(mcu: Mcu) -> dict[str, int] | None:
    """
    Return what of USB the driver plays the computer with; None where the chip has none.
    """
    found = [vector for vector in mcu.vectors if vector.name == "USB_GEN_vect"]
    return {**_USB, "interrupt": _address(found[0])} if found else None


def _address(vector: Vector) -> int:
    """
    Return the address of *vector* in words: each is a jump of two.
    """
    return vector.number * _WORDS_PER_VECTOR
