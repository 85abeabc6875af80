"""B4: the layout of scans without a header is found from their content, or they are refused."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import placecell
from placecell.core.types import Float32, Float64
from placecell.datasets import DriveError, ScanOptions, open_drive, parse_columns, use_scan_options
from placecell.sources.point_layout import PointLayout, find_layout
from tests.placecell.segment_builders import pose, write_odometry

REAL = Path(placecell.__file__).resolve().parents[2] / "shared" / "real"


def turning_scan(beams: int, steps: int, seed: int) -> Float32:
    """Return a scan of walls, a street and dropouts at 0, beam by beam: x, y, z, reflectance."""
    random = np.random.default_rng(seed)
    azimuth = np.tile(np.linspace(-np.pi, np.pi, steps, endpoint=False), beams)
    elevation = np.repeat(np.radians(np.linspace(-24, 2, beams)), steps)
    wall = 8 / np.maximum(np.abs(np.cos(azimuth)), 0.15) * random.uniform(0.97, 1.03, len(azimuth))
    ground = np.where(elevation < -0.01, 1.7 / np.maximum(-np.sin(elevation), 1e-3), np.inf)
    ranges = np.minimum(np.minimum(wall, ground), 100.0)
    directions = np.stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ],
        axis=1,
    )
    points = ranges[:, None] * directions
    points[random.random(len(points)) < 0.03] = 0.0
    return np.column_stack([points, random.random(len(points)) ** 2]).astype(np.float32)


SENSORS = {"16 beams": (16, 120), "64 beams": (64, 300), "solid": (40, 60)}


@pytest.fixture(params=SENSORS, ids=str)
def scans(request: pytest.FixtureRequest) -> list[Float32]:
    beams, steps = SENSORS[request.param]
    # No two scans are of one size, as of a sensor whose returns are sometimes lost.
    return [turning_scan(beams, steps, seed)[seed * 7 :] for seed in range(4)]


def ring(scan: Float32) -> Float64:
    return np.floor(np.arange(len(scan)) * 16 / len(scan))


def written(folder: Path, scans: list[Float32], change: Callable[[Float32], object]) -> list[Path]:
    folder.mkdir(exist_ok=True)
    files = []
    for number, scan in enumerate(scans):
        files.append(folder / f"{number:06d}.bin")
        np.ascontiguousarray(change(scan)).tofile(files[-1])
    return files


def found(files: list[Path], options: ScanOptions | None = None) -> PointLayout:
    sizes = [file.stat().st_size for file in files]
    return find_layout(files, sizes, options or ScanOptions())


def f4(*columns: object) -> Float32:
    return np.column_stack(columns).astype("<f4")  # type: ignore[arg-type]


KINDS: dict[str, tuple[Callable[[Float32], object], int, str]] = {
    "four": (lambda s: s, 4, "float32"),
    "reflectance 0": (lambda s: s * [1, 1, 1, 0], 4, "float64"),
    "reflectance to 255": (lambda s: f4(s[:, :3], np.round(s[:, 3] * 255)), 4, "float32"),
    "half of it NaN": (lambda s: np.where(np.arange(len(s))[:, None] % 2, s, np.nan), 4, "float32"),
    "shuffled": (lambda s: np.random.default_rng(1).permutation(s), 4, "float32"),
    "three": (lambda s: s[:, :3], 3, "float32"),
    "three shuffled": (lambda s: np.random.default_rng(1).permutation(s)[:, :3], 3, "float32"),
    "five": (lambda s: f4(s, ring(s)), 5, "float32"),
    "six": (lambda s: f4(s, np.arange(len(s)) * 1e-6, ring(s)), 6, "float32"),
    "six, a time of 1e15": (lambda s: f4(s, s[:, 3] * 3, np.full(len(s), 1.55e15)), 6, "float32"),
    "four doubles": (lambda s: s.astype("<f8") * 1.000000123, 4, "float64"),
    "five doubles": (lambda s: np.column_stack([s.astype("<f8") / 3, ring(s)]), 5, "float64"),
    "three doubles": (lambda s: s[:, :3].astype("<f8"), 3, "float64"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_B4_columns_and_type_are_found_from_content(
    kind: str, scans: list[Float32], tmp_path: Path
) -> None:
    change, columns, dtype = KINDS[kind]
    layout = found(written(tmp_path, scans, change))
    assert (len(layout.columns), layout.dtype) == (columns, dtype)
    points = layout.read(tmp_path / "000000.bin")
    assert points.dtype == np.float32
    assert points.shape == (len(scans[0]), 3)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda s: s.T, "column after column"),
        (lambda s: s[:, :3].T, "column after column"),
        (lambda s: s.astype(">f4"), "not coordinates"),
        (lambda s: (s * 100).astype("<i2"), "not coordinates"),
        (lambda s: s * np.array([1000, 1000, 1000, 1], np.float32), "millimeters"),
        (lambda s: s + np.array([450_000, 5_400_000, 0, 0], np.float32), "map's frame"),
        (lambda s: f4(ring(s), s[:, :3]), "column 1 holds whole numbers"),
    ],
    ids=["columns", "3 columns", "big-endian", "int16", "mm", "map frame", "ring first"],
)
def test_B4_uncertain_layout_is_refused_with_the_findings(
    change: Callable[[Float32], object], said: str, scans: list[Float32], tmp_path: Path
) -> None:
    with pytest.raises(DriveError) as caught:
        found(written(tmp_path, scans, change))
    assert said in str(caught.value)
    assert "--" in str(caught.value) or "Convert" in str(caught.value)


@pytest.mark.slow
def test_B4_stated_layout_is_used(scans: list[Float32], tmp_path: Path) -> None:
    files = written(
        tmp_path, scans, lambda s: f4(ring(s), s).astype("<f8").T * [[1], *[[1000]] * 4]
    )
    options = ScanOptions(
        columns=parse_columns("ring,x,y,z,intensity"), dtype="float64", order="columns", unit="mm"
    )
    points = found(files, options).read(files[1])
    assert points == pytest.approx(scans[1][:, :3], rel=1e-5)
    with pytest.raises(DriveError, match="does not fit"):
        found(files, ScanOptions(columns=parse_columns("7")))


@pytest.mark.parametrize("text", ["2", "x,y", "x,y,z,z", "x,y,z,,i", "65"])
def test_B4_impossible_columns_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="--columns"):
        parse_columns(text)


def test_B4_few_points_get_the_kitti_layout_if_it_fits(tmp_path: Path) -> None:
    few = [turning_scan(4, 3, seed) for seed in range(2)]
    assert len(found(written(tmp_path, few, lambda s: s)).columns) == 4
    with pytest.raises(DriveError, match=r"fit 5 columns of float32.*too few"):
        found(written(tmp_path, few, lambda s: f4(s, ring(s))[:5]))


REAL_FILES = {
    "semantickitti_4col_tiny.bin": 4,
    "waymo_kitti_format_6col.bin": 6,
    "gtsam_points_newer_college_raw_00.bin": 3,
}


@pytest.mark.recorded
@pytest.mark.parametrize("name", REAL_FILES)
def test_B4_files_of_real_sensors(name: str) -> None:
    if not (REAL / name).is_file():
        pytest.skip(f"no {name}: files of real sensors are in no repository")
    assert len(found([REAL / name]).columns) == REAL_FILES[name]


@pytest.mark.recorded
def test_B4_six_real_points_of_five_columns_are_not_sure() -> None:
    file = REAL / "lyft_5col_tiny.bin"
    if not file.is_file():
        pytest.skip("no lyft_5col_tiny.bin: files of real sensors are in no repository")
    with pytest.raises(DriveError, match="fit 5 columns"):
        found([file])
    points = found([file], ScanOptions(columns=parse_columns("5"))).read(file)
    assert points[0] == pytest.approx([49.62201, 6.024905, 6.3698897])


def echoes(seed: int) -> int:
    """Return the number of a scan's points that are no dropouts."""
    return int(turning_scan(16, 60, seed)[:, :3].any(axis=1).sum())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Write a drive of six scans in KITTI's layout."""
    points = [turning_scan(16, 60, seed)[:, :3] for seed in range(6)]
    return write_odometry(tmp_path / "drive", points, [pose(x) for x in range(6)])


