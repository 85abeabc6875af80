"""The correction of the odometry: fusion, jump guard, covariance."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from robot.core.settings import DriftRates
from robot.core.status import Fix
from robot.localization.correction import Correction
from robot.localization.rigid import covariance_at_sensor, difference, inverse, moved_by
from tests.robot.agent_fakes import at

COVARIANCE = np.diag([0.04, 0.04, 0.04, 1e-4, 1e-4, 1e-4])


def fix(transform: Float64, odom_pose: Float64, meters: float, name: str = "yard") -> Fix:
    pose = transform @ odom_pose
    return Fix(0.0, name, pose, COVARIANCE, 0.99, "service", meters, False)


def transform_of(correction: Correction) -> Float64:
    assert correction.transform is not None
    return correction.transform


def test_fix_is_used_when_a_second_one_from_another_place_agrees() -> None:
    correction = Correction()
    assert correction.add(fix(at(5), at(0), 0.0), at(5)) == "unconfirmed"
    assert correction.transform is None
    assert correction.add(fix(at(5), at(0), 0.0), at(5)) == "unconfirmed"  # the same place
    assert correction.add(fix(at(5.2), at(2), 2.0), at(5.2)) == "first"
    np.testing.assert_allclose(transform_of(correction), at(5.2))


def test_agreeing_fixes_are_averaged_by_their_covariance() -> None:
    correction = Correction(DriftRates(position=0.0, yaw=0.0))
    correction.place(fix(at(5), at(0), 0.0), at(5))
    # Equal covariances, no drift, no error of the heading over 0 meters: the mean.
    assert correction.add(fix(at(5.4), at(0), 0.0), at(5.4)) == "confirmed"
    assert correction.transform is not None
    assert correction.transform[0, 3] == pytest.approx(5.2)
    found = correction.at(0.0, 0.0)
    assert found is not None
    assert found.covariance[0, 0] == pytest.approx(0.02)


def test_fix_far_away_does_not_move_the_pose_alone() -> None:
    correction = Correction()
    correction.place(fix(at(5), at(0), 0.0), at(5))
    assert correction.add(fix(at(50), at(2), 2.0), at(50)) == "contradicts"
    np.testing.assert_allclose(transform_of(correction), at(5))
    assert correction.add(fix(at(50), at(4), 4.0), at(50)) == "jump"
    np.testing.assert_allclose(transform_of(correction), at(50))


def test_agreeing_fix_ends_the_doubt() -> None:
    correction = Correction()
    correction.place(fix(at(5), at(0), 0.0), at(5))
    correction.add(fix(at(50), at(2), 2.0), at(50))
    assert correction.add(fix(at(5), at(4), 4.0), at(5)) == "confirmed"
    assert correction.add(fix(at(50), at(6), 6.0), at(50)) == "contradicts"


def test_fix_in_another_map_needs_a_second_one() -> None:
    correction = Correction()
    correction.place(fix(at(5), at(0), 0.0), at(5))
    assert correction.add(fix(at(5), at(2), 2.0, "hall"), at(5)) == "contradicts"
    assert correction.add(fix(at(5), at(4), 4.0, "hall"), at(5)) == "jump"


def test_covariance_grows_with_distance_by_hand() -> None:
    rates = DriftRates(position=0.1, yaw=0.02, tilt=0.0)
    grown = rates.grown(np.diag([1.0, 1.0, 1.0, 0.1, 0.1, 0.01]), 10.0)
    # (0.1 * 10)^2 of the distance; 0.01 * 10^2 of the heading; 0.02^2 * 10 * 10^2 / 3 of its drift.
    expected = 1.0 + 1.0 + 1.0 + 0.02**2 * 1000 / 3
    assert grown[0, 0] == pytest.approx(expected)
    assert grown[2, 2] == pytest.approx(2.0)
    assert grown[5, 5] == pytest.approx(0.01 + 0.02**2 * 10)


def test_drift_within_the_covariance_is_corrected_after_a_long_way() -> None:
    correction = Correction()
    correction.place(fix(at(0), at(0), 0.0), at(0))
    # After 300 m the odometry is off by 6 m: within three times 2% of the way.
    assert correction.add(fix(at(6), at(300), 300.0), at(6)) == "confirmed"
    assert correction.transform is not None
    assert abs(correction.transform[0, 3] - 6.0) < 0.3


def test_difference_and_step_are_inverse() -> None:
    rng = np.random.default_rng(0)
    one, other = np.eye(4), np.eye(4)
    one[:3, :3] = Rotation.random(random_state=1).as_matrix()
    other[:3, :3] = Rotation.random(random_state=2).as_matrix()
    one[:3, 3], other[:3, 3] = rng.normal(size=(2, 3))
    np.testing.assert_allclose(moved_by(other, difference(one, other)), one, atol=1e-12)
    np.testing.assert_allclose(inverse(one) @ one, np.eye(4), atol=1e-12)


def test_covariance_at_the_sensor_has_the_lever_of_the_heading() -> None:
    at_origin = np.diag([0.01, 0.01, 0.01, 1e-4])
    found = covariance_at_sensor(at_origin, np.eye(4), np.array([100.0, 0.0, 0.0]), np.zeros(6))
    # 0.01 rad over 100 m is 1 m sideways.
    assert found[1, 1] == pytest.approx(0.01 + 1.0)
    assert found[0, 0] == pytest.approx(0.01)
    assert found[5, 5] == pytest.approx(1e-4)
    np.testing.assert_allclose(found, found.T)


def test_pose_follows_a_map_that_was_moved() -> None:
    correction = Correction()
    moved = np.eye(4)
    moved[:3, 3] = 2.0, -1.0, 0.0
    correction.follow(moved)
    assert correction.transform is None
    correction.place(fix(at(0), at(0), 0.0), at(0))
    correction.follow(moved)
    np.testing.assert_allclose(transform_of(correction), moved)
