"""Uploaded point cloud files: all formats by content, and bounds for hostile ones."""

import struct
import time
import zipfile
from collections.abc import Callable
from io import BytesIO

import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from service.clouds.uploaded_cloud import read_uploaded_cloud
from service.core.problems import Problem
from tests.placecell.sources.clouds.writers import las, pcd, pcd_header, ply
from tests.placecell.sources.mutations import bounded
from tests.service.clouds.scan_files import FIELDS, KINDS, scan_file, yard_scan

STEP = 0.4
SCAN = yard_scan(step=STEP)
MOST = 100_000
MEMORY = 96 << 20
"""Memory that a refused file may take, bytes; the files claim gigabytes."""


def problem_of(content: bytes, name: str, most: int = MOST) -> Problem:
    with bounded(MEMORY), pytest.raises(Problem) as raised:
        read_uploaded_cloud(content, name, most)
    return raised.value


@pytest.mark.parametrize("kind", list(KINDS))
def test_file_of_each_format_is_read(kind: str) -> None:
    format_name, suffix, content = scan_file(kind, STEP)
    cloud = read_uploaded_cloud(content, f"scan{suffix}", MOST)
    assert cloud.format == format_name
    assert cloud.scan.read == len(SCAN)
    np.testing.assert_allclose(cloud.scan.points, SCAN, atol=1e-3)
    assert not cloud.shift.any()


@pytest.mark.parametrize("name", ["", "..", "scan", "scan.dat2", "a/b/", "../../etc/passwd"])
@pytest.mark.parametrize("kind", ["pcd", "ply", "laz", "npy", "npz", "xyz"])
def test_content_tells_the_format_without_an_ending(kind: str, name: str) -> None:
    format_name, _, content = scan_file(kind, STEP)
    assert read_uploaded_cloud(content, name, MOST).format == format_name


def test_content_overrides_a_wrong_ending() -> None:
    assert read_uploaded_cloud(scan_file("ply", STEP)[2], "scan.pcd", MOST).format == "PLY"
    assert read_uploaded_cloud(scan_file("pcd", STEP)[2], "scan.csv", MOST).format == "PCD"


def test_other_files_are_refused_with_the_formats() -> None:
    for content in (b"\x89MCAP0\r\n" + bytes(100), b"\x7fELF" + bytes(2000), bytes(4000)):
        problem = problem_of(content, "scan.mcap")
        assert (problem.status, problem.kind) == (415, "unsupported-cloud-file")
        assert problem.detail.startswith("scan.mcap: is no point cloud")
        assert "PCD, PLY, LAS" in problem.detail
    assert problem_of(b"", "scan.pcd").kind == "invalid-cloud-file"
    damaged = problem_of(b"# .PCD v0.7\nVERSION 0.7\n", "my.pcd")
    assert (damaged.status, damaged.kind) == (422, "invalid-cloud-file")
    assert damaged.detail.startswith("my.pcd: its PCD header ends")


def test_problem_shows_the_given_name_without_folders_or_control_signs() -> None:
    problem = problem_of(b"VERSION 1\n", "C:\\scans\\..\\a\x1b[31m<b>.pcd")
    assert problem.detail.startswith("a?[31m<b>.pcd: ")
    assert problem.detail.isprintable()


def test_problem_names_no_option_of_the_command_line() -> None:
    values = np.random.default_rng(0).normal(0, 20_000, (3000, 4)).astype("<f4")
    problem = problem_of(values.tobytes(), "scan.bin")
    assert "--" not in problem.detail
    assert "Convert the file to PCD or PLY." in problem.detail


XYZ = FIELDS[:3]


def lzf_bomb() -> bytes:
    packed = b"\x00\x00" + b"\xe0\xff\x00" * 400_000
    points = 264 * 400_000 // 12
    header = pcd_header(XYZ, points, "binary_compressed")
    return header + struct.pack("<II", len(packed), 12 * points) + packed


def laz_of_many_points() -> bytes:
    content = bytearray(las(SCAN.astype(np.float64), True))
    struct.pack_into("<I", content, 107, 4_000_000_000)
    return bytes(content)


