"""
Points about the CPU: cycles of instructions, interrupts, ports, and the small peripherals.
"""

from collections.abc import Iterator

from stepgen.verify.conformance.lab import Lab, cycles, gaps, of_kind, ram
from stepgen.verify.conformance.point import MEGA_1280_CHIP, MEGA_CHIP, USB_CHIP, Judge, point
from stepgen.verify.events import Kind
from stepgen.verify.simulators import Machine

PINB, DDRB, PORTB, PORTH = 0x23, 0x24, 0x25, 0x102
FAST, CLOCK_1, CLOCK_1024 = 15, 1, 5


def _instructions(wide: int) -> Judge:
    """
    Return the judge of the instruction set summary; *wide* is the third byte of the PC.
    """
    expected = [
        *(1, 1, 1, 1),  # nop, add, movw, ldi
        *(2, 2, 2),  # adiw, mul, sbiw
        *(2, 2, 2, 2, 2, 2),  # lds, sts, ld X, ld -X, std Y+q, ldd Y+q
        *(3, 3),  # lpm Z, lpm Z+
        *(2, 2, 1, 1),  # push, pop, in, out
        *(2, 2),  # sbi, cbi
        *(2, 3, 2),  # rjmp, jmp, ijmp
        *(1, 2),  # brne: not taken, taken
        *(1, 2, 3),  # sbrs: no skip, skip of one word, of two
        *(1, 2, 3),  # cpse: the same
        *(1, 2, 3),  # sbis: the same
        *(3 + 4 + 2 * wide, 4 + 4 + 2 * wide, 3 + 4 + 2 * wide),  # rcall, call, icall; each ret
    ]

    def judge(lab: Lab) -> Iterator[str]:
        with lab.running("instructions") as machine:
            machine.run_until_mark(3, limit_cycles=1000)
            # Every other gap, less the cycle of the out that is the second mark.
            taken = [gap - 1 for gap in gaps(cycles(machine, Kind.MARK))[::2]]
            wrong = [
                i for i, pair in enumerate(zip(expected, taken, strict=False)) if len({*pair}) > 1
            ]
            if len(taken) != len(expected) or wrong:
                yield f"cycles of instructions: {taken}, but the chip has {expected}"

    return judge


instructions_uno = point("instruction-cycles", "Cycles of each kind of instruction", "32")(
    _instructions(0)
)
instructions_mega = point(
    "instruction-cycles-2560", "Cycles of each kind of instruction, ATmega2560", "33", MEGA_CHIP
)(_instructions(1))
instructions_mega_1280 = point(
    "instruction-cycles-1280",
    "Cycles of each kind of instruction, ATmega1280",
    "33",
    MEGA_1280_CHIP,
)(_instructions(0))
instructions_32u4 = point(
    "instruction-cycles-32u4",
    "Cycles of each kind of instruction, ATmega32U4",
    "DS40002198: PC of 16 bits",
    USB_CHIP,
)(_instructions(0))


def _response(response: int) -> Judge:
    """
    Return the judge of the response: from an instruction boundary to the vector.
    """

    def judge(lab: Lab) -> Iterator[str]:
        with lab.running("periodic", MODE=FAST, CLOCK=CLOCK_1, TOP_VALUE=999) as machine:
            machine.run_until(10_000)
            entered = of_kind(machine, Kind.ISR_ENTER)
            toggled = cycles(machine, Kind.PORT)[1:]
            left = cycles(machine, Kind.ISR_EXIT)
            taken = [int(cycle) for cycle in entered["cycle"]]
            # jmp (3) and sbi (2); then reti, which takes as long as the response.
            to_port = {port - enter for port, enter in zip(toggled, taken, strict=False)}
            to_end = {end - enter for end, enter in zip(left, taken, strict=False)}
            if to_port != {response + 5} or to_end != {response + 5 + response}:
                yield f"port after {to_port}, end after {to_end}, expected {response} for response"
            # The loop is a rjmp of 2 cycles: the flag waits for its end at most.
            waits = {int(wait) for wait in entered["cycle"] - entered["since"]}
            if not waits <= {0, 1}:
                yield f"flags wait {sorted(waits)} cycles for the end of a rjmp"

    return judge


response_uno = point("response", "Interrupt response of 4 cycles", "7.7.1")(_response(4))
response_mega = point(
    "response-2560", "Interrupt response of 5 cycles, ATmega2560", "7.8.1", MEGA_CHIP
)(_response(5))
response_mega_1280 = point(
    "response-1280", "Interrupt response of 4 cycles, ATmega1280", "7.8.1", MEGA_1280_CHIP
)(_response(4))
response_32u4 = point(
    "response-32u4",
    "Interrupt response of 4 cycles, ATmega32U4",
    "DS40002198: PC of 16 bits",
    USB_CHIP,
)(_response(4))


