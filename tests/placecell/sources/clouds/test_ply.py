from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.sources.clouds.formats import ReadOptions, read_cloud
from tests.placecell.sources.clouds.writers import POINTS, check_refused, ply, read

ENCODINGS = ["ascii", "binary_little_endian", "binary_big_endian"]
XYZ = ["float x", "float y", "float z"]
ROWS = POINTS.tolist()


def write(folder: Path, content: bytes) -> Path:
    file = folder / "cloud.ply"
    file.write_bytes(content)
    return file


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_each_encoding_and_line_end_gives_the_points(
    tmp_path: Path, encoding: str, newline: str
) -> None:
    scan = read(write(tmp_path, ply(encoding, XYZ, ROWS, newline)))
    np.testing.assert_array_equal(scan.points, POINTS)
    assert scan.points.dtype == np.float32


def test_line_ends_of_old_macs_are_read(tmp_path: Path) -> None:
    np.testing.assert_array_equal(read(write(tmp_path, ply("ascii", XYZ, ROWS, "\r"))).points, ROWS)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_any_order_and_type_of_properties_is_read(tmp_path: Path, encoding: str) -> None:
    properties = ["uchar red", "double Z", "short y", "uint scalar_t", "float64 x", "char last"]
    rows: list[list[Any]] = [[255, 0.5, -4, time, 1.5, -1] for time in (0, 50_000_000, 100_000_000)]
    file = write(tmp_path, ply(encoding, properties, rows))
    scan = read(file)
    np.testing.assert_array_equal(scan.points, [[1.5, -4, 0.5]] * 3)
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, [0, 0.05, 0.1], atol=1e-12)
    assert read_cloud(file, ReadOptions()).fields[:2] == ("red", "Z")


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_lists_of_a_point_are_skipped(tmp_path: Path, encoding: str) -> None:
    properties = ["float x", "list uchar int views", "float y", "float z"]
    lengths = [0, 3, 1]
    rows: list[list[Any]] = [
        [x, [7] * count, y, z] for (x, y, z), count in zip(ROWS, lengths, strict=True)
    ]
    file = write(tmp_path, ply(encoding, properties, rows))
    np.testing.assert_array_equal(read(file).points, POINTS)
    rows = [[x, y, z, [7] * count] for (x, y, z), count in zip(ROWS, lengths, strict=True)]
    file = write(tmp_path, ply(encoding, [*XYZ, "list uchar int views"], rows))
    np.testing.assert_array_equal(read(file).points, POINTS)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_elements_before_and_after_the_points_are_skipped(tmp_path: Path, encoding: str) -> None:
    before = (
        "element camera 2\nproperty uchar id\nelement face 2\n"
        "property list uchar uchar vertex_indices\nelement nothing 1000000000000"
    )
    body = b"7\n8\n3 0 1 2\n0\n" if encoding == "ascii" else bytes([7, 8, 3, 0, 1, 2, 0])
    after = "element user 5\nproperty float weight"
    file = write(tmp_path, ply(encoding, XYZ, ROWS, "\n", before, body, after))
    np.testing.assert_array_equal(read(file).points, POINTS)
    assert "ignored: camera, face, nothing, user" in read_cloud(file, ReadOptions()).remarks[0]


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_no_points_are_an_empty_scan(tmp_path: Path, encoding: str) -> None:
    assert read(write(tmp_path, ply(encoding, XYZ, []))).points.shape == (0, 3)


def test_nan_and_zero_points_are_dropped_and_counted(tmp_path: Path) -> None:
    rows: list[list[float]] = [[1, 2, 3], [float("nan"), 1, 1], [0, 0, 0]]
    for encoding in ENCODINGS:
        scan = read(write(tmp_path, ply(encoding, XYZ, rows)))
        np.testing.assert_array_equal(scan.points, [[1, 2, 3]])
        assert (scan.read, scan.not_finite, scan.zeros) == (3, 1, 1)


LITTLE = "binary_little_endian"
HEAD = b"ply\nformat %s 1.0\n"


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"ply\nformat ascii 1.0\nelement vertex 3", "no line end_header"),
        (b"ply\n" + b"comment\n" * 20_000 + b"end_header\n", "no line end_header"),
        (b"ply\nformat ascii 1.0\nelement face 1\nend_header\n", "no element 'vertex'"),
        (b"ply\nformat binary 1.0\nend_header\n", "format 'binary'"),
        (b"ply\nproperty float x\nend_header\n", "'property float x' that is not understood"),
        (b"ply\nelement vertex -1\nend_header\n", "not understood"),
        (b"ply\nelement vertex many\nend_header\n", "not understood"),
        (b"ply\nelement vertex 1\nproperty half x\nend_header\n", "not understood"),
        (b"ply\nelement v 1\nproperty list float int x\nend_header\n", "not understood"),
        (b"ply\nelement v 1\n" + b"property char x\n" * 1100 + b"end_header\n", "not understood"),
        (ply("ascii", XYZ[:2], []), "no x, y and z; the fields are x, y"),
        (ply("ascii", [*XYZ[:2], "list uchar int z"], []), "'z' of its points is a list"),
        (ply("ascii", XYZ, ROWS)[:-18], "states 3 points, but the file has 2"),
        (ply(LITTLE, XYZ, ROWS)[:-1], "states 3 points, but the file has 2"),
        (ply("ascii", XYZ, [[1, 2, "x"]]), "a row of its ascii points cannot be read"),
        (ply("ascii", XYZ, [[1, 2, 3], [4, 5]]), "cannot be read"),
        (ply("ascii", ["list uchar int n", *XYZ], [[-3, 1, 2, 3]]), "cannot be read"),
        (ply("ascii", ["list uchar int n", *XYZ], [[300, 1, 2, 3]]), "cannot be read"),
        (ply(LITTLE, ["list uchar int n", *XYZ], [[[1, 2], 1, 2, 3]])[:-3], "cut short"),
        (
            ply(LITTLE, [*XYZ, "list uchar int n"], [[1, 2, 3, [1, 2]]])[:-3],
            "beyond the file's end",
        ),
        (
            ply(LITTLE, XYZ, ROWS).replace(b"vertex 3", b"vertex 1000000000000"),
            "1,000,000,000,000 points",
        ),
        (
            ply("ascii", XYZ, ROWS).replace(b"vertex 3", b"vertex 1000000000000"),
            "1,000,000,000,000 points",
        ),
        (
            ply(LITTLE, XYZ, ROWS, before="element face 999999\nproperty list uint int i"),
            "cut short: the header states 999,999 rows of face",
        ),
        (
            ply(LITTLE, XYZ, ROWS, before="element face 1\nproperty list uint int i"),
            "a list 'i' of 1,069,547,520 values reaches beyond",
        ),
    ],
)
def test_a_damaged_file_is_named_with_what_is_wrong(
    tmp_path: Path, content: bytes, expected: str
) -> None:
    check_refused(write(tmp_path, content), expected)
