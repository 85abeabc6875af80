import numpy as np
import pytest

from placecell.localization.pose import Pose
from tests.placecell.localization.scene_builders import any_rotation


def test_a_pose_is_its_matrix() -> None:
    pose = any_rotation(np.random.default_rng(0))
    points = np.random.default_rng(1).normal(size=(4, 3))
    by_matrix = (pose.matrix @ np.column_stack([points, np.ones(4)]).T).T[:, :3]
    np.testing.assert_allclose(pose.apply(points), by_matrix)
    np.testing.assert_allclose(pose.apply(points[0]), by_matrix[0])
    np.testing.assert_allclose(Pose.of_matrix(pose.matrix).matrix, pose.matrix)


def test_inverse_and_composition() -> None:
    random = np.random.default_rng(2)
    first, second = any_rotation(random), any_rotation(random)
    np.testing.assert_allclose(first.inverse().after(first).matrix, np.eye(4), atol=1e-9)
    np.testing.assert_allclose(second.after(first).matrix, second.matrix @ first.matrix)


def test_yaw_turns_x_to_y() -> None:
    pose = Pose.of_yaw(np.pi / 2, np.zeros(3))
    np.testing.assert_allclose(pose.apply(np.array([1.0, 0, 0])), [0, 1, 0], atol=1e-12)
    assert pose.yaw == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, np.pi - 1e-7, np.pi])
def test_the_difference_is_at_a_point(angle: float) -> None:
    one, other = Pose.of_yaw(0.0, np.zeros(3)), Pose.of_yaw(angle, np.array([0.0, 0, 4]))
    meters, found = one.difference(other, np.zeros(3))
    assert meters == pytest.approx(4)
    assert found == pytest.approx(angle, abs=1e-7)
    # Ten meters off the axis a turn is a chord.
    meters, _ = one.difference(Pose.of_yaw(angle, np.zeros(3)), np.array([10.0, 0, 0]))
    assert meters == pytest.approx(20 * np.sin(angle / 2))
