"""
Boards: every pin agrees with the Arduino core or, for the serial ports, the datasheet.
"""

import re
import subprocess
from pathlib import Path

import pytest

from stepgen.devices import Board, Pin, boards, find_board
from stepgen.verify.recipes import Target, board_properties, platform_dir

# RXDn and TXDn, from the datasheets' chapters "Alternate Port Functions".
MEGA_SERIAL_PINS = {
    "Serial RX": "PE0",
    "Serial TX": "PE1",
    "Serial1 RX": "PD2",
    "Serial1 TX": "PD3",
    "Serial2 RX": "PH0",
    "Serial2 TX": "PH1",
    "Serial3 RX": "PJ0",
    "Serial3 TX": "PJ1",
}
# Pins of the core that no header has: the Leonardo's LED TX.
NO_HEADER = {"atmega32u4": ["PD5"]}
SERIAL_PINS = {
    "atmega328p": {"Serial RX": "PD0", "Serial TX": "PD1"},
    "atmega32u4": {"Serial1 RX": "PD2", "Serial1 TX": "PD3"},
    "atmega1280": MEGA_SERIAL_PINS,
    "atmega2560": MEGA_SERIAL_PINS,
}
NOT_AN_INTERRUPT = 255
WRITES_WDTCSR = re.compile(r"\bsts\s+0x0060\b")


def pins_with(board: Board, pattern: str) -> dict[str, Pin]:
    """
    Return the pins with a use that matches *pattern*, by that use.
    """
    return {use: pin for pin in board.pins for use in pin.uses if re.fullmatch(pattern, use)}


def test_every_pin_is_where_the_core_has_it(
    board: Board,
    pin_tables: dict[str, bytes],
    core_numbers: dict[str, int],
    libc_registers: dict[str, int],
) -> None:
    """
    The header pins are all digital pins of the variant, each on the core's port and bit.

    What the core numbers once more is a pin that it has already, or on no header.
    """
    words = pin_tables["port_to_output_PGM"]
    outputs = [int.from_bytes(words[i : i + 2], "little") for i in range(0, len(words), 2)]
    letters = {libc_registers[f"PORT{port.letter}"]: port.letter for port in board.mcu.ports}
    ports = [letters[outputs[code]] for code in pin_tables["digital_pin_to_port_PGM"]]
    masks = list(pin_tables["digital_pin_to_bit_mask_PGM"])

    bits = [f"P{letter}{mask.bit_length() - 1}" for letter, mask in zip(ports, masks, strict=True)]
    count = len(board.pins)
    once_more = [bit for bit in bits[count:] if bit not in bits[:count]]

    assert [pin.number for pin in board.pins] == list(range(count))
    assert len(bits) == core_numbers["NUM_DIGITAL_PINS"]
    assert [pin.bit.name for pin in board.pins] == bits[:count]
    assert once_more == NO_HEADER.get(board.mcu.name, [])
    assert all(pin.bit.bit in board.mcu.port(pin.bit.port).bits for pin in board.pins)


def test_labels_are_those_on_the_board(
    board: Board, pin_tables: dict[str, bytes], core_numbers: dict[str, int]
) -> None:
    """
    Pins that are analog inputs are labelled A0 and so on, the others by their number.

    The core numbers those that are no port bits behind its last digital pin, and those of the
    Leonardo that are other pins, too, behind the last pin on a header.
    """
    inputs = range(core_numbers["NUM_ANALOG_INPUTS"])
    analog = {core_numbers[f"PIN_A{number}"]: f"A{number}" for number in inputs}
    digital = core_numbers["NUM_DIGITAL_PINS"]

    assert [pin.label for pin in board.pins] == [
        analog.get(pin.number, f"D{pin.number}") for pin in board.pins
    ]
    assert board.analog_inputs == tuple(
        label for number, label in analog.items() if number >= digital
    )
    masks = pin_tables["digital_pin_to_bit_mask_PGM"]
    ports = pin_tables["digital_pin_to_port_PGM"]
    also = {
        label: [pin.label for pin in board.pins if (ports[pin.number], masks[pin.number]) == place]
        for number, label in analog.items()
        if len(board.pins) <= number < digital
        for place in [(ports[number], masks[number])]
    }
    assert also == {label: [pin.label] for pin in board.pins for label in pin.also}