def zip_bomb() -> bytes:
    stream = BytesIO()
    header = {"descr": "<f4", "fortran_order": False, "shape": (40_000_000, 3)}
    with (
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("points.npy", "w") as file,
    ):
        np.lib.format.write_array_header_1_0(file, header)
        for _ in range(480):
            file.write(bytes(1_000_000))
    return stream.getvalue()


def zip_of_many_entries() -> bytes:
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for index in range(2000):
            archive.writestr(f"{index}.npy", b"")
    return stream.getvalue()


def wide_pcd() -> bytes:
    fields = [*XYZ, *((f"f{index}", "U", 1, 1_000_000) for index in range(9))]
    return pcd_header(fields, 1, "binary") + bytes(9_000_100)


BOMBS: dict[str, Callable[[], bytes]] = {
    "many.pcd": lambda: pcd_header(XYZ, 2**31 - 1, "binary") + bytes(1000),
    "compressed.pcd": lzf_bomb,
    "wide.pcd": wide_pcd,
    "words.pcd": lambda: pcd_header(XYZ, 9, "ascii") + b"1 " * 5_000_000,
    "many.ply": lambda: ply("binary_little_endian", ["float x", "float y", "float z"], []).replace(
        b"vertex 0", b"vertex 999999999999"
    ),
    "many.laz": laz_of_many_points,
    "zeros.npz": zip_bomb,
    "entries.npz": zip_of_many_entries,
    "lines.xyz": lambda: b"1 2 3\n" * (2 * MOST + 2000),
}
"""Small files that claim to be large, or become large when they are read."""


@pytest.mark.slow
@pytest.mark.parametrize("name", list(BOMBS))
def test_file_that_becomes_large_is_refused_before_it_is_decoded(name: str) -> None:
    content = BOMBS[name]()
    started = time.perf_counter()
    problem = problem_of(content, name)
    assert problem.status in {413, 422}
    assert problem.detail.startswith(f"{name}: ")
    assert time.perf_counter() - started < 5


@pytest.mark.parametrize("kind", list(KINDS))
def test_file_of_too_many_points_is_refused(kind: str) -> None:
    _, suffix, content = scan_file(kind, STEP)
    problem = problem_of(content, f"scan{suffix}", most=1000)
    assert (problem.status, problem.kind) == (413, "too-many-points")
    assert "1,000" in problem.detail


@pytest.mark.parametrize("kind", ["pcd ascii", "ply ascii", "csv", "xyz"])
def test_reading_text_stops_when_its_request_is_late(kind: str) -> None:
    _, suffix, content = scan_file(kind, STEP)
    token = CancelToken()
    token.cancel()
    with cancelled_by(token), pytest.raises(Cancelled):
        read_uploaded_cloud(content, f"scan{suffix}", MOST)


def test_ply_with_lists_stops_when_its_request_is_late() -> None:
    rows = [[*row, [1, 2]] for row in SCAN[:50].tolist()]
    content = ply(
        "binary_little_endian", ["float x", "float y", "float z", "list uchar int v"], rows
    )
    assert read_uploaded_cloud(content, "a.ply", MOST).scan.read == 50
    token = CancelToken()
    token.cancel()
    with cancelled_by(token), pytest.raises(Cancelled):
        read_uploaded_cloud(content, "a.ply", MOST)


def test_map_coordinates_are_shifted() -> None:
    far = SCAN.astype(np.float64) + [451_234.5, 5_412_345.5, 120.0]
    cloud = read_uploaded_cloud(las(far), "tile.las", MOST)
    np.testing.assert_allclose(cloud.scan.points + cloud.shift, far, atol=0.01)
    assert cloud.shift.any()


def test_pcd_of_one_compressed_field_is_read() -> None:
    content = pcd(FIELDS, [[1.0, 2.0, 3.0, 4]], "binary_compressed")
    assert read_uploaded_cloud(content, "scan.pcd", 1).scan.read == 1
