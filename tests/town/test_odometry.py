import numpy as np
import pytest

from placecell.core.types import Float64
from town.sensing.odometry import Odometry


def straight(meters: int) -> Float64:
    """Return poses 1 m apart along a heading, uphill, with roll."""
    poses = np.tile(np.eye(4), (meters + 1, 1, 1))
    poses[:, :3, :3] = [[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]
    tilt = np.array([[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])
    poses[:, :3, :3] = poses[:, :3, :3] @ tilt
    poses[:, :3, 3] = np.arange(meters + 1)[:, None] * [0.6, 0.8, 0.0] + [7.0, 8.0, 9.0]
    return poses


def test_odometry_without_errors_is_exact() -> None:
    true = straight(50)
    assert Odometry(0.0, 0.0).poses(true, seed=3) == pytest.approx(true, abs=1e-12)


def test_the_first_pose_is_true_and_the_truth_is_left_alone() -> None:
    true = straight(50)
    believed = Odometry(1.0, 0.1).poses(true, seed=3)
    assert believed[0] == pytest.approx(true[0])
    assert np.array_equal(true, straight(50))


def test_scale_error_stretches_the_path() -> None:
    true = straight(50)
    believed = Odometry(0.0, 0.1).poses(true, seed=3)
    steps = np.linalg.norm(np.diff(believed[:, :3, 3], axis=0), axis=1)
    assert steps == pytest.approx(np.full(50, steps[0]))
    assert abs(steps[0] - 1) > 1e-3
    assert believed[:, :3, :3] == pytest.approx(true[:, :3, :3])


def test_the_errors_are_as_stated() -> None:
    odometry = Odometry(yaw=0.05, scale=0.01)
    true = straight(100)
    ends = np.stack([odometry.poses(true, seed)[-1] for seed in range(600)])
    turn = ends[:, :3, :3] @ true[-1, :3, :3].T
    yaw = np.degrees(np.arctan2(turn[:, 1, 0], turn[:, 0, 0]))
    assert yaw.std() == pytest.approx(0.5, rel=0.1)  # 0.05 times the root of 100
    assert abs(yaw.mean()) < 0.1
    length = np.linalg.norm(ends[:, :3, 3] - true[0, :3, 3], axis=1)
    assert (length / 100).std() == pytest.approx(0.01, rel=0.1)


def test_gravity_is_known() -> None:
    true = straight(100)
    believed = Odometry(2.0, 0.05).poses(true, seed=5)
    assert believed[:, 2, :3] == pytest.approx(true[:, 2, :3])
    rotations = believed[:, :3, :3]
    assert rotations @ rotations.transpose(0, 2, 1) == pytest.approx(
        np.tile(np.eye(3), (101, 1, 1))
    )


def test_each_step_has_the_true_relative_motion() -> None:
    """Relative poses are the true ones, except for the scale."""
    true = straight(30)
    believed = Odometry(3.0, 0.0).poses(true, seed=5)

    def felt(poses: Float64) -> Float64:
        inverse = poses[:-1, :3, :3].transpose(0, 2, 1)
        return np.asarray(np.einsum("nij,nj->ni", inverse, np.diff(poses[:, :3, 3], axis=0)))

    assert felt(believed) == pytest.approx(felt(true))
    assert np.abs(believed[-1] - true[-1]).max() > 0.5


@pytest.mark.parametrize(("yaw", "scale"), [(-0.1, 0.0), (0.0, -0.1), (np.nan, 0.0), (0.0, 0.5)])
def test_invalid_deviations_are_refused(yaw: float, scale: float) -> None:
    with pytest.raises(ValueError, match="Invalid drift"):
        Odometry(yaw, scale)
