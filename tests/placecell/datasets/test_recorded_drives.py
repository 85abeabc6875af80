"""Real scans: ten of KITTI odometry 00, labelled by SemanticKITTI.

They are in no repository. PLACECELL_DRIVES names a folder that holds them as KITTI sequences.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import placecell
from placecell.core.parameters import PROTOCOL_V1
from placecell.datasets import Drive, KittiOdometry, open_drive
from placecell.segmentation.ground import is_ground
from placecell.segmentation.local_map import Accumulator, in_range, transform
from placecell.segmentation.pipeline import record
from placecell.segmentation.recording import Recording

pytestmark = pytest.mark.recorded

NAME = "kitti_odometry_00"
UNPACK = Path(placecell.__file__).resolve().parents[2] / "shared" / "data" / "unpack.py"

ROAD, SIDEWALK, PARKING, OTHER_GROUND, TERRAIN = 40, 48, 44, 49, 72
CAR, BUILDING, TRUNK, POLE = 10, 50, 71, 80
GROUND = (ROAD, SIDEWALK, PARKING, OTHER_GROUND, TERRAIN)
PARAMETERS = PROTOCOL_V1.for_drive(10)


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    given = os.environ.get("PLACECELL_DRIVES")
    if given is not None:
        for folder in (Path(given) / NAME, Path(given) / "sequences" / NAME):
            if folder.is_dir():
                return open_drive(folder)
        pytest.skip(f"PLACECELL_DRIVES holds no {NAME}")
    if not UNPACK.is_file():
        pytest.skip("no recorded drives: PLACECELL_DRIVES is not set")
    out = tmp_path_factory.mktemp("drives")
    subprocess.run([sys.executable, UNPACK, out, NAME], check=True, capture_output=True)
    return open_drive(out / "sequences" / NAME)


@pytest.fixture(scope="module")
def recording(drive: Drive) -> Recording:
    return record(drive, PARAMETERS)


def test_drive_is_read(drive: Drive) -> None:
    assert isinstance(drive, KittiOdometry)
    assert len(drive) == 10
    assert drive.path_length() == pytest.approx(6.7, abs=0.3)
    assert np.diff(drive.times) == pytest.approx(0.1037, abs=1e-3)
    assert 100_000 < len(drive.scan(0)) < 130_000


def test_poses_are_in_the_sensors_frame(drive: Drive) -> None:
    # The car drives straight on. Were they the camera's, it would move along z.
    assert drive.poses[0] == pytest.approx(np.eye(4), abs=1e-6)
    x, y, z = drive.poses[-1, :3, 3]
    assert x > 6
    assert abs(y) < 0.3
    assert abs(z) < 0.3
    assert (np.diff(drive.poses[:, 0, 3]) > 0.5).all()


def test_standing_things_coincide_over_the_scans(drive: Drive) -> None:
    # The tenth scan moved by its pose lies on the first: wrong poses would leave 6.7 m.
    first, last = (
        transform(drive.poses[index], in_range(drive.scan(index), PARAMETERS)) for index in (0, 9)
    )
    high = last[(last[:, 2] > 0) & (np.linalg.norm(last, axis=1) < 25)][::10]
    distances, _ = cKDTree(first).query(high)
    assert np.median(distances) < 0.1


def test_segments_per_capture_are_plausible(recording: Recording) -> None:
    _, counts = np.unique(recording.captures, return_counts=True)
    # 37 from the first scan alone, 46 from two, 52 to 60 from there on.
    assert len(counts) == 10
    assert counts.min() >= 30
    assert (counts[2:] >= 45).all()
    assert counts.max() <= 100


def test_groups_persist_over_captures(recording: Recording) -> None:
    # Most of what one frame has, the next has too.
    for frame in range(4, 10):
        before, now = (set(recording.groups[recording.captures == f]) for f in (frame - 1, frame))
        assert len(before & now) > 0.6 * len(now)
    assert 0.3 < recording.distinct.mean() < 0.9


def labels_of(drive: Drive, index: int) -> np.ndarray:
    file = drive.folder / "labels" / f"{index:06d}.label"
    if not file.exists():
        pytest.skip("the drive has no labels")
    return np.fromfile(file, dtype="<u4") & 0xFFFF


@pytest.mark.parametrize("index", [0, 5])
def test_ground_removal_agrees_with_the_labels(drive: Drive, index: int) -> None:
    """Compare one scan with the labels; the bounds leave room around the measured shares.

    Removed: road 99.98 and 100.00%, sidewalk 99.95 and 99.94%, terrain 90.9 and 87.2%; of what
    stands higher than 0.5 m above the ground, cars, trunks and poles 0%, buildings 1.8 and 1.0%.
    """
    scan, labels = drive.scan(index), labels_of(drive, index)
    ranges = np.linalg.norm(scan, axis=1)
    used = (ranges >= PARAMETERS.min_range) & (ranges <= PARAMETERS.local_map_radius)
    points, labels = scan[used], labels[used]
    removed = is_ground(points, PARAMETERS)

    ground = points[np.isin(labels, GROUND)]
    _, nearest = cKDTree(ground[:, :2]).query(points[:, :2], k=5)
    high = points[:, 2] - np.median(ground[nearest, 2], axis=1) > 0.5

    def share(*kinds: int, of: np.ndarray | None = None) -> float:
        wanted = np.isin(labels, kinds) & (True if of is None else of)
        assert wanted.sum() > 100
        return float(removed[wanted].mean())

    assert share(ROAD) > 0.98
    assert share(SIDEWALK) > 0.98
    assert share(*GROUND) > 0.98
    assert share(TERRAIN) > 0.75
    assert share(CAR, of=high) < 0.01
    assert share(TRUNK, POLE, of=high) < 0.01
    assert share(BUILDING, of=high) < 0.05
    assert share(CAR, BUILDING, TRUNK, POLE, of=high) < 0.03


def test_little_ground_is_left_in_the_local_map(drive: Drive) -> None:
    local_map = Accumulator(drive, PARAMETERS).local_map(9)
    removed = is_ground(local_map, PARAMETERS)
    # The road lies 1.7 m below the sensor.
    near = np.linalg.norm(local_map[:, :2] - drive.poses[9, :2, 3], axis=1) < 10
    low = local_map[:, 2] - drive.poses[9, 2, 3] < -1.6
    assert (near & low).sum() > 5000
    assert removed[near & low].mean() > 0.98