def test_B10_bad_scans_are_skipped_and_counted_before_and_while_they_are_read(folder: Path) -> None:
    scans = folder / "velodyne"
    (scans / "000001.bin").write_bytes(b"")
    (scans / "000002.bin").write_bytes((scans / "000002.bin").read_bytes()[:-3])
    (scans / "000004.bin").unlink()
    values = np.fromfile(scans / "000003.bin", "<f4")
    values[[0, 5, 9]] = np.nan, np.inf, np.nan
    values.tofile(scans / "000003.bin")
    told: list[str] = []
    with use_scan_options(ScanOptions(tell=told.append)):
        drive = open_drive(folder)
    assert len(drive) == 6
    assert "3 of 6 scans skipped" in told[0]
    for name in ("000001.bin", "000002.bin", "000004.bin"):
        assert name in told[0]
    usable = np.isfinite(values.reshape(-1, 4)[:, :3]).all(1) & values.reshape(-1, 4)[:, :3].any(1)
    counts = [len(drive.scan(index)) for index in range(6)]
    assert counts == [echoes(0), 0, 0, usable.sum(), 0, echoes(5)]
    assert 900 < usable.sum() < 957
    assert drive.dropouts.within(range(6)) == ((1, 2, 4), 3)
    assert drive.dropouts.within(range(2)) == ((1,), 0)
    with (
        pytest.raises(DriveError, match=r"000001\.bin"),
        use_scan_options(ScanOptions(strict=True)),
    ):
        open_drive(folder)


