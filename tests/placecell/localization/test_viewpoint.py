"""Viewpoint: centroids of the visible sides of objects."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.localization import Candidates, LocalizationParameters, Pose, localize
from placecell.localization.correspondences import correspond
from placecell.localization.covariance import at_point, common_error, covariance_of
from placecell.localization.viewpoint import FARTHEST, SHIFT, view_shifts
from tests.placecell.localization.scene_builders import a_pose

SENSOR = np.array([0.0, 0.0, 1.8])


def visible_centroid(middle: Float64, half: float, sensor: Float64) -> Float64:
    """Return the centroid of the faces of a square pillar that a sensor sees, by their areas."""
    away = sensor - middle
    faces, widths = [], []
    for axis in range(2):
        if abs(away[axis]) > half:
            face = middle.copy()
            face[axis] += half * np.sign(away[axis])
            faces.append(face)
            widths.append(abs(away[axis]) - half)  # the width that the sensor sees
    return np.average(faces, axis=0, weights=widths)


def test_opposite_sides_of_a_box_are_apart_along_the_view() -> None:
    """Each view has the near face: its centroid is half the box nearer to its sensor."""
    box = np.array([10.0, 0.0, 1.0])
    here, there = np.array([0.0, 0.0, 1.0]), np.array([20.0, 0.0, 1.0])
    now, stored = (visible_centroid(box, SHIFT / 2, each) for each in (here, there))
    np.testing.assert_allclose(now - stored, [-SHIFT, 0, 0], atol=1e-12)
    np.testing.assert_allclose(view_shifts(stored, there, here), [-SHIFT, 0, 0], atol=1e-12)


def test_same_side_has_no_shift() -> None:
    segment, capture = np.array([10.0, 5.0, 1.0]), np.array([2.0, 1.0, 0.0])
    nearer = segment + 0.5 * (capture - segment) + (0.0, 0.0, 3.0)
    np.testing.assert_allclose(view_shifts(segment, capture, nearer), 0, atol=1e-12)


@pytest.mark.parametrize("degrees", [30.0, 60.0, 90.0, 120.0, 179.0])
def test_shift_by_hand(degrees: float) -> None:
    """It has the length SHIFT sin(a / 2)^3, from the stored view's direction to the new one's."""
    angle = np.radians(degrees)
    capture = 12.0 * np.array([1.0, 0.0, 0.0])
    sensor = 30.0 * np.array([np.cos(angle), np.sin(angle), 0.1])
    shift = view_shifts(np.zeros(3), capture, sensor)
    along = np.array([np.cos(angle) - 1, np.sin(angle), 0.0])
    along /= np.linalg.norm(along)
    np.testing.assert_allclose(shift, SHIFT * np.sin(angle / 2) ** 3 * along, atol=1e-12)


def test_unknown_directions_have_no_shift() -> None:
    segments = np.zeros((4, 3))
    captures = np.array([[np.nan] * 3, [0.1, 0, 0], [FARTHEST + 1, 0, 0], [10.0, 0, 0]])
    shifts = view_shifts(segments, captures, np.array([-10.0, 0, 0]))
    np.testing.assert_allclose(shifts[:3], 0)
    np.testing.assert_allclose(shifts[3], [-SHIFT, 0, 0], atol=1e-12)
    np.testing.assert_allclose(view_shifts(segments, captures, np.full(3, np.nan)), 0)


def ahead(random: np.random.Generator, half: float = SHIFT / 2) -> tuple[Candidates, Pose]:
    """Return pillars ahead of a robot, which the mapping robot passed the other way, and the pose.

    Robot and map have the centroids of the faces that each has seen.
    """
    true = a_pose(random, 50.0)
    pillars = np.column_stack([random.uniform(8, 35, 20), random.uniform(-9, 9, 20), np.ones(20)])
    beyond = pillars + np.array([12.0, 0.0, 0.8])
    beyond[:, 1] = 2.0
    # Faces along the axes of the robot's frame.
    seen = np.array([visible_centroid(each, half, SENSOR) for each in pillars])
    stored = np.array(
        [visible_centroid(each, half, place) for each, place in zip(pillars, beyond, strict=True)]
    )
    rows = np.arange(20)[:, None]
    places = true.apply(stored)[:, None]
    captures = true.apply(beyond)[:, None]
    return Candidates(seen, rows, places, np.ones((20, 1)), SENSOR, captures), true


def test_pose_ahead_of_the_map_is_not_drawn_along_the_road() -> None:
    """All centroids are shifted alike, so that the residuals are small and the pose is off."""
    candidates, true = ahead(np.random.default_rng(0))
    plain = localize(replace(candidates, captures=None)).best
    best = localize(candidates).best
    assert plain is not None
    assert best is not None
    off, off_with_views = (each.pose.difference(true, SENSOR)[0] for each in (plain, best))
    assert off > 0.5
    assert off_with_views < 0.2
    assert len(best) == 20


def test_covariance_shows_the_uncertain_shift() -> None:
    candidates, true = ahead(np.random.default_rng(1), half=SHIFT)
    best, plain = (localize(each).best for each in (candidates, replace(candidates, sensor=None)))
    assert best is not None
    assert plain is not None
    along = true.rotation[:, 0]
    deviations = [
        np.sqrt(along @ at_point(each.covariance, each.pose, SENSOR)[:3, :3] @ along)
        for each in (plain, best)
    ]
    # Twice as large as on average, the objects still draw the pose along the road.
    assert 0.2 < best.pose.difference(true, SENSOR)[0] < 2.5 * deviations[1]
    assert deviations[1] > deviations[0] + 0.05


def test_common_error_of_all_targets_is_one_of_the_position() -> None:
    """Displacements d of all points displace the pose by d, whatever the weights are."""
    random = np.random.default_rng(2)
    source, pose = random.uniform(-30, 30, (30, 3)), a_pose(random)
    target = pose.apply(source)
    common = np.tile([0.3, -0.1, 0.0], (30, 1))
    parameters = LocalizationParameters()
    added = covariance_of(pose, source, target, parameters, common) - covariance_of(
        pose, source, target, parameters
    )
    moved = np.array([0.3, -0.1, 0.0, 0.0])
    expected = np.outer(moved, moved)
    np.testing.assert_allclose(added, expected, atol=1e-9)


def test_common_error_is_estimated_as_far_as_residuals_show_it() -> None:
    """Points on the left and on the right are displaced in opposite directions: no pose does it."""
    random = np.random.default_rng(6)
    source = random.uniform(-30, 30, (40, 3))
    source[:, 1] += np.where(np.arange(40) % 2, 20.0, -20.0)
    pose, parameters = a_pose(random), LocalizationParameters()
    common = pose.rotation @ np.array([0.0, 0.3, 0.0]) * np.sign(source[:, 1:2])
    target = pose.apply(source)
    amount, deviation = common_error(pose, source, target - 0.5 * common, parameters, common)
    assert amount == pytest.approx(0.5, abs=0.1)
    assert deviation < 0.3
    # A displacement of all points is one of the pose: no residual shows it.
    shift = np.tile([0.3, 0.0, 0.0], (40, 1))
    hidden = common_error(pose, source, target, parameters, shift)
    np.testing.assert_allclose(hidden, (0.0, 1.0), atol=1e-9)


def test_views_follow_their_rows_through_correspondences() -> None:
    candidates, true = ahead(np.random.default_rng(3))
    found = correspond(candidates, LocalizationParameters())
    assert found.captures is not None
    assert candidates.captures is not None
    np.testing.assert_allclose(found.captures, candidates.captures[found.rows, 0])
    moved = found.seen_at(true).target - found.target
    expected = view_shifts(found.target, found.captures, true.apply(SENSOR))
    np.testing.assert_allclose(moved, expected)
    assert replace(found, sensor=None).seen_at(true).target is found.target


def test_only_the_pose_changes_with_the_views() -> None:
    """Probability, features and evidence are those of the place, with and without the views."""
    candidates, _ = ahead(np.random.default_rng(5))
    found, plain = localize(candidates), localize(replace(candidates, sensor=None))
    assert found.best is not None
    assert plain.best is not None
    assert found.probability == plain.probability
    assert found.features is not None
    assert plain.features is not None
    np.testing.assert_array_equal(found.features, plain.features)
    assert [each.score for each in found.hypotheses] == [each.score for each in plain.hypotheses]
    np.testing.assert_array_equal(found.hypotheses[0].pose.matrix, plain.hypotheses[0].pose.matrix)
    assert found.best.pose.difference(plain.best.pose, SENSOR)[0] > 0.3
