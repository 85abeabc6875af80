import struct
from pathlib import Path

import numpy as np
import pytest

from placecell.sources.clouds.formats import ReadOptions, read_cloud
from tests.placecell.sources.clouds.writers import (
    POINTS,
    check_refused,
    lzf_literal,
    pcd,
    pcd_header,
    read,
)

XYZ = [("x", "F", 4, 1), ("y", "F", 4, 1), ("z", "F", 4, 1)]
ENCODINGS = ["ascii", "binary", "binary_compressed"]


def write(folder: Path, content: bytes) -> Path:
    file = folder / "cloud.pcd"
    file.write_bytes(content)
    return file


@pytest.mark.parametrize("data", ENCODINGS)
def test_each_encoding_gives_the_points(tmp_path: Path, data: str) -> None:
    scan = read(write(tmp_path, pcd(XYZ, POINTS.tolist(), data)))
    np.testing.assert_array_equal(scan.points, POINTS)
    assert scan.points.dtype == np.float32
    assert scan.times is None


@pytest.mark.parametrize("data", ENCODINGS)
def test_any_order_size_count_and_padding_of_fields_is_read(tmp_path: Path, data: str) -> None:
    fields = [
        ("_", "U", 1, 3), ("z", "F", 8, 1), ("normal", "F", 4, 3), ("y", "I", 4, 1),
        ("t", "U", 4, 1), ("x", "F", 4, 1), ("_", "U", 1, 5),
    ]  # fmt: skip
    rows = [
        [9, 9, 9, 0.5, 1, 2, 3, -4, time, 1.5, *[7] * 5] for time in (0, 50_000_000, 100_000_000)
    ]
    file = write(tmp_path, pcd(fields, rows, data))
    scan = read(file)
    np.testing.assert_array_equal(scan.points, [[1.5, -4.0, 0.5]] * 3)
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, [0, 0.05, 0.1], atol=1e-12)
    assert read_cloud(file, ReadOptions()).fields == ("_", "z", "normal", "y", "t", "x", "_")


def test_compressed_data_without_their_padding_are_read(tmp_path: Path) -> None:
    """PCL leaves the fields `_` out when it compresses, also if the header names them."""
    padded = pcd_header([XYZ[0], ("_", "U", 1, 4), *XYZ[1:]], 3, "binary_compressed")
    body = pcd(XYZ, POINTS.tolist(), "binary_compressed").split(b"DATA binary_compressed\n")[1]
    np.testing.assert_array_equal(read(write(tmp_path, padded + body)).points, POINTS)


def test_windows_line_ends_and_odd_spaces_are_read(tmp_path: Path) -> None:
    content = pcd(XYZ, POINTS.tolist(), "ascii").replace(b"\n", b"\r\n")
    content = content.replace(b"1.5 -2.25", b"  1.5\t -2.25 ").replace(b"3 4", b"\r\n3  4")
    np.testing.assert_array_equal(read(write(tmp_path, content)).points, POINTS)


@pytest.mark.parametrize(
    "lines",
    [
        {"VERSION": ".7"},
        {"VERSION": ""},
        {"COUNT": "", "VIEWPOINT": ""},
        {"SIZE": "", "TYPE": ""},
        {"POINTS": ""},
        {"WIDTH": "", "HEIGHT": ""},
        {"HEIGHT": ""},
        {"TYPE": "f f f"},
        {"VIEWPOINT": "0 0"},
        {"VIEWPOINT": "a b c d e f g"},
    ],
)
@pytest.mark.parametrize("data", ENCODINGS)
def test_missing_and_old_header_lines_have_defaults(
    tmp_path: Path, lines: dict[str, str], data: str
) -> None:
    content = pcd(XYZ, POINTS.tolist(), data, **lines)
    np.testing.assert_array_equal(read(write(tmp_path, content)).points, POINTS)


def test_columns_is_an_old_name_of_fields(tmp_path: Path) -> None:
    content = pcd(XYZ, POINTS.tolist(), "binary").replace(b"FIELDS", b"COLUMNS")
    np.testing.assert_array_equal(read(write(tmp_path, content)).points, POINTS)


def test_organized_clouds_drop_nan_points_with_their_times(tmp_path: Path) -> None:
    rows = [[1, 2, 3, 0.0], [np.nan, np.nan, np.nan, 0.05], [0, 0, 0, 0.07], [4, 5, 6, 0.1]]
    fields = [*XYZ, ("time", "F", 4, 1)]
    for data in ENCODINGS:
        scan = read(write(tmp_path, pcd(fields, rows, data, WIDTH="2", HEIGHT="2")))
        np.testing.assert_array_equal(scan.points, [[1, 2, 3], [4, 5, 6]])
        assert scan.times is not None
        np.testing.assert_allclose(scan.times, [0, 0.1], atol=1e-7)
        assert (scan.read, scan.not_finite, scan.zeros) == (4, 1, 1)


def test_nan_in_a_field_of_integers_is_read(tmp_path: Path) -> None:
    fields = [*XYZ, ("ring", "U", 2, 1)]
    content = pcd_header(fields, 1, "ascii") + b"1 2 3 nan\n"
    np.testing.assert_array_equal(read(write(tmp_path, content)).points, [[1, 2, 3]])


