"""Cloud files of other people's programs, against independent parsing by hand."""

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.sources import DriveError, ScanOptions, parse_columns, use_scan_options
from placecell.sources.catalog import open_source
from placecell.sources.clouds import FolderOfClouds

REAL = Path(__file__).resolve().parents[5] / "shared" / "real"

pytestmark = [
    pytest.mark.recorded,
    pytest.mark.skipif(not REAL.is_dir(), reason="the real files are not in ../shared/real"),
]


def unpack_lzf(packed: bytes) -> bytes:
    """Decompress LZF, step by step as its specification says."""
    out, at = bytearray(), 0
    while at < len(packed):
        control = packed[at]
        at += 1
        if control < 32:
            out += packed[at : at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += packed[at]
            at += 1
        start = len(out) - ((control & 31) << 8) - packed[at] - 1
        at += 1
        for offset in range(length + 2):
            out.append(out[start + offset])
    return bytes(out)


def after(content: bytes, line: bytes) -> bytes:
    return content[content.index(line) + len(line) :]


def binary_pcd(point_bytes: int) -> Callable[[bytes], Float64]:
    """Return a reader of points whose first three values are float32 x, y and z."""

    def read(content: bytes) -> Float64:
        body = after(content, b"DATA binary\n")
        points = int(after(content, b"\nPOINTS ").split()[0])
        rows = range(0, points * point_bytes, point_bytes)
        return np.array([struct.unpack_from("<3f", body, row) for row in rows])

    return read


def compressed_pcd(content: bytes) -> Float64:
    body = after(content, b"DATA binary_compressed\n")
    packed, _ = struct.unpack_from("<II", body)
    points = int(after(content, b"\nPOINTS ").split()[0])
    plain = unpack_lzf(body[8 : 8 + packed])
    return np.frombuffer(plain, "<f4", 3 * points).reshape(3, points).T.astype(np.float64)


def ascii_pcd(content: bytes) -> Float64:
    rows = after(content, b"DATA ascii").decode().splitlines()[1:]
    return np.array([[float(word) for word in row.split()[:3]] for row in rows]).reshape(-1, 3)


def binary_ply(content: bytes) -> Float64:
    body = after(content, b"end_header\n")
    return np.array([row[:3] for row in struct.iter_unpack("<4f", body)])


def text(content: bytes) -> Float64:
    rows = content.decode().splitlines()[1:]
    return np.array([[float(word) for word in row.split(",")[:3]] for row in rows])


def columns(count: int) -> Callable[[bytes], Float64]:
    return lambda content: np.array([row[:3] for row in struct.iter_unpack(f"<{count}f", content)])


def las(content: bytes) -> Float64:
    """Read uncompressed LAS: scaled integers at the start of each point."""
    start, size = (
        struct.unpack_from("<I", content, 96)[0],
        struct.unpack_from("<H", content, 105)[0],
    )
    points = struct.unpack_from("<I", content, 107)[0]
    if content[25] >= 4:
        points = struct.unpack_from("<Q", content, 247)[0]
    scale, offset = struct.unpack_from("<3d", content, 131), struct.unpack_from("<3d", content, 155)
    rows = [struct.unpack_from("<3i", content, start + row * size) for row in range(points)]
    return np.asarray(np.array(rows) * scale + offset)


FILES: dict[str, tuple[int, Callable[[bytes], Float64]]] = {
    "velodyne_vlp16_decoded.pcd": (14_831, binary_pcd(32)),
    "hesai_xt32_decoded.pcd": (63_021, binary_pcd(12)),
    "velodyne_pcl_padded_underscore.pcd": (64_545, binary_pcd(32)),
    "ndt_mapping_lidar_bincompressed_double_time.pcd": (24_796, compressed_pcd),
    "pcl_room_scan2.pcd": (112_624, compressed_pcd),
    "pcl_capture0001_organised_nan.pcd": (307_200, compressed_pcd),
    "pcl_lamppost.pcd": (1771, ascii_pcd),
    "pypcd4_ascii_with_empty_points.pcd": (0, ascii_pcd),
    "pypcd4_ascii_multi_count.pcd": (8, ascii_pcd),
    "pypcd4_ascii_organized.pcd": (8, ascii_pcd),
    "pypcd4_ascii_with_underscore.pcd": (213, ascii_pcd),
    "pypcd4_binary.pcd": (213, binary_pcd(16)),
    "pypcd4_binary_compressed.pcd": (213, compressed_pcd),
    "pypcd4_binary_compressed_organized.pcd": (8, compressed_pcd),
    "vlp16_ascii_xyz_only.pcd": (16_363, ascii_pcd),
    "nebula_binary_xyz_pcl.pcd": (2, binary_pcd(12)),
    "semantickitti_4col_tiny.bin": (50, columns(4)),
    "waymo_kitti_format_6col.bin": (800, columns(6)),
    "gtsam_points_newer_college_raw_00.bin": (25_109, columns(3)),
    "laspy_autzen_geo_proj.las": (106, las),
    "laspy_simple.las": (1065, las),
    "laspy_test1_4.las": (1000, las),
    "small_gicp_target_scan.ply": (69_088, binary_ply),
    "libpointmatcher_car_cloud400.csv": (24_989, text),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", list(FILES))
def test_points_are_those_of_an_independent_reader(name: str) -> None:
    count, reader = FILES[name]
    expected = reader((REAL / name).read_bytes())
    assert len(expected) == count
    source = open_source(REAL / name)
    assert isinstance(source, FolderOfClouds)
    scan = source.scan(0)
    assert scan.read == count
    usable = np.isfinite(expected).all(axis=1) & (expected != 0).any(axis=1)
    assert scan.not_finite + scan.zeros == count - int(usable.sum())
    shift = source.shift if source.shift is not None else np.zeros(3)
    np.testing.assert_array_equal(scan.points, (expected[usable] - shift).astype(np.float32))


def test_the_compressed_copy_of_a_las_file_has_the_same_points() -> None:
    plain, packed = (open_source(REAL / f"laspy_simple.{suffix}") for suffix in ("las", "laz"))
    np.testing.assert_array_equal(plain.scan(0).points, packed.scan(0).points)
    assert "(637300, 851300, 400) m is subtracted" in " ".join(packed.notes())


def test_odd_files_are_told() -> None:
    source = open_source(REAL / "pcl_capture0001_organised_nan.pcd")
    assert source.scan(0).not_finite == 57_553
    assert any("VIEWPOINT 0 0 0 0 1 0 0" in note for note in source.notes())
    assert any("bytes after the compressed block" in note for note in source.notes())


def test_times_of_points_are_found_or_not_believed() -> None:
    times = open_source(REAL / "velodyne_vlp16_decoded.pcd").scan(0).times
    assert times is not None
    body = after((REAL / "velodyne_vlp16_decoded.pcd").read_bytes(), b"DATA binary\n")
    raw = [struct.unpack_from("<I", body, row + 28)[0] for row in range(0, 14_831 * 32, 32)]
    np.testing.assert_allclose(times, np.array(raw) * 1e-9)  # firing times of one packet, 1.3 ms
    for name in (
        "ndt_mapping_lidar_bincompressed_double_time.pcd",  # all 0
        "waymo_kitti_format_6col.bin",  # 1.5e15 as float32: all the same
        "hesai_xt32_decoded.pcd",  # no field
    ):
        assert open_source(REAL / name).scan(0).times is None


def test_times_apart_from_the_points_are_read(tmp_path: Path) -> None:
    for kind in ("raw", "times"):
        content = (REAL / f"gtsam_points_newer_college_{kind}_00.bin").read_bytes()
        name = "points" if kind == "raw" else kind
        (tmp_path / f"{name}_00.bin").write_bytes(content)
    times = FolderOfClouds(tmp_path).scan(0).times
    assert times is not None
    expected = np.frombuffer((tmp_path / "times_00.bin").read_bytes(), "<f4")
    np.testing.assert_allclose(times, expected, atol=1e-7)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("pypcd4_ascii_invalid_header.pcd", "without a line DATA"),
        ("lyft_5col_tiny.bin", "State the layout with --columns"),
        ("freiburg1_xyz-ORB_kf_mono.txt", "is a trajectory, not a point cloud"),
        ("V102_groundtruth.csv", "is a trajectory, not a point cloud"),
        ("KITTI_00_gt.txt", "is a trajectory, not a point cloud"),
        ("KITTI_00_gt_times.txt", "has 1 column; expected x, y and z"),
        ("gtsam_points_newer_college_times_00.bin", "State it with --order columns"),
        ("README.md", "is no source of scans"),
    ],
)
def test_files_that_are_no_clouds_are_refused(name: str, expected: str) -> None:
    with pytest.raises(DriveError) as error:
        open_source(REAL / name)
    assert str(error.value).startswith(f"{REAL / name}: ")
    assert expected in str(error.value)


def test_a_stated_layout_reads_a_tiny_file() -> None:
    with use_scan_options(ScanOptions(columns=parse_columns("x,y,z,intensity,ring"))):
        scan = open_source(REAL / "lyft_5col_tiny.bin").scan(0)
    expected = columns(5)((REAL / "lyft_5col_tiny.bin").read_bytes())
    np.testing.assert_array_equal(scan.points, expected.astype(np.float32))