@point("wake-up", "From idle sleep the response takes 4 cycles more", "7.7.1")
def wake_up(lab: Lab) -> Iterator[str]:
    """
    Asleep the flag waits for nothing: response 4, waking 4, jmp 3, sbi 2.
    """
    macros = {"MODE": FAST, "CLOCK": CLOCK_1024, "TOP_VALUE": 99, "IDLE": 1}
    with lab.running("periodic", watch=(), **macros) as machine:
        machine.run_until(6 * 102_400)
        raised, toggled = cycles(machine, Kind.RAISE), cycles(machine, Kind.PORT)[1:]
        seen = {port - flag for port, flag in zip(toggled, raised, strict=False)}
        if seen != {4 + 4 + 3 + 2}:
            yield f"from flag to port {seen} cycles, on the chip 13"


@point("pending-once", "A flag that comes twice while interrupts are off runs once", "7.7")
def pending_once(lab: Lab) -> Iterator[str]:
    """
    Interrupts are off for 2500 cycles of a timer that compares each 1000; then there is a window.
    """
    with lab.running("masked") as machine:
        machine.run_until_mark(2, limit_cycles=10_000)
        runs = len(cycles(machine, Kind.ISR_ENTER))
        if runs != 1:
            yield f"{runs} runs, on the chip one"


@point("sei-delay", "One instruction comes between sei and a waiting interrupt", "7.7")
def sei_delay(lab: Lab) -> Iterator[str]:
    """
    `sei; nop; cli` lets it in after the nop, `sei; cli` does not.
    """
    with lab.running("masked") as machine:
        machine.run_until_mark(6, limit_cycles=20_000)
        at = _marks(machine)
        entered = cycles(machine, Kind.ISR_ENTER)
        inside = [cycle for cycle in entered if at[3] < cycle < at[4]]
        if len(inside) != 1:
            yield f"`sei; nop; cli` lets {len(inside)} in, on the chip one"
        if any(at[5] < cycle < at[6] for cycle in entered):
            yield "`sei; cli` lets one in, on the chip none"


@point("masked-flag", "A flag that waits for its enable bit fires when the bit is set", "7.7")
def masked_flag(lab: Lab) -> Iterator[str]:
    """
    With OCIE1A clear nothing comes; with it set the interrupt comes at once.
    """
    with lab.running("masked") as machine:
        machine.run_until_mark(8, limit_cycles=20_000)
        at = _marks(machine)
        late = [cycle for cycle in cycles(machine, Kind.ISR_ENTER) if cycle > at[6]]
        if len(late) != 1 or not at[7] < late[0] < at[8]:
            yield f"runs at {late}, on the chip one between {at[7]} and {at[8]}"


@point("channel-c", "A cleared flag or enable bit of compare C ends its wait", "15.8", MEGA_CHIP)
def channel_c(lab: Lab) -> Iterator[str]:
    """
    With its flag or its enable bit cleared, an interrupt that waits does not run.
    """
    with lab.running("channel_c") as machine:
        machine.run_until_mark(6, limit_cycles=20_000)
        at = _marks(machine)
        entered = cycles(machine, Kind.ISR_ENTER)
        for mark, cleared, wanted in ((1, "enable bit", 0), (3, "flag", 0), (5, "", 1)):
            runs = sum(at[mark] < cycle < at[mark + 1] for cycle in entered)
            if runs != wanted:
                yield f"{runs} runs with {cleared or 'nothing'} cleared, on the chip {wanted}"


def _port_writes(port_h: list[int]) -> Judge:
    """
    Return the judge of writes to PINx; *port_h* is what port H, beyond in and out, shows.
    """

    def judge(lab: Lab) -> Iterator[str]:
        with lab.running("ports") as machine:
            machine.run_until_mark(1, limit_cycles=1000)
            # 0x24 ^ 0x0C = 0x28, ^ 0x10 = 0x38, ^ 0x21 = 0x19, | 0x04 = 0x1D.
            for address, expected in ((PORTB, [0x24, 0x28, 0x38, 0x19, 0x1D]), (PORTH, port_h)):
                seen = [int(value) for value in of_kind(machine, Kind.PORT, address)["value"]]
                if seen != expected:
                    yield f"port at {address:#x} shows {seen}, on the chip {expected}"

    return judge


