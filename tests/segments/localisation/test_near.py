"""Points that lie near each other, or within a box."""

import numpy as np

from segments.localisation.near import evenly, near_pairs, within


def test_evenly_keeps_both_ends() -> None:
    assert evenly(np.arange(10), 4).tolist() == [0, 3, 6, 9]
    assert evenly(np.arange(3), 4).tolist() == [0, 1, 2]
    assert evenly(np.arange(0), 4).tolist() == []


def test_near_pairs_are_those_within_three_metres() -> None:
    random = np.random.default_rng(1)
    a, b = random.uniform(0, 10, (40, 3)), random.uniform(0, 10, (50, 3))
    here, there = near_pairs(a, b, 3.0, 1_000)
    expected = np.argwhere(np.linalg.norm(a[:, None] - b, axis=2) <= 3.0).tolist()
    assert sorted(zip(here.tolist(), there.tolist(), strict=True)) == [
        tuple(row) for row in expected
    ]


def test_where_pairs_are_too_many_fewer_points_are_compared() -> None:
    a = np.random.default_rng(2).uniform(0, 1, (300, 3))
    here, there = near_pairs(a, a, 3.0, 500)
    # 90,000 otherwise; each with each of what is left.
    assert 300 < len(here) <= 500
    assert len(here) == len(np.unique(here)) * len(np.unique(there))
    assert np.unique(here)[[0, -1]].tolist() == [0, 299]


def test_no_points_are_near_none() -> None:
    nothing, some = np.zeros((0, 3)), np.zeros((2, 3))
    for a, b in ((nothing, some), (some, nothing), (nothing, nothing)):
        here, there = near_pairs(a, b, 3.0, 10)
        assert len(here) == len(there) == 0


def test_within_a_box_about_places() -> None:
    places = np.array([[0.0, 0, 0], [10, 2, 1]])
    points = np.array(
        [[-1.0, 0, 0], [11, 3, 2], [-1.1, 0, 0], [5, 3.1, 0], [5, 1, -1.1], [5, 1, 1]]
    )
    assert within(points, places, 1.0).tolist() == [0, 1, 5]
