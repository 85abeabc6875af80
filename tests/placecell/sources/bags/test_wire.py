"""Serialized messages, written by hand."""

import struct

import pytest

from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError


def test_cdr_aligns_values_and_ends_strings_with_a_zero() -> None:
    data = bytes.fromhex("00010000") + struct.pack("<BxxxI3sBxxxxd", 7, 3, b"ab\0", 9, 1.5)
    wire = Wire(data, "cdr", "test")
    assert (wire.u8(), wire.string(), wire.u8()) == (7, "ab", 9)
    assert wire.doubles(1).tolist() == [1.5]


def test_big_endian_cdr_is_read() -> None:
    data = bytes.fromhex("00000000") + struct.pack(">iIIH", 5, 6, 0x01020304, 7)
    wire = Wire(data, "cdr", "test")
    assert wire.time_ns() == 5_000_000_006
    assert wire.u32() == 0x01020304
    assert wire.value("H") == 7


def test_cdr2_aligns_to_4_bytes() -> None:
    data = bytes.fromhex("00070000") + struct.pack("<Id", 1, 2.5)
    wire = Wire(data, "cdr", "test")
    assert wire.u32() == 1
    assert wire.doubles(1).tolist() == [2.5]


def test_ros1_has_no_padding() -> None:
    data = struct.pack("<IIII2sBd", 1, 5, 6, 2, b"/a", 3, 2.5)
    wire = Wire(data, "ros1", "test")
    assert wire.header() == (5_000_000_006, "a")
    assert wire.u8() == 3
    assert wire.doubles(1).tolist() == [2.5]


def test_message_that_ends_too_early_is_refused() -> None:
    with pytest.raises(DriveError, match="test: a string of 9 bytes begins at byte 4, but the mes"):
        Wire(struct.pack("<I", 9), "ros1", "test").string()
    with pytest.raises(DriveError, match="a list of 4294967295 values"):
        Wire(struct.pack("<I", 2**32 - 1), "ros1", "test").sequence(int, 1)


def test_message_without_the_header_of_cdr_is_refused() -> None:
    with pytest.raises(DriveError, match="begins with 05000000; expected the header of CDR"):
        Wire(struct.pack("<II", 5, 6), "cdr", "test")
    with pytest.raises(DriveError, match="begins with nothing"):
        Wire(b"", "cdr", "test")
