"""Submaps and their queries, with values by hand."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.core.types import Float64, Int64
from placecell.map_alignment import AlignmentParameters, MapView
from placecell.map_alignment.submaps import Submap, candidates_of, cut, spread

PARAMETERS = AlignmentParameters()


def along_x(viewpoints: list[float]) -> MapView:
    """Return a segment 2 m to the left of each viewpoint."""
    places = np.array([[x, 0.0, 0.0] for x in viewpoints]).reshape(-1, 3)
    return MapView(places + (0.0, 2.0, 0.0), places)


def test_submap_holds_segments_of_near_viewpoints() -> None:
    submaps = cut(along_x([0, 4, 8, 10, 13, 18, 40]), PARAMETERS)
    # A stand begins a submap unless it is less than 10 m from one that did.
    assert [each.rows.tolist() for each in submaps] == [[0, 1, 2, 3], [0, 1, 2, 3, 4, 5], [6]]
    np.testing.assert_allclose(submaps[0].middle, [5.5, 2.0, 0.0])
    assert submaps[0].rows.dtype == np.int64


def test_submaps_of_a_long_path_are_evenly_spaced() -> None:
    parameters = replace(PARAMETERS, submaps=3)
    submaps = cut(along_x([10.0 * x for x in range(101)]), parameters)
    np.testing.assert_allclose([each.middle[0] for each in submaps], [5, 500, 995])


def test_map_without_viewpoints_has_no_submaps() -> None:
    assert cut(along_x([]), PARAMETERS) == []


def test_standing_robot_gives_one_submap_of_limited_size() -> None:
    (submap,) = cut(along_x([5.0] * 1_000), replace(PARAMETERS, rows=100))
    assert len(submap.rows) == 100
    assert submap.rows[[0, -1]].tolist() == [0, 999]
    assert (np.diff(submap.rows) > 0).all()


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 60))
def test_spread_points_are_apart_and_cover_all(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    points = random.uniform(0, 30, (count, 3))
    chosen = points[spread(points, 10.0)]
    apart = np.linalg.norm(chosen[:, None] - chosen, axis=2)
    assert (apart[~np.eye(len(chosen), dtype=bool)] >= 10.0).all()
    if count:
        assert (np.linalg.norm(points[:, None] - chosen, axis=2).min(axis=1) < 10.0).all()
    # And does not depend on how the points are numbered.
    shuffled = random.permutation(points)
    np.testing.assert_array_equal(shuffled[spread(shuffled, 10.0)], chosen)


class Listing:
    """Search that records the queried rows and returns rows 2 r and 2 r + 1 for each."""

    def __init__(self) -> None:
        self.asked: list[int] = []

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        self.asked += rows.tolist()
        found = np.stack([2 * rows, 2 * rows + 1], axis=1)
        return found, np.full(found.shape, 0.9)

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        raise NotImplementedError


def test_views_of_a_landmark_are_one_query() -> None:
    # Three things at x = 0, 10, 20, of six views, two, and one, 0.1 m apart.
    x = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 10.0, 10.1, 20.0]
    view, looks = along_x(x), Listing()
    other = MapView(np.arange(60.0).reshape(20, 3), np.zeros((20, 3)))
    submap = Submap(np.zeros(3), np.arange(9))
    found = candidates_of(submap, view, other, looks, PARAMETERS)
    # Four views of each: spread over the six; of two and of one some more than once,
    assert looks.asked == [0, 1, 3, 4, 6, 6, 7, 7, 8, 8, 8, 8]
    np.testing.assert_allclose(found.centroids[:, 0], [0.25, 10.05, 20.0])
    assert found.rows.tolist()[0] == [0, 1, 2, 3, 6, 7, 8, 9]
    np.testing.assert_array_equal(found.places, other.centroids[found.rows])
    # which count once.
    assert found.probabilities is not None
    assert (found.probabilities > 0).tolist() == [
        [True] * 8,
        [True, True, False, False] * 2,
        [True, True] + [False] * 6,
    ]


def test_number_of_landmark_queries_is_limited() -> None:
    looks = Listing()
    other = MapView(np.zeros((200, 3)), np.zeros((200, 3)))
    parameters = replace(PARAMETERS, landmarks=10)
    view = along_x([2.0 * x for x in range(100)])
    found = candidates_of(Submap(np.zeros(3), np.arange(100)), view, other, looks, parameters)
    assert len(found) == 10
    assert found.centroids[[0, -1], 0].tolist() == [0.0, 198.0]
    assert sorted(set(looks.asked)) == (found.centroids[:, 0] / 2).tolist()
