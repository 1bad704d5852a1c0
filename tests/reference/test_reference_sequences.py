"""
Coil tables against the electrical facts.
"""

from typing import get_args

import pytest

from stepgen.errors import StepgenError
from stepgen.reference.sequences import Drive, coils_off, phases


@pytest.mark.parametrize(
    ("drive", "sequence", "patterns"),
    [
        ("four-wire", "full", "1100 0110 0011 1001"),
        ("four-wire", "wave", "1000 0100 0010 0001"),
        ("four-wire", "half", "1000 1100 0100 0110 0010 0011 0001 1001"),
        ("motor-shield", "full", "1100 1110 1111 1101"),
        ("motor-shield", "wave", "01x0 101x 01x1 100x"),
        ("motor-shield", "half", "1100 01x0 1110 101x 1111 01x1 1101 100x"),
    ],
)
def test_named_sequences(drive: Drive, sequence: str, patterns: str) -> None:
    """
    Each named sequence is the table of the electrical facts, x where a level moves nothing.
    """
    assert [str(pattern) for pattern in phases(drive, sequence)] == patterns.split()


@pytest.mark.parametrize("drive", get_args(Drive))
@pytest.mark.parametrize("sequence", ["full", "half"])
def test_neighbouring_phases_differ_in_one_coil_current(drive: Drive, sequence: str) -> None:
    """
    Neighbouring phases, also the last and the first, exclude each other.
    """
    table = phases(drive, sequence)

    for one, two in zip(table, table[1:] + table[:1], strict=True):
        assert not one.allows(two.driven)


def test_own_table_is_taken_as_written() -> None:
    """
    An own table lists the wires in the order given, 1 for driven.
    """
    table = phases("four-wire", ["1010", "0110", "0101"])

    assert [str(pattern) for pattern in table] == ["1010", "0110", "0101"]


@pytest.mark.parametrize(
    ("drive", "sequence", "reason"),
    [
        ("four-wire", "quarter", "no sequence of this name"),
        ("motor-shield", "quarter", "no sequence of this name"),
        ("motor-shield", ["1010", "0101"], "takes no table"),
        ("four-wire", ["1010"], "1 patterns"),
        ("four-wire", ["1010"] * 65, "65 patterns"),
        ("four-wire", ["1010", "101"], "no pattern"),
        ("four-wire", ["1010", "10x0"], "no pattern"),
    ],
)
def test_what_is_no_sequence_is_refused(
    drive: Drive, sequence: str | list[str], reason: str
) -> None:
    """
    Unknown names and tables of the wrong shape say what is wrong.
    """
    with pytest.raises(StepgenError, match=reason):
        phases(drive, sequence)


def test_longest_table_is_accepted() -> None:
    """
    An own table may have 64 patterns.
    """
    assert len(phases("four-wire", ["1010", "0101"] * 32)) == 64


def test_coils_off_leaves_directions_open() -> None:
    """
    Without current every coil is off; the directions of the shield may show anything.
    """
    assert str(coils_off("four-wire")) == "0000"
    assert str(coils_off("motor-shield")) == "00xx"
    assert coils_off("motor-shield").allows([False, False, True, False])
    assert not coils_off("motor-shield").allows([True, False, True, False])
