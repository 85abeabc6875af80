"""Trajectory files of other people's programs, against independent parsing."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.trajectories.reading import read_trajectory

REAL = Path(__file__).resolve().parents[4] / "shared" / "real"

pytestmark = [
    pytest.mark.recorded,
    pytest.mark.skipif(not REAL.is_dir(), reason="the real files are not in ../shared/real"),
]


def test_kitti_with_its_times() -> None:
    found = read_trajectory(REAL / "KITTI_00_gt.txt")
    rows = np.loadtxt(REAL / "KITTI_00_gt.txt").reshape(-1, 3, 4)
    np.testing.assert_array_equal(found.poses[:, :3], rows)
    np.testing.assert_array_equal(found.stamps, np.loadtxt(REAL / "KITTI_00_gt_times.txt"))


def test_tum() -> None:
    found = read_trajectory(REAL / "freiburg1_xyz-ORB_kf_mono.txt")
    rows = np.loadtxt(REAL / "freiburg1_xyz-ORB_kf_mono.txt")
    np.testing.assert_array_equal(found.stamps, rows[:, 0])
    np.testing.assert_array_equal(found.poses[:, :3, 3], rows[:, 1:4])
    turns = Rotation.from_quat(rows[:, 4:]).as_matrix()
    assert found.poses[:, :3, :3] == pytest.approx(turns, abs=1e-12)


def test_euroc() -> None:
    found = read_trajectory(REAL / "V102_groundtruth.csv")
    rows = np.genfromtxt(REAL / "V102_groundtruth.csv", delimiter=",", comments="#")
    assert len(found) == len(rows) == 16_702
    assert found.stamps == pytest.approx(rows[:, 0] * 1e-9, abs=1e-6)
    np.testing.assert_array_equal(found.poses[:, :3, 3], rows[:, 1:4])
    turns = Rotation.from_quat(rows[:, [5, 6, 7, 4]]).as_matrix()
    assert found.poses[:, :3, :3] == pytest.approx(turns, abs=1e-12)
