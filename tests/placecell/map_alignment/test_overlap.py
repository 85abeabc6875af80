"""Figures of an overlap, with values by hand."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters, MapView
from placecell.map_alignment.overlap import (
    near_viewpoints,
    overlap_of,
    pairs_of_landmarks,
    part,
    should_be_seen,
)

PARAMETERS = AlignmentParameters()
NOWHERE = Pose.of_yaw(0.0, np.zeros(3))


class Table:
    """Search by a table of match probabilities of rows of a and b."""

    def __init__(self, table: Float64) -> None:
        self._table = table

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        raise NotImplementedError

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        return np.asarray(self._table[a, b])


def view(
    centroids: Sequence[tuple[float, ...]], viewpoints: Sequence[tuple[float, ...]]
) -> MapView:
    return MapView(np.array(centroids, float), np.array(viewpoints, float))


def corner(spread: float = 5.0) -> list[tuple[float, ...]]:
    """Return four landmarks that determine a pose."""
    return [(0, spread, 0), (spread, spread, 1), (spread, -spread, 0), (-spread, -spread, 2)]


def test_viewpoints_are_shared_if_the_other_robot_was_near() -> None:
    one = view([(0, 0, 0)] * 3, [(0, 0, 0), (29, 0, 0), (31, 0, 0)])
    other = view([(0, 0, 0)] * 2, [(0, 9, 0), (20, 0, 0)])
    assert near_viewpoints(one, other, PARAMETERS).tolist() == [True, True, False]
    assert near_viewpoints(one, other.take(np.arange(0)), PARAMETERS).tolist() == [False] * 3
    # Of three places two; a place counts once, however much was seen from there.
    assert part(one.take(np.array([0, 0, 0, 1, 2])), other, PARAMETERS) == pytest.approx(2 / 3)


def test_segments_near_common_viewpoints_are_expected_in_both_maps() -> None:
    one = view([(0, 19, 0), (0, 21, 0), (60, 0, 0)], [(0, 0, 0), (0, 0, 0), (60, 0, 0)])
    other = view([(0, 0, 0)], [(5, 0, 0)])
    assert should_be_seen(one, other, PARAMETERS).tolist() == [True, False, False]


def test_the_figures_of_an_overlap() -> None:
    # a: four things, the first of them seen twice, one that b does not have, and one far from
    # where b was; b: the four, a little off, and one that a does not have.
    places = corner()
    a = view([*places, (0.1, 5, 0), (9, 9, 0), (70, 0, 0)], [(0, 0, 0)] * 6 + [(70, 0, 0)])
    b = view([*places, (-9, 9, 0)], [(3, 0, 0)] * 5)
    table = np.zeros((7, 5))
    table[range(4), range(4)] = 0.8
    table[4, 0] = 0.9
    table[1, 4] = 0.1  # too unlike
    found = overlap_of(a, b, NOWHERE, Table(table), PARAMETERS)
    # The first thing by the views that look most alike.
    assert sorted(zip(found.rows_a.tolist(), found.rows_b.tolist(), strict=True)) == [
        (1, 1), (2, 2), (3, 3), (4, 0),
    ]  # fmt: skip
    assert len(found) == 4
    assert found.expected == (5, 5)
    # Residuals of some centimeters cost next to nothing.
    assert found.score == pytest.approx(0.9 + 3 * 0.8, rel=0.05)
    assert found.found == pytest.approx((found.score, found.score))
    assert found.agreement == pytest.approx(found.score / 5)
    # a was at two places, b at one; they share one.
    assert found.parts == (0.5, 1.0)
    moved = found.pose.apply(found.source)
    np.testing.assert_allclose(found.source, b.centroids[found.rows_b])
    np.testing.assert_allclose(
        np.linalg.norm(moved - a.centroids[found.rows_a], axis=1), found.residuals, atol=1e-9
    )
    assert found.covariance.shape == (4, 4)


def test_agreement_is_the_smaller_of_both_maps() -> None:
    # b saw ten more things where both were.
    a = view(corner(), [(0, 0, 0)] * 4)
    more = [(3.0 * n - 15, 9.0, 0.0) for n in range(10)]
    b = view([*corner(), *more], [(0, 0, 0)] * 14)
    found = overlap_of(a, b, NOWHERE, Table(np.eye(4, 14)), PARAMETERS)
    assert found.expected == (4, 14)
    assert found.score == pytest.approx(4.0)
    assert found.agreement == pytest.approx(4 / 14)


def test_larger_residuals_score_less() -> None:
    # Four pairs hold the pose; a fifth is half a meter off, where the kernel is a quarter.
    a = view([*corner(), (0, -5, 0)], [(0, 0, 0)] * 5)
    b = view([*corner(), (0.5, -5, 0)], [(0, 0, 0)] * 5)
    table = np.diag([1e3, 1e3, 1e3, 1e3, 1.0])  # so heavy that they alone count in the score
    found = overlap_of(a, b, NOWHERE, Table(table), PARAMETERS)
    fifth = found.residuals[found.rows_a == 4]
    assert 0.3 < fifth < 0.55
    light = replace(PARAMETERS, alike=2.0)
    without = overlap_of(a, b, NOWHERE, Table(table), light)
    assert len(without) == 4
    assert without.score == pytest.approx(4_000.0)


def test_the_pose_is_refined_from_a_meter_off() -> None:
    truth = Pose.of_yaw(2.0, np.array([900.0, -50.0, 3.0]))
    random = np.random.default_rng(0)
    places = random.uniform((-15, -15, 0), (15, 15, 3), (30, 3))
    a = MapView(places, np.zeros((30, 3)))
    b = a.moved(truth.inverse())
    start = Pose.of_yaw(0.03, np.array([0.6, -0.7, 0.0])).after(truth)
    found = overlap_of(a, b, start, Table(np.eye(30)), PARAMETERS)
    np.testing.assert_allclose(found.pose.matrix, truth.matrix, atol=1e-6)
    assert found.score == pytest.approx(30.0)
    assert found.agreement == pytest.approx(1.0)


def test_maps_apart_have_no_overlap() -> None:
    a = view(corner(), [(0, 0, 0)] * 4)
    away = Pose.of_yaw(0.0, np.array([500.0, 0.0, 0.0]))
    found = overlap_of(a, a, away, Table(np.eye(4)), PARAMETERS)
    assert len(found) == 0
    assert (found.score, found.agreement, found.expected) == (0.0, 0.0, (0, 0))
    assert found.parts == (0.0, 0.0)
    assert np.isinf(np.diag(found.covariance)).all()


def test_landmarks_are_paired_by_their_most_similar_views() -> None:
    a = view([(0, 0, 0), (0.1, 0, 0), (9, 0, 0)], [(0, 0, 0)] * 3)
    b = view([(0, 0, 0), (0.2, 0, 0)], [(0, 0, 0)] * 2)
    # Of a: thing 0 with rows 0 and 1, thing 1 with row 2. Of b: one thing.
    pairs = (
        np.array([0, 1, 0, 1, 2]),
        np.array([0, 0, 1, 1, 1]),
        np.array([0.3, 0.7, 0.9, 0.4, 0.5]),
    )
    found, rows = pairs_of_landmarks(a, b, pairs, np.array([0, 0, 1]), np.array([0, 0]))
    assert found.rows.tolist() == [0, 2]
    assert found.places.tolist() == [0, 1]
    assert found.queries.tolist() == [0, 0]
    assert rows.tolist() == [1, 1]
    assert found.weights.tolist() == [0.9, 0.5]
    np.testing.assert_array_equal(found.source, b.centroids[[1, 1]])
    np.testing.assert_array_equal(found.target, a.centroids[[0, 2]])


def test_search_tree_is_built_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Float64] = []

    def counted(points: Float64) -> cKDTree:
        made.append(points)
        return cKDTree(points)

    monkeypatch.setattr("placecell.map_alignment.map_view.cKDTree", counted)
    a, b = (view(corner(), [(x, 0, 0)] * 4) for x in (0, 3))
    for _ in range(3):
        overlap_of(a, b, NOWHERE, Table(np.eye(4)), PARAMETERS)
    # Of a itself one; of what of both is compared, and of b where each pose puts it, one each time.
    assert len(made) == 1 + 3 * 4
