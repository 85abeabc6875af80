from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.datasets import DriveError, open_drive
from town import HDL_64E, Route, Town, read_origin, write_drive

SCANS = 8
SPACING = 2.0
SMALL = replace(HDL_64E, columns=300)


@pytest.fixture(scope="module")
def town() -> Town:
    return Town.build(seed=5, streets=(2, 2))


@pytest.fixture(scope="module")
def route(town: Town) -> Route:
    return Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (1, 1)]).cut(
        start=40.0, length=30.0
    )


def write(folder: Path, town: Town, route: Route, *, cars: int = 1, noise: int = 1,
          scans: int = SCANS, overwrite: bool = False) -> Path:  # fmt: skip
    return write_drive(
        folder, town, route, traffic_seed=cars, noise_seed=noise, scans=scans, spacing=SPACING,
        lidar=SMALL, overwrite=overwrite,
    )  # fmt: skip


@pytest.fixture(scope="module")
def folder(town: Town, route: Route, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("drives") / "drive", town, route)


def true_poses(route: Route) -> Float64:
    return route.poses(SPACING * (np.arange(SCANS, dtype=np.float64) + 0.5), SMALL.height)


def in_town(folder: Path, scan: int) -> Float64:
    drive = open_drive(folder)
    pose = read_origin(folder) @ drive.poses[scan]
    return np.asarray(drive.scan(scan) @ pose[:3, :3].T + pose[:3, 3])


def files(folder: Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def test_the_reader_finds_the_true_poses(folder: Path, route: Route) -> None:
    drive = open_drive(folder)
    assert drive.name == "KITTI odometry"
    assert len(drive) == SCANS
    found = read_origin(folder) @ drive.poses
    assert np.abs(found - true_poses(route)).max() < 1e-6
    assert drive.times == pytest.approx(0.1 * np.arange(SCANS))


def test_the_camera_is_not_the_sensor(folder: Path) -> None:
    """The reader's transform from camera to sensor is not the identity."""
    camera = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    moved = camera[-1, :, 3] - camera[0, :, 3]
    assert abs(moved[2]) > 5 * abs(moved[1])  # the camera's z is ahead, its y down


def test_the_world_frame_is_level_at_the_first_scan(folder: Path) -> None:
    drive = open_drive(folder)
    origin = read_origin(folder)
    assert origin[2, :3] == pytest.approx([0, 0, 1])
    assert origin[:3, 2] == pytest.approx([0, 0, 1])
    assert drive.poses[0, :3, 3] == pytest.approx(0, abs=1e-9)
    assert drive.poses[0, 1, 0] == pytest.approx(0, abs=1e-9)
    assert drive.poses[0, :3, :3] == pytest.approx(np.eye(3), abs=0.031)


def test_an_origin_in_three_lines_is_read_too(folder: Path, tmp_path: Path) -> None:
    origin = read_origin(folder)
    np.savetxt(tmp_path / "origin.txt", origin[:3])
    np.testing.assert_allclose(read_origin(tmp_path), origin)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "0 numbers"),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n" * 2, "24 numbers"),
        ("1 0 0 0\n0 1 0 0\n0 0 1\n", "line 3: 3 values"),
        ("1 0 0 0 0 1 0 0 0 0 1 east\n", "line 1: .*east"),
        ("1 0 0 nan 0 1 0 0 0 0 1 0\n", "not finite"),
        ("2 0 0 0 0 1 0 0 0 0 1 0\n", "no rotation"),
        (None, "missing"),
    ],
)
def test_a_broken_origin_names_the_file(tmp_path: Path, text: str | None, said: str) -> None:
    if text is not None:
        (tmp_path / "origin.txt").write_text(text)
    with pytest.raises(DriveError, match=rf"origin\.txt.*{said}"):
        read_origin(tmp_path)


