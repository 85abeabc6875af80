import struct
from pathlib import Path

import numpy as np
import pytest

from placecell.sources.clouds.cloud import as_scan
from placecell.sources.clouds.formats import ReadOptions, read_cloud
from tests.placecell.sources.clouds.writers import POINTS, check_refused, las, read

CLOUD = np.random.default_rng(3).normal(0, 20, (5000, 3))


def changed(content: bytes, offset: int, code: str, value: float) -> bytes:
    """Return a file with a value of the header replaced."""
    packed = struct.pack(f"<{code}", value)
    return content[:offset] + packed + content[offset + len(packed) :]


PLAIN, PACKED, LONG = las(CLOUD), las(CLOUD, True), las(CLOUD, True, 4, 6)
START = struct.unpack_from("<I", PACKED, 96)[0]
LONG_START = struct.unpack_from("<I", LONG, 96)[0]
TABLE = struct.unpack_from("<q", PACKED, START)[0]


def write(folder: Path, content: bytes) -> Path:
    file = folder / "cloud.laz"
    file.write_bytes(content)
    return file


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize(("minor", "point_format"), [(2, 0), (2, 3), (3, 1), (4, 6), (4, 7)])
def test_each_version_gives_the_points(
    tmp_path: Path, compressed: bool, minor: int, point_format: int
) -> None:
    scan = read(write(tmp_path, las(CLOUD, compressed, minor, point_format)))
    np.testing.assert_allclose(scan.points, CLOUD, atol=5.1e-4)
    assert scan.points.dtype == np.float32


@pytest.mark.parametrize("compressed", [False, True])
def test_large_coordinates_keep_their_digits(tmp_path: Path, compressed: bool) -> None:
    far = np.array([691_234.5, 5_334_567.25, 512.0])
    file = write(tmp_path, las(POINTS + far, compressed))
    scan, shift = as_scan(read_cloud(file, ReadOptions()), file)
    np.testing.assert_array_equal(shift, [691_200, 5_334_600, 500])
    np.testing.assert_allclose(scan.points + shift, POINTS + far, atol=5.1e-4)


def test_gps_times_of_one_sweep_are_relative(tmp_path: Path) -> None:
    times = [300_000.0, 300_000.05, 300_000.1]
    scan = read(write(tmp_path, las(POINTS, times=times)))
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, [0, 0.05, 0.1], atol=1e-9)
    assert read(write(tmp_path, las(POINTS, times=[1.0, 100.0, 200.0]))).times is None


def test_fields_are_named(tmp_path: Path) -> None:
    cloud = read_cloud(write(tmp_path, las(POINTS)), ReadOptions())
    assert cloud.fields[:4] == ("x", "y", "z", "intensity")
    assert cloud.fields[-1] == "gps_time"


def test_names_that_are_not_utf_8_are_read(tmp_path: Path) -> None:
    """Programs write Latin-1, which laspy refuses in the name of a record's user."""
    content = las(POINTS).replace(b"OTHER", b"M\xfcnch")
    np.testing.assert_allclose(read(write(tmp_path, content)).points, POINTS, atol=5.1e-4)
    user = b"\0\0laszip encoded"
    record = b"\0\0M\xfcller" + bytes(46)  # a record without content, before the one of LAZ
    packed = changed(PACKED, 96, "I", START + len(record))
    packed = changed(packed, 100, "I", 2).replace(user, record + user)
    packed = changed(packed, START + len(record), "q", TABLE + len(record))
    assert len(read(write(tmp_path, packed)).points) == len(CLOUD)


@pytest.mark.parametrize("compressed", [False, True])
def test_zero_points_are_an_empty_scan(tmp_path: Path, compressed: bool) -> None:
    assert read(write(tmp_path, las(np.zeros((0, 3)), compressed))).points.shape == (0, 3)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (PLAIN[:100], "states 227 bytes of header"),
        (PLAIN[:-1], "states 5,000 points, but the file has 4,999"),
        (changed(PLAIN, 107, "I", 2**32 - 1), "states 4,294,967,295 points"),
        (changed(PACKED, 107, "I", 2**32 - 1), "over 100 times as many"),
        (changed(LONG, 247, "Q", 10**12), "over 100 times as many"),
        (changed(PACKED, 107, "I", 60_000), "cannot be decoded"),
        (LONG[:300], "states 375 bytes of header"),
        (changed(PLAIN, 100, "I", 2**32 - 1), "states 4,294,967,295 records"),
        (changed(PLAIN, 96, "I", 2**31), "points from byte 2,147,483,648"),
        (changed(PLAIN, 105, "H", 1), "points of 1 bytes"),
        (changed(PLAIN, 24, "B", 2), "is LAS version 2.2"),
        (changed(PLAIN, 25, "B", 9), "is LAS version 1.9"),
        (changed(PLAIN, 104, "B", 99), "cannot be decoded"),
        (changed(PACKED, START, "q", 2**60), "table of compressed chunks lies at byte"),
        (changed(PACKED, START, "q", -1), "table of compressed chunks lies at byte"),
        (changed(PACKED, TABLE + 4, "I", 2**32 - 1), "more chunks than points"),
        (PACKED.replace(b"laszip encoded", b"something else"), "cannot be decoded"),
        (changed(PACKED, START - 14, "H", 0), "names parts of 0 bytes, but a point has 28"),
        (changed(PACKED, 247, "H", 60_000), "1 LAS records reach beyond its first point"),
        (changed(PACKED, START - 10, "H", 21), "names parts of 29 bytes"),
        (
            changed(LONG, LONG_START + 8 + 30 + 4, "I", 2**32 - 1),
            "a compressed chunk reaches beyond",
        ),
        (changed(LONG, LONG_START + 8 + 30, "I", 0), "a compressed chunk reaches beyond"),
        (PACKED[:-500], "cut short or damaged"),
        (PACKED[: START + 4], "cut short or damaged"),
    ],
)
def test_a_damaged_file_is_named_with_what_is_wrong(
    tmp_path: Path, content: bytes, expected: str
) -> None:
    check_refused(write(tmp_path, content), expected)
