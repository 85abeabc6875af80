"""Pose height: boxes of sensors that see different parts of objects."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from placecell.core.spatial import within
from placecell.core.types import Float64, Int64
from placecell.localization import Candidates, Hypothesis, LocalizationParameters, Pose, localize
from placecell.localization.pose_height import (
    ALIKE_SEGMENTS,
    FARTHEST,
    LEFT,
    RISES,
    UNCERTAINTY,
    UNLIKE,
    WORTH,
    at_height_of_boxes,
    edge_likelihood,
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
        foot: mean height from which the robot sees three of four objects.
    """
    random = np.random.default_rng(seed)
    tops = random.uniform(2.5, 6.0, segments)
    plan = random.uniform(-18, 18, (segments, 2))
    feet = np.where(np.arange(segments) % 4 == 0, 0.0, foot * random.uniform(0.2, 1.8, segments))
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
    assert abs(off(best)) < 0.4
    assert abs(off(best)) < 2 * np.sqrt(best.covariance[2, 2])
    assert np.sqrt(best.covariance[2, 2]) < 0.5
    np.testing.assert_allclose(best.pose.translation[:2], plain.pose.translation[:2])
    np.testing.assert_array_equal(best.queries, plain.queries)


def boxes(places: Float64, heights: Float64) -> tuple[Float64, Float64]:
    return np.asarray(places, np.float64), np.asarray(heights, np.float64)


def test_ground_offset_by_hand() -> None:
    """The lowest of up to 20 boxes is the level: 2.0 - 1.2 / 2 on one side, 4.5 - 0.4 / 2."""
    plan = np.array([[0.0, 0], [4, 0], [0, 4], [4, 4], [8, 8]])
    seen = np.column_stack([plan, [2.0, 3.0, 3.0, 3.0, 3.5]])
    stored = np.column_stack([plan, [4.5, 4.5, 5.0, 5.0, 5.5]])
    own = boxes(seen, np.array([1.2, 0.4, 0.4, 0.4, 0.4]))
    other = boxes(stored, np.array([0.4, 0.4, 1.0, 1.0, 1.0]))
    assert ground_offset(*own, *other) == pytest.approx((4.3 - 1.4, UNCERTAINTY))
    few = own[0][:3], own[1][:3]
    assert np.isnan(ground_offset(*few, *other)).all()
    assert np.isnan(ground_offset(seen[:0], np.zeros(0), *other)).all()


def test_uneven_ground_level_is_less_certain() -> None:
    """The level of the map is 0.4 m higher in one group of objects, and 0.8 m in the other."""
    group = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [3, 3, 0]])
    seen = np.concatenate([group, group + [50.0, 0, 0]])
    stored = seen + np.repeat([[0, 0, 0.4], [0, 0, 0.8]], 4, axis=0)
    found = ground_offset(seen, np.ones(8), stored, np.ones(8))
    assert found == pytest.approx((0.6, np.hypot(UNCERTAINTY, 0.2)))


def test_likelihood_of_tops_and_feet_by_hand() -> None:
    """A 1 m box in the robot's view, a 2 m box in the map: feet agree at 0.1, tops at 1.1 m."""
    found = edge_likelihood(
        np.array([[5.0, 5.0, 0.0]]), np.ones(1), np.array([[5.3, 5.0, 0.6]]), np.full(1, 2.0)
    )
    for rise, fit in ((0.1, 1.0), (1.1, 1.0), (0.35, 0.25), (0.6, 1 / 25), (-1.5, 0.0)):
        at = int(np.abs(RISES - rise).argmin())
        assert found[at] == pytest.approx(np.log1p(WORTH * fit) / ALIKE_SEGMENTS), rise
    far = np.array([[5.3, 5.9, 0.6]])
    assert not edge_likelihood(np.array([[5.0, 5.0, 0.0]]), np.ones(1), far, np.ones(1)).any()