@pytest.mark.parametrize("scan", [0, SCANS - 1])
def test_the_road_is_at_its_height(folder: Path, town: Town, route: Route, scan: int) -> None:
    """The road ahead and behind is free, and its height is right."""
    points = in_town(folder, scan)
    lane = route.lane()[::4]
    beside = np.linalg.norm(points[:, None, :2] - lane[None], axis=2).min(axis=1)
    on_road = points[beside < 1.2]
    assert len(on_road) > 300
    off = on_road[:, 2] - town.terrain.height(on_road[:, :2])
    # The noise is along the beam: 5 sigma, at the steepest beam's angle.
    assert np.abs(off).max() < 5 * 0.02 * np.sin(np.radians(25)) + 0.002
    assert abs(off.mean()) < 0.002


def test_the_pavement_is_a_curb_higher(folder: Path, town: Town) -> None:
    points = in_town(folder, 0)
    off = points[:, 2] - town.terrain.height(points[:, :2])
    counts, edges = np.histogram(off[np.abs(off) < 0.3], bins=60)
    upper = edges[:-1] > 0.06
    assert edges[:-1][upper][counts[upper].argmax()] == pytest.approx(0.12, abs=0.02)


def test_points_are_within_the_limits(folder: Path) -> None:
    for scan in range(SCANS):
        records = np.fromfile(folder / "velodyne" / f"{scan:06d}.bin", "<f4").reshape(-1, 4)
        ranges = np.linalg.norm(records[:, :3], axis=1)
        assert np.isfinite(records).all()
        assert ranges.min() > SMALL.min_range - SPACING
        assert ranges.max() < SMALL.max_range + SPACING
        assert 0.5 < len(records) / (64 * SMALL.columns) < 0.99
        assert 0 < records[:, 3].min() <= records[:, 3].max() <= 1


def test_same_seeds_give_the_same_bytes(
    folder: Path, town: Town, route: Route, tmp_path: Path
) -> None:
    town_again = Town.build(seed=5, streets=(2, 2))
    again = write(tmp_path / "again", town_again, replace(route, terrain=town_again.terrain))
    assert files(again) == files(folder)
    assert len(files(again)) == SCANS + 4


def test_other_noise_seed_gives_other_points(
    folder: Path, town: Town, route: Route, tmp_path: Path
) -> None:
    other = write(tmp_path / "other", town, route, noise=2)
    differing = {name for name, content in files(other).items() if files(folder)[name] != content}
    assert differing == {f"velodyne/{scan:06d}.bin" for scan in range(SCANS)}


def test_cars_change_and_houses_stay(
    folder: Path, town: Town, route: Route, tmp_path: Path
) -> None:
    other = write(tmp_path / "other", town, route, cars=2)

    def low_and_high(drive: Path) -> tuple[Float64, Float64]:
        points = np.concatenate([in_town(drive, scan) for scan in range(SCANS)])
        height = points[:, 2] - town.terrain.height(points[:, :2])
        low = points[(height > 0.4) & (height < 1.2)]
        return low, points[height > 2.8]  # above every car

    def share_met(one: Float64, other: Float64) -> float:
        cells = {tuple(cell) for cell in np.floor(other / 0.5).astype(int)}
        return float(np.mean([tuple(cell) in cells for cell in np.floor(one / 0.5).astype(int)]))

    (low, high), (other_low, other_high) = low_and_high(folder), low_and_high(other)
    assert share_met(high, other_high) > 0.9
    assert share_met(low, other_low) < 0.85
    same_low, same_high = low_and_high(folder)
    assert share_met(low, same_low) == share_met(high, same_high) == 1.0


def test_a_folder_in_use_is_refused(town: Town, route: Route, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(FileExistsError, match=r"is not empty: .* overwrite=True"):
        write(tmp_path, town, route)
    assert files(tmp_path) == {"notes.txt": b"mine"}


def test_overwrite_leaves_no_scan_of_the_longer_drive(
    town: Town, route: Route, tmp_path: Path
) -> None:
    drive = tmp_path / "drive"
    write(drive, town, route)
    (drive / "notes.txt").write_text("mine")
    write(drive, town, route, scans=2, overwrite=True)
    assert len(open_drive(drive)) == 2
    assert (drive / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize(("scans", "message"), [(0, "expected at least 1"), (500, "too short")])
def test_impossible_drives_are_refused(
    town: Town, route: Route, tmp_path: Path, scans: int, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        write(tmp_path / "drive", town, route, scans=scans)
    assert not (tmp_path / "drive").exists()
