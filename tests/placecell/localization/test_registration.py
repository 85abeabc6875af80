import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.localization.pose import Pose
from placecell.localization.registration import register_se3, register_yaw
from tests.placecell.localization.scene_builders import a_pose, any_rotation


def test_a_quarter_turn_by_hand() -> None:
    source = np.array([[1.0, 0, 0], [0, 2, 0], [0, 0, 3]])
    target = np.array([[10.0, 1, 5], [8, 0, 5], [10, 0, 8]])
    pose = register_yaw(source, target, np.ones(3))
    assert pose.yaw == pytest.approx(np.pi / 2)
    np.testing.assert_allclose(pose.translation, [10, 0, 5], atol=1e-12)


@given(st.integers(0, 10_000))
def test_yaw_and_translation_come_back(seed: int) -> None:
    random = np.random.default_rng(seed)
    pose, source = a_pose(random), random.normal(size=(5, 3))
    found = register_yaw(source, pose.apply(source), random.uniform(0.1, 1, 5))
    np.testing.assert_allclose(found.matrix, pose.matrix, atol=1e-9)


@given(st.integers(0, 10_000))
def test_any_motion_comes_back(seed: int) -> None:
    random = np.random.default_rng(seed)
    pose, source = any_rotation(random), random.normal(size=(5, 3))
    found = register_se3(source, pose.apply(source), random.uniform(0.1, 1, 5))
    np.testing.assert_allclose(found.matrix, pose.matrix, atol=1e-9)


def test_a_reflection_is_no_motion() -> None:
    source = np.random.default_rng(0).normal(size=(6, 3))
    mirrored = source * (1, 1, -1)
    assert np.linalg.det(register_se3(source, mirrored, np.ones(6)).rotation) == pytest.approx(1)


def test_registration_minimizes_weighted_squares() -> None:
    random = np.random.default_rng(1)
    source, target, weights = random.normal(size=(8, 3)), random.normal(size=(8, 3)), np.arange(8.0)

    def cost(pose: Pose) -> float:
        return float(weights @ ((pose.apply(source) - target) ** 2).sum(axis=1))

    for best in (register_yaw(source, target, weights), register_se3(source, target, weights)):
        for _ in range(200):
            # A small yaw is a motion of either kind.
            step = Pose.of_yaw(random.normal() * 1e-2, random.normal(size=3) * 1e-2)
            assert cost(step.after(best)) >= cost(best)


def test_one_point_is_moved_and_not_turned() -> None:
    pose = register_yaw(np.array([[1.0, 2, 3]]), np.array([[4.0, 4, 4]]), np.ones(1))
    np.testing.assert_allclose(pose.matrix[:3], [[1, 0, 0, 3], [0, 1, 0, 2], [0, 0, 1, 1]])


def test_far_from_the_origin_nothing_is_lost() -> None:
    random = np.random.default_rng(2)
    source = random.uniform(-30, 30, (10, 3)) + (5e5, 5.4e6, 300)
    pose = Pose.of_yaw(1.0, np.array([1e5, 2e5, 10.0]))
    found = register_yaw(source, pose.apply(source), np.ones(10))
    np.testing.assert_allclose(found.apply(source), pose.apply(source), atol=1e-6)