def test_uses_of_pins_are_those_of_the_core(
    board: Board, pin_tables: dict[str, bytes], core_numbers: dict[str, int]
) -> None:
    """
    SPI, I2C, LED and PWM are on the pins that the core's variant names.
    """
    names = {f"SPI {signal}": f"PIN_SPI_{signal}" for signal in ("SS", "MOSI", "MISO", "SCK")}
    names |= {f"I2C {signal}": f"PIN_WIRE_{signal}" for signal in ("SDA", "SCL")}
    names |= {"LED": "LED_BUILTIN"}
    expected = {use: core_numbers[macro] for use, macro in names.items()}
    pwm = {
        number: f"PWM OC{name[5:]}"
        for name, number in core_numbers.items()
        if re.fullmatch(r"TIMER\d[A-D]", name)
    }
    expected |= {
        pwm[code]: number
        for number, code in enumerate(pin_tables["digital_pin_to_timer_PGM"])
        if code
    }
    found = pins_with(board, "(SPI|I2C|PWM) .*|LED")

    assert {use: pin.number for use, pin in found.items()} == expected


def test_external_interrupts_are_those_of_the_core(
    board: Board,
    pin_tables: dict[str, bytes],
    core_interrupts: dict[int, int],
    libc_vectors: dict[str, int],
) -> None:
    """
    A pin's INTn is the chip's n: the vector behind the core's digitalPinToInterrupt().
    """
    names = {number: name.removesuffix("_vect") for name, number in libc_vectors.items()}
    expected = {
        names[core_interrupts[interrupt]]: number
        for number, interrupt in enumerate(pin_tables["digital_pin_to_interrupt_PGM"])
        if interrupt != NOT_AN_INTERRUPT
    }

    assert {use: pin.number for use, pin in pins_with(board, r"INT\d").items()} == expected


def test_serial_ports_are_on_the_chips_pins(board: Board) -> None:
    """
    Each USART of the chip is a Serial on the pins RXDn and TXDn.
    """
    found = {use: pin.bit.name for use, pin in pins_with(board, r"Serial\d? [RT]X").items()}

    assert found == SERIAL_PINS[board.mcu.name]


def test_every_use_is_of_a_checked_kind(board: Board) -> None:
    """
    No pin has a use that the tests above do not check, and none is given twice.
    """
    checked = r"(SPI|I2C|PWM) .*|LED|INT\d|Serial\d? [RT]X"
    uses = [use for pin in board.pins for use in pin.uses]

    assert sorted(uses) == sorted(pins_with(board, checked))


def test_boards_are_those_of_boards_txt(board: Board, boards_txt: dict[str, str]) -> None:
    """
    Clock, chip, variant and define are what the core's boards.txt gives for the FQBN.

    Behind the board's name stands a choice in each of its menus, and no other.
    """
    package, architecture, name, *options = board.fqbn.split(":")
    menus = {key.split(".")[2] for key in boards_txt if key.startswith(f"{name}.menu.")}
    prefixes = [name, *(f"{name}.menu.{option.replace('=', '.')}" for option in options)]
    build = {
        key.removeprefix(f"{prefix}.build."): value
        for prefix in prefixes
        for key, value in boards_txt.items()
        if key.startswith(f"{prefix}.build.")
    }

    assert (package, architecture) == ("arduino", "avr")
    assert {option.split("=")[0] for option in options} == menus
    assert all(prefix in boards_txt for prefix in prefixes[1:])
    assert build["mcu"] == board.mcu.name
    assert build["f_cpu"] == f"{board.f_cpu_hz}L"
    assert build["variant"] == board.variant
    assert f"ARDUINO_{build['board']}" == board.core_define