pin_writes = point(
    "pin-writes", "Ones written to PINx toggle those bits; sbi toggles one", "14.2.2"
)(_port_writes([]))
pin_writes_mega = point(
    "pin-writes-2560", "Ones written to PINx beyond port G toggle", "13.2.2", MEGA_CHIP
)(_port_writes([0x18, 0x08]))
pin_writes_mega_1280 = point(
    "pin-writes-1280",
    "Ones written to PINx beyond port G toggle, ATmega1280",
    "13.2.2",
    MEGA_1280_CHIP,
)(_port_writes([0x18, 0x08]))


@point("port-write-cycles", "A port changes at the end of its instruction", "32")
def port_write_cycles(lab: Lab) -> Iterator[str]:
    """
    See the cycles of ldi and out; sbi; cbi, ldi and sts; sbi: sbi, cbi and sts take 2 cycles.
    """
    with lab.running("ports") as machine:
        machine.run_until_mark(1, limit_cycles=1000)
        seen = gaps(cycles(machine, Kind.PORT, PORTB))
        if seen != [2, 2, 5, 2]:
            yield f"{seen} cycles between port writes, on the chip [2, 2, 5, 2]"


def _uart(lab: Lab) -> Iterator[str]:
    """
    Let it send each byte plus one.
    """
    with lab.running("serial") as machine:
        machine.send_serial(b"HAL")
        machine.run_until(10_000)
        sent = bytes(of_kind(machine, Kind.UART)["value"].astype("u1"))
        if sent != b"IBM":
            yield f"sent {sent!r} upon b'HAL', on the chip b'IBM'"


uart = point("uart", "USART0 receives bytes and sends bytes, by interrupts", "19.6, 19.7")(_uart)
uart_32u4 = point(
    "uart-32u4", "USART1 of the ATmega32U4 receives and sends bytes", "Atmel-7766: 18.6", USB_CHIP
)(_uart)


@point("uart-buffer", "USART0 takes a second byte while it sends the first", "19.6.1")
def uart_buffer(lab: Lab) -> Iterator[str]:
    """
    So each answer leaves as soon as a byte has come: each 10 x 16 (UBRR + 1) = 640 cycles.
    """
    with lab.running("serial") as machine:
        machine.send_serial(b"HAL")
        machine.run_until(10_000)
        times = gaps(cycles(machine, Kind.UART))
        if [time for time in times if abs(time - 640) <= 3] != times or not times:  # noqa: PLR2004
            yield f"{times} cycles between bytes, on the chip 640, give or take an instruction"


@point("uart-status", "UCSR0A: the CPU writes U2X, a one clears TXC, UDRE is the chip's", "19.10.2")
def uart_status(lab: Lab) -> Iterator[str]:
    """
    UDRE and U2X; TXC too when the byte has gone out, and after a zero; not after a one.
    """
    with lab.running("status") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen = ram(machine, "seen", 4)
        if seen != [0x22, 0x62, 0x62, 0x22]:
            yield f"UCSR0A is {bytes(seen).hex()}, on the chip 22626222"


@point("pin-change", "A change of an input raises its pin change interrupt", "13.2")
def pin_change(lab: Lab) -> Iterator[str]:
    """
    Three changes of PB0, three runs.
    """
    with lab.running("pin_change") as machine:
        machine.run_until_mark(1, limit_cycles=1000)
        for high in (True, False, True):
            machine.drive_pin(PINB, 0, high=high)
            machine.run_until(machine.cycle + 100)
        runs = ram(machine, "runs", 1)[0]
        if runs != 3:  # noqa: PLR2004 - see above
            yield f"{runs} runs after 3 changes"


@point("driven-input", "What drives an input is stronger than its pull-up", "14.2.3")
def driven_input(lab: Lab) -> Iterator[str]:
    """
    PB0 shows the level at which it is held, also after its port was written.
    """
    levels = (True, False, True, False)
    with lab.running("driven_input") as machine:
        for mark, level in enumerate(levels, 1):
            machine.run_until_mark(mark, limit_cycles=1000)
            machine.drive_pin(PINB, 0, high=level)
        machine.run_until_mark(len(levels) + 1, limit_cycles=1000)
        seen = ram(machine, "seen", len(levels))
        if seen != [1, 0, 1, 0]:
            yield f"PB0 shows {seen}, on the chip [1, 0, 1, 0]"


def _marks(machine: Machine) -> dict[int, int]:
    """
    Return the cycle of each mark that the program has written.
    """
    return {int(row["value"]): int(row["cycle"]) for row in of_kind(machine, Kind.MARK)}