def test_height_and_variance_by_hand() -> None:
    """Centroids, edges and ground are independent likelihoods; the mean is the height."""
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    assert candidates.heights is not None
    unlike = np.abs(there.sizes[before.rows] - candidates.heights[before.queries]).mean()
    variance = max(before.covariance[2, 2], 0.01) + (unlike**2 / UNLIKE) ** 2
    places = before.pose.apply(candidates.centroids)
    seen = places, candidates.heights, there.centroids, there.sizes
    level, deviation = ground_offset(*seen)
    likelihood = edge_likelihood(*seen) - RISES**2 / 2 / variance
    density = np.exp(likelihood - np.minimum((RISES - level) ** 2 / deviation**2, 16) / 2)
    mean = np.average(RISES, weights=density)
    spread = np.average((RISES - mean) ** 2, weights=density)
    after = at_height_of_boxes(before, candidates, there, PARAMETERS)
    assert off(after) - off(before) == pytest.approx(mean)
    assert after.covariance[2, 2] == pytest.approx(spread + LEFT**2)
    np.testing.assert_array_equal(after.covariance[:2], before.covariance[:2])
    distances = np.linalg.norm(after.pose.apply(after.source) - there.centroids[after.rows], axis=1)
    np.testing.assert_allclose(after.residuals, distances, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_tops_decide_where_no_foot_is_seen(seed: int) -> None:
    """The robot sees the upper parts only, from different heights on, as with few beams."""
    random = np.random.default_rng(seed)
    tops = random.uniform(2.5, 6.0, 40)
    plan = random.uniform(-18, 18, (40, 2))
    feet = random.uniform(0.7, 2.2, 40)
    seen = np.column_stack([plan, (feet + tops) / 2])
    stored = np.column_stack([plan, tops / 2])
    rows = np.arange(40)[:, None]
    there = Boxes(TRUE.apply(stored), tops)
    candidates = Candidates(
        seen, rows, there.centroids[rows], np.ones(rows.shape), heights=tops - feet
    )
    assert off(best_of(replace(candidates, heights=None), there)) < -0.6
    assert abs(off(best_of(candidates, there))) < 0.15


def test_alike_boxes_leave_the_pose_as_it_is() -> None:
    candidates, there = two_views(reach=9.0)
    before = best_of(replace(candidates, heights=None), there)
    assert at_height_of_boxes(before, candidates, there, PARAMETERS) is before


def test_unknown_boxes_leave_the_pose_as_it_is() -> None:
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    none = replace(there, sizes=np.full(len(there.sizes), np.nan))
    assert at_height_of_boxes(before, candidates, none, PARAMETERS) is before
    assert (
        at_height_of_boxes(before, replace(candidates, heights=None), there, PARAMETERS) is before
    )
    few = there.sizes.copy()
    few[before.rows[3:]] = np.nan
    assert at_height_of_boxes(before, candidates, replace(there, sizes=few), PARAMETERS) is before


def test_pose_without_gravity_stays() -> None:
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    tilted = replace(PARAMETERS, model="se3")
    assert at_height_of_boxes(before, candidates, there, tilted) is before


def test_far_ground_level_does_not_move_the_pose() -> None:
    """The robot's boxes reach far below those of the map, as on another floor."""
    candidates, there = two_views()
    before = best_of(replace(candidates, heights=None), there)
    assert candidates.heights is not None
    deep = replace(candidates, heights=candidates.heights + 2 * FARTHEST + 8)
    after = at_height_of_boxes(before, deep, there, PARAMETERS)
    np.testing.assert_allclose(after.pose.translation, before.pose.translation, atol=1e-9)
    assert after.covariance[2, 2] > before.covariance[2, 2] + 1.0


@pytest.mark.parametrize("seed", range(3))
def test_few_boxes_below_the_ground_do_not_move_it(seed: int) -> None:
    """One reflection of forty boxes is below the level."""
    candidates, there = two_views(seed)
    low = there.centroids.copy()
    low[7, 2] -= 3.0
    assert candidates.heights is not None
    seen = TRUE.apply(candidates.centroids), candidates.heights
    right, wrong = (ground_offset(*seen, each, there.sizes)[0] for each in (there.centroids, low))
    assert wrong == pytest.approx(right, abs=0.05)


def test_order_of_the_segments_does_not_matter_on_uneven_ground() -> None:
    random = np.random.default_rng(3)
    places = random.uniform(-30, 30, (60, 3))
    places[:, 2] = 0.1 * places[:, 0] + random.normal(0, 0.3, 60)
    boxes = random.uniform(0.5, 3.0, 60)
    points, heights = places + (0.0, 0.0, 0.4), boxes + 0.5
    told = ground_offset(places, boxes, points, heights)
    for _ in range(5):
        order = random.permutation(60)
        assert ground_offset(places[order], boxes[order], points, heights) == told
