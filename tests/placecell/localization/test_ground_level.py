"""Ground level: the height of a pose between sensors that see different parts of objects."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from placecell.core.spatial import within
from placecell.core.types import Float64, Int64
from placecell.localization import Candidates, Hypothesis, LocalizationParameters, Pose, localize
from placecell.localization.ground_level import (
    FARTHEST,
    UNCERTAINTY,
    UNLIKE,
    at_ground_level,
    ground_offset,
)

PARAMETERS = LocalizationParameters()
TRUE = Pose.of_yaw(0.6, np.array([40.0, -30.0, 12.0]))


@dataclass(frozen=True, eq=False)
class Boxes:
    """Segments of a map with boxes of some heights (`MapBoxes`)."""

    centroids: Float64
    sizes: Float64

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        rows = within(self.centroids, places, meters)
        return rows, self.centroids[rows]

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        return np.where(queries == rows, 1.0, 0.0)

    def heights(self, rows: Int64) -> Float64:
        return self.sizes[rows]


def two_views(
    seed: int = 0, reach: float = 2.2, foot: float = 0.0, segments: int = 40
) -> tuple[Candidates, Boxes]:
    """Return what a robot sees of objects on the ground, and the map of another sensor.

    Args:
        reach: height up to which the map's sensor sees the objects.
        foot: height from which the robot sees three of four objects.
    """
    random = np.random.default_rng(seed)
    tops = random.uniform(2.5, 6.0, segments)
    plan = random.uniform(-18, 18, (segments, 2))
    feet = np.where(np.arange(segments) % 4 == 0, 0.0, foot)
    seen = np.column_stack([plan, (feet + tops) / 2])
    seen[:, 2] -= 1.7  # the robot's sensor is above the ground
    stored = np.column_stack([plan, np.minimum(tops, reach) / 2])
    stored[:, 2] -= 1.7
    rows = np.arange(segments)[:, None]
    there = Boxes(TRUE.apply(stored), np.minimum(tops, reach))
    candidates = Candidates(
        seen, rows, there.centroids[rows], np.ones(rows.shape), heights=tops - feet
    )
    return candidates, there


def best_of(candidates: Candidates, there: Boxes) -> Hypothesis:
    best = localize(candidates, there=there).best
    assert best is not None
    return best


def off(best: Hypothesis) -> float:
    return float(best.pose.translation[2] - TRUE.translation[2])


@pytest.mark.parametrize("foot", [0.0, 1.0])
def test_height_follows_the_ground_where_the_views_end_at_different_heights(foot: float) -> None:
    """The centroids lie a meter lower in the map: without boxes, the pose does as well."""
    candidates, there = two_views(foot=foot)
    plain = best_of(replace(candidates, heights=None), there)
    best = best_of(candidates, there)
    assert off(plain) < -0.8
    assert abs(off(best)) < 0.25
    assert abs(off(best)) < 2 * np.sqrt(best.covariance[2, 2])
    assert np.sqrt(best.covariance[2, 2]) < 0.5
    np.testing.assert_allclose(best.pose.translation[:2], plain.pose.translation[:2])
    np.testing.assert_array_equal(best.queries, plain.queries)


def test_ground_offset_by_hand() -> None:
    """The lowest of up to 20 boxes is the level: 2.0 - 1.2 / 2 on the one side, 5.0 - 1.0 / 2."""
    plan = np.array([[0.0, 0], [4, 0], [0, 4], [4, 4], [8, 8]])
    seen = np.column_stack([plan, [2.0, 3.0, 3.0, 3.0, 3.5]])
    stored = np.column_stack([plan, [4.5, 4.5, 5.0, 5.0, 5.5]])
    candidates = Candidates(
        seen,
        np.zeros((5, 0), np.int64),
        np.zeros((5, 0, 3)),
        np.zeros((5, 0)),
        heights=np.array([1.2, 0.4, 0.4, 0.4, 0.4]),
    )
    there = Boxes(stored, np.array([0.4, 0.4, 1.0, 1.0, 1.0]))
    raised = Pose.of_yaw(0.0, np.array([0.0, 0.0, 2.0]))
    assert ground_offset(raised, candidates, there) == pytest.approx((4.3 - 1.4 - 2.0, UNCERTAINTY))
    # A segment that the map has not is no part of it, nor is one without a box.
    hole = replace(candidates, centroids=seen + np.eye(5, 3) * [40.0, 0, 0])
    assert ground_offset(raised, hole, there)[0] == pytest.approx(4.3 - 2.8 - 2.0)
    unknown = replace(candidates, heights=np.array([np.nan, 0.4, 0.4, 0.4, 0.4]))
    assert ground_offset(raised, unknown, there)[0] == pytest.approx(4.3 - 2.8 - 2.0)
    for few in (np.arange(3), np.arange(0)):
        assert np.isnan(ground_offset(raised, candidates.take(few), there)).all()


def test_uneven_ground_level_is_less_certain() -> None:
    """The level of the map is 0.4 m higher in one group of objects, and 0.8 m in the other."""
    group = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [3, 3, 0]])
    seen = np.concatenate([group, group + [50.0, 0, 0]])
    stored = seen + np.repeat([[0, 0, 0.4], [0, 0, 0.8]], 4, axis=0)
    none = np.zeros((8, 0))
    candidates = Candidates(seen, none.astype(int), np.zeros((8, 0, 3)), none, heights=np.ones(8))
    flat = Pose.of_yaw(0.0, np.zeros(3))
    found = ground_offset(flat, candidates, Boxes(stored, np.ones(8)))
    assert found == pytest.approx((0.6, np.hypot(UNCERTAINTY, 0.2)))


def test_height_and_variance_by_hand() -> None:
    """Ground and centroids are weighted by their variances."""
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    assert candidates.heights is not None
    unlike = np.abs(there.sizes[before.rows] - candidates.heights[before.queries]).mean()
    variance = before.covariance[2, 2] + (unlike**2 / UNLIKE) ** 2
    level, deviation = ground_offset(before.pose, candidates, there)
    after = at_ground_level(before, candidates, there, PARAMETERS)
    total = 1 / (1 / variance + 1 / deviation**2)
    assert after.covariance[2, 2] == pytest.approx(total)
    assert off(after) - off(before) == pytest.approx(level * total / deviation**2)
    np.testing.assert_array_equal(after.covariance[:2], before.covariance[:2])
    distances = np.linalg.norm(after.pose.apply(after.source) - there.centroids[after.rows], axis=1)
    np.testing.assert_allclose(after.residuals, distances, atol=1e-9)


def test_alike_boxes_leave_the_pose_as_it_is() -> None:
    candidates, there = two_views(reach=9.0)
    before = best_of(replace(candidates, heights=None), there)
    assert at_ground_level(before, candidates, there, PARAMETERS) is before


def test_unknown_boxes_leave_the_pose_as_it_is() -> None:
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    none = replace(there, sizes=np.full(len(there.sizes), np.nan))
    assert at_ground_level(before, candidates, none, PARAMETERS) is before
    assert at_ground_level(before, replace(candidates, heights=None), there, PARAMETERS) is before
    few = there.sizes.copy()
    few[before.rows[3:]] = np.nan
    assert at_ground_level(before, candidates, replace(there, sizes=few), PARAMETERS) is before


def test_pose_without_gravity_stays() -> None:
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    tilted = replace(PARAMETERS, model="se3")
    assert at_ground_level(before, candidates, there, tilted) is before


def test_far_ground_level_widens_the_height_only() -> None:
    """The robot's boxes reach far below those of the map, as on another floor."""
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    assert candidates.heights is not None
    deep = replace(candidates, heights=candidates.heights + 2 * FARTHEST + 2)
    after = at_ground_level(before, deep, there, PARAMETERS)
    assert after.pose.translation.tolist() == before.pose.translation.tolist()
    assert after.covariance[2, 2] > before.covariance[2, 2] + 1.0


@pytest.mark.parametrize("seed", range(3))
def test_few_boxes_below_the_ground_do_not_move_it(seed: int) -> None:
    """One reflection of forty boxes is below the level."""
    candidates, there = two_views(seed)
    low = there.centroids.copy()
    low[7, 2] -= 3.0
    right, wrong = (
        ground_offset(TRUE, candidates, each)[0] for each in (there, replace(there, centroids=low))
    )
    assert wrong == pytest.approx(right, abs=0.05)