def test_B10_a_scan_of_noise_is_skipped(folder: Path) -> None:
    noise = np.random.default_rng(0).integers(0, 256, 16 * 960, np.uint8)
    noise.tofile(folder / "velodyne" / "000005.bin")
    drive = open_drive(folder)
    assert len(drive.scan(5)) == 0
    assert len(drive.scan(4)) == echoes(4) < 960


def test_B10_a_drive_of_mostly_bad_scans_is_refused_at_once(folder: Path) -> None:
    for number in range(4):
        (folder / "velodyne" / f"{number:06d}.bin").write_bytes(b"")
    with pytest.raises(DriveError, match=r"4 of 6 scans skipped.*Over half"):
        open_drive(folder)


def test_B10_a_scan_without_content_does_not_count_as_seen(folder: Path, tmp_path: Path) -> None:
    points = [turning_scan(16, 60, seed)[:, :3] for seed in range(3)]
    other = write_odometry(tmp_path / "other", points, [pose(x) for x in range(3)])
    (folder / "velodyne" / "000001.bin").write_bytes(b"")
    (other / "velodyne" / "000001.bin").write_bytes(b"")
    assert open_drive(folder).scan_hash(1) != open_drive(other).scan_hash(1)


@pytest.mark.parametrize(
    ("factor", "name", "unit"), [(1e9, "nano", "ns"), (1e6, "micro", "us"), (1e3, "milli", "ms")]
)
def test_B4_B16_times_in_other_units_are_named(
    folder: Path, factor: float, name: str, unit: str
) -> None:
    np.savetxt(folder / "times.txt", (5 + np.arange(6) * 0.1) * factor, fmt="%.0f")
    with pytest.raises(DriveError, match=f"{name}seconds.*--time-unit {unit}"):
        open_drive(folder)
    with use_scan_options(ScanOptions(time_unit=unit)):  # type: ignore[arg-type]
        assert np.diff(open_drive(folder).times) == pytest.approx(0.1)


def test_B4_poses_in_millimeters_are_refused(folder: Path) -> None:
    rows = np.loadtxt(folder / "poses.txt")
    rows[:, 3::4] *= 1000
    np.savetxt(folder / "poses.txt", rows)
    with pytest.raises(DriveError, match=r"poses\.txt: 10,000 m/s"):
        open_drive(folder)


def test_B4_left_handed_poses_are_named(folder: Path) -> None:
    rows = np.loadtxt(folder / "poses.txt")
    rows[:, [0, 4, 8]] *= -1
    np.savetxt(folder / "poses.txt", rows)
    with pytest.raises(DriveError, match="left-handed"):
        open_drive(folder)


@pytest.mark.parametrize(("count", "what"), [(8, "TUM"), (7, "quaternion"), (16, "4x4")])
def test_B4_other_formats_of_poses_are_named(folder: Path, count: int, what: str) -> None:
    (folder / "poses.txt").write_text(f"{' '.join(['1'] * count)}\n" * 6)
    with pytest.raises(DriveError, match=f"line 1: {count} values.*{what}"):
        open_drive(folder)


@pytest.mark.parametrize("name", ["calib.txt", "poses.txt", "times.txt"])
def test_B16_byte_order_mark_and_crlf_are_read(folder: Path, name: str) -> None:
    before = open_drive(folder)
    text = (folder / name).read_bytes().replace(b"\n", b"\r\n")
    # Tr is the first line here, so that the mark would be part of its name.
    if name == "calib.txt":
        text = text[text.index(b"Tr") :]
    (folder / name).write_bytes(b"\xef\xbb\xbf" + text)
    after = open_drive(folder)
    assert (after.poses == before.poses).all()
    assert (after.times == before.times).all()
