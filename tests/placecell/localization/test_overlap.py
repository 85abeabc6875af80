import numpy as np
import pytest

from placecell.core.types import Float64, Int64
from placecell.localization.candidates import Candidates
from placecell.localization.overlap import (
    BEEN,
    MOST_ROWS,
    ExplainedShares,
    SegmentsInMap,
    explained_shares,
)
from placecell.localization.pose import Pose

SEEN = np.array([[0.0, 0, 0], [10, 0, 0], [20, 0, 0], [30, 0, 0]])
"""Centroids of the robot's segments, in its own frame."""

SHIFT = np.array([100.0, 50, 2])
"""Position of the robot's frame in the map."""


class Everything:
    """Map that returns all of its segments."""

    def __init__(self, centroids: Float64) -> None:
        self.centroids = centroids

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        return np.arange(len(self.centroids)), self.centroids

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        raise AssertionError("positions only")


def candidates_of(seen: Float64) -> Candidates:
    none = np.zeros((len(seen), 0))
    return Candidates(seen, none.astype(np.int64), np.zeros((len(seen), 0, 3)), none)


def shares(seen: Float64, there: Float64) -> ExplainedShares:
    return explained_shares(Pose.of_yaw(0.0, SHIFT), candidates_of(seen), Everything(there))


def in_map(seen: Float64, there: Float64) -> SegmentsInMap:
    return SegmentsInMap.of(Pose.of_yaw(0.0, SHIFT), candidates_of(seen), Everything(there))


def share(seen: Float64, there: Float64) -> float:
    found = shares(seen, there)
    assert found.in_plan == found.in_space
    return found.in_plan


def test_map_with_all_segments_explains_them() -> None:
    assert share(SEEN, SEEN + SHIFT) == 1.0


def test_shares_by_hand() -> None:
    there = np.array(
        [
            [0.5, 0, 0],  # the first segment, from another viewpoint
            [0.0, 0.9, 0],  # a second view of it
            [10, 1.1, 0],  # too far from the second segment to be the same
            [20, 0, 3],  # the third one, which the map's sensor saw up to its top
            [30, 0.8, 0.2],  # the fourth one in space, but too far in plan
        ]
    )
    assert shares(SEEN, there + SHIFT) == ExplainedShares(in_plan=2 / 4, in_space=2 / 4)
    assert shares(SEEN[2:3], there + SHIFT) == ExplainedShares(in_plan=1.0, in_space=0.0)
    assert shares(SEEN[3:], there + SHIFT) == ExplainedShares(in_plan=0.0, in_space=1.0)


def test_share_of_poses_beside_is_subtracted() -> None:
    # Two of four have a segment. Of 32 positions 3 m beside, two have one.
    there = np.array([[0.0, 0, 0], [10, 0, 0], [20, 3, 0], [30, -3, 0]])
    assert share(SEEN, there + SHIFT) == pytest.approx((2 / 4 - 2 / 32) / (1 - 2 / 32))


def test_dense_map_explains_nothing() -> None:
    line = np.arange(-10.0, 41.0, 0.5)
    grid = np.array([[x, y, 0.0] for x in line for y in np.arange(-10.0, 11.0, 0.5)])
    assert share(SEEN, grid + SHIFT) == 0.0


def test_without_segments_nothing_is_explained() -> None:
    assert share(SEEN, np.zeros((0, 3))) == 0.0
    assert share(SEEN, SEEN + 500.0) == 0.0
    assert share(np.zeros((0, 3)), SEEN) == 0.0


def test_values_that_are_not_finite_do_not_count() -> None:
    seen = np.vstack([SEEN, [[np.nan, 0, 0]]])
    assert share(seen, np.vstack([SEEN + SHIFT, [[np.nan, 0, 0]]])) == 1.0


def test_large_map_is_thinned_evenly() -> None:
    random = np.random.default_rng(0)
    there = SEEN[random.integers(4, size=4 * MOST_ROWS)] + SHIFT
    assert share(SEEN, there + random.uniform(-0.1, 0.1, there.shape)) == 1.0


def test_segments_beyond_the_edge_of_a_map_do_not_count() -> None:
    # The map ends between the second and the third segment.
    found = in_map(SEEN, SEEN[:2] + SHIFT)
    assert found.candidates.centroids.tolist() == SEEN[:2].tolist()
    assert found.explained.in_plan == 1.0
    assert share(SEEN, SEEN[:2] + SHIFT) == 0.5


def test_unexplained_segment_within_the_map_counts() -> None:
    there = np.vstack([SEEN[:3] + SHIFT, SEEN[3:] + SHIFT + (0.0, BEEN - 0.1, 50.0)])
    found = in_map(SEEN, there)
    assert len(found.candidates) == 4
    assert found.explained.in_plan == pytest.approx(3 / 4)


def test_pose_outside_the_map_has_no_segments_in_it() -> None:
    for seen in (SEEN, SEEN[:0], np.full((3, 3), np.nan)):
        found = in_map(seen, SEEN + 500.0)
        assert len(found.candidates) == 0
        assert found.usable == 0
        assert found.explained == ExplainedShares()