@pytest.mark.parametrize(
    ("text", "label"),
    [
        ("D12", "D12"),
        ("d12", "D12"),
        ("12", "D12"),
        ("PB4", "D12"),
        ("pb4", "D12"),
        ("A0", "A0"),
        ("a0", "A0"),
        ("14", "A0"),
        ("D14", "A0"),
        ("PC0", "A0"),
    ],
)
def test_a_pin_is_found_by_all_its_names(text: str, label: str, uno: Board) -> None:
    """
    A pin goes by its label, its number and its port bit, in any case.
    """
    found = uno.find_pin(text)

    assert found is not None
    assert found.label == label


def test_a_pin_with_two_labels_is_found_by_both() -> None:
    """
    The Leonardo's D4 is its analog input A6; A0 is a pin of its own.
    """
    leonardo = find_board("leonardo")
    assert leonardo is not None

    assert leonardo.find_pin("a6") is leonardo.find_pin("D4") is leonardo.find_pin("PD4")
    assert leonardo.find_pin("A0") is leonardo.find_pin("PF7")
    assert leonardo.find_pin("A12") is None


def test_no_two_boards_are_the_same() -> None:
    """
    Names, titles and FQBNs are each board's own.
    """
    for field in ("name", "title", "fqbn"):
        values = [getattr(board, field) for board in boards()]
        assert len(set(values)) == len(values)


@pytest.mark.parametrize("text", ["PB6", "PC6", "D20", "A6", "PB8", "D012", "B4", "", "-1"])
def test_what_is_on_no_header_is_not_found(text: str, uno: Board) -> None:
    """
    Port bits without a header pin, numbers past the last and misspelt names find nothing.
    """
    assert uno.find_pin(text) is None


def test_every_name_of_a_pin_is_its_own(board: Board) -> None:
    """
    Each name of each pin finds that pin and no other.
    """
    assert all(board.find_pin(name) is pin for pin in board.pins for name in pin.names)


def test_boards_are_found_by_name() -> None:
    """
    Every board is found by its own name, and no other name finds one.
    """
    assert {"mega", "uno"} <= {board.name for board in boards()}
    assert all(find_board(board.name) is board for board in boards())
    assert find_board("Uno") is None


def boot_loaders(board: Board) -> list[Path]:
    """
    Return the boot loaders that the core has for the board's chip, as far as they are here.

    Those of Caterina are not in Debian's core; its source clears MCUSR and calls wdt_disable().
    """
    target = Target.from_fqbn(board.fqbn)
    lines = (platform_dir() / "boards.txt").read_text(encoding="utf-8").splitlines()
    words = dict(line.split("=", 1) for line in lines if "=" in line)
    clock = f"{board.f_cpu_hz}L"
    found = []
    for key, file in words.items():
        if not (key.startswith(f"{target.board_id}.") and key.endswith(".bootloader.file")):
            continue
        menu = key.removesuffix(".bootloader.file")
        mcu = words.get(f"{menu}.build.mcu", words.get(f"{target.board_id}.build.mcu"))
        speed = words.get(f"{menu}.build.f_cpu", words.get(f"{target.board_id}.build.f_cpu"))
        if (mcu, speed) == (board.mcu.name, clock):
            found.append(platform_dir() / "bootloaders" / file)
    return [path for path in found if path.is_file()]


def test_boards_that_reset_for_ever_are_those_whose_boot_loader_leaves_the_watchdog(
    board: Board,
) -> None:
    """
    A boot loader that never writes to WDTCSR cannot switch the watchdog off (disassembled).
    """
    paths = boot_loaders(board)
    family = "avr6" if board.mcu.name == "atmega2560" else "avr51"
    listings = [
        subprocess.run(
            ["avr-objdump", "-m", family, "-D", str(path)],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for path in paths
    ]

    assert paths or board.mcu.name == "atmega32u4"
    assert board.may_reset_for_ever == any(not WRITES_WDTCSR.search(text) for text in listings)


def test_a_brown_out_resets_every_board(board: Board) -> None:
    """
    The fuses that the core burns do not switch the detector off: BODLEVEL is not 111.

    Datasheets, table "Extended Fuse Byte" of the ATmega328P, 32U4, 1280 and 2560: bits 2 to 0.
    """
    fuses = board_properties(Target.from_fqbn(board.fqbn))["bootloader.extended_fuses"]

    assert int(fuses, 16) & 0b111 != 0b111