@pytest.mark.parametrize("data", ENCODINGS)
def test_zero_points_are_an_empty_scan(tmp_path: Path, data: str) -> None:
    scan = read(write(tmp_path, pcd_header(XYZ, 0, data, HEIGHT="0")))
    assert scan.points.shape == (0, 3)


def test_one_point_is_read(tmp_path: Path) -> None:
    for data in ENCODINGS:
        content = pcd(XYZ, POINTS[:1].tolist(), data)
        np.testing.assert_array_equal(read(write(tmp_path, content)).points, POINTS[:1])


@pytest.mark.parametrize("data", ENCODINGS)
def test_bytes_after_the_points_are_ignored(tmp_path: Path, data: str) -> None:
    content = pcd(XYZ, POINTS.tolist(), data) + (b"" if data == "ascii" else b"\0" * 4000)
    np.testing.assert_array_equal(read(write(tmp_path, content)).points, POINTS)


@pytest.mark.parametrize("data", ENCODINGS)
@pytest.mark.parametrize("lines", [{"WIDTH": "2"}, {"WIDTH": "9"}, {"POINTS": "7"}])
def test_a_width_that_contradicts_the_points_is_told(
    tmp_path: Path, data: str, lines: dict[str, str]
) -> None:
    file = write(tmp_path, pcd(XYZ, POINTS.tolist(), data, **lines))
    np.testing.assert_array_equal(read(file).points, POINTS)
    if data != "binary_compressed":
        assert "WIDTH x HEIGHT" in read_cloud(file, ReadOptions()).remarks[0]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"# .PCD v.7\nVERSION .7\nFIEL", "without a line DATA"),
        (b"VERSION 0.7\n" * 10_000, "without a line DATA"),
        (b"# .PCD v.7\n\xff\xfe\x80 \x91\nVERSION .7\n", "ends after VERSION, without a line DATA"),
        (b"# .PCD v.7\n\xff\xfe\x80 \x91\n", "a PCD header without a line DATA"),
        (pcd_header([], 3, "ascii"), "names 0 fields"),
        (pcd_header(XYZ, 3, "ascii", SIZE="4 4"), "SIZE, TYPE or COUNT"),
        (pcd_header(XYZ, 3, "ascii", SIZE="4 4 3"), "type F of 3 bytes"),
        (pcd_header(XYZ, 3, "ascii", COUNT="1 1 0"), "SIZE, TYPE or COUNT"),
        (pcd_header(XYZ, 3, "ascii", POINTS="-3"), "'-3'; expected a whole number"),
        (pcd_header(XYZ, 3, "ascii", POINTS="", WIDTH=""), "neither POINTS nor WIDTH"),
        (pcd_header(XYZ, 3, "zip"), "DATA 'zip'"),
        (pcd_header(XYZ[:2], 3, "ascii") + b"1 2\n" * 3, "no x, y and z; the fields are x, y"),
        (pcd(XYZ, POINTS.tolist(), "ascii")[:-15], "cut short: the header states 3 rows"),
        (pcd(XYZ, POINTS.tolist(), "binary")[:-1], "cut short: the header states 3 points"),
        (pcd(XYZ, POINTS.tolist(), "binary_compressed")[:-1], "cut short"),
        (pcd_header(XYZ, 3, "binary_compressed") + b"12", "cut short"),
        (pcd_header(XYZ, 10**12, "binary") + b"12", "1,000,000,000,000 points"),
        (pcd_header(XYZ, 10**12, "ascii") + b"1 2 3", "1,000,000,000,000 rows"),
        (pcd_header(XYZ, 2, "ascii") + b"1 2 3\n1 2 x\n", "cannot be decoded"),
        (pcd_header(XYZ, 2, "ascii") + b"1 2 3\n1 2\n", "cannot be decoded"),
        (
            pcd_header(XYZ, 3, "binary_compressed") + struct.pack("<II", 4, 36) + b"\x7f\x7f12",
            "cannot be decoded",
        ),
        (
            pcd_header(XYZ, 10**9, "binary_compressed")
            + struct.pack("<II", 4, 12 * 10**9 % 2**32)
            + b"1234",
            "the file is damaged",
        ),
        (
            pcd_header(XYZ, 10**7, "binary_compressed") + struct.pack("<II", 4, 12 * 10**7) + b"12",
            "cut short",
        ),
        (
            pcd_header(XYZ, 10**7, "binary_compressed") + struct.pack("<II", 2, 12 * 10**7) + b"12",
            "claim to become 120,000,000",
        ),
        (
            pcd_header(XYZ, 3, "binary_compressed")
            + struct.pack("<II", 13, 12)
            + lzf_literal(b"1" * 12),
            "3 points have 36",
        ),
        (b"", "0 bytes"),
    ],
)  # fmt: skip
def test_a_damaged_file_is_named_with_what_is_wrong(
    tmp_path: Path, content: bytes, expected: str
) -> None:
    check_refused(write(tmp_path, content), expected)
