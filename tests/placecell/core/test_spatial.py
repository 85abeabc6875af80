"""Points near each other, or within a box."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.spatial import CELL, CELLS, WHOLE, evenly, near_pairs, within


def test_evenly_keeps_both_ends() -> None:
    assert evenly(np.arange(10), 4).tolist() == [0, 3, 6, 9]
    assert evenly(np.arange(3), 4).tolist() == [0, 1, 2]
    assert evenly(np.arange(0), 4).tolist() == []


def test_near_pairs_are_those_within_three_meters() -> None:
    random = np.random.default_rng(1)
    a, b = random.uniform(0, 10, (40, 3)), random.uniform(0, 10, (50, 3))
    here, there = near_pairs(a, b, 3.0, 1_000)
    expected = np.argwhere(np.linalg.norm(a[:, None] - b, axis=2) <= 3.0).tolist()
    assert sorted(zip(here.tolist(), there.tolist(), strict=True)) == [
        tuple(row) for row in expected
    ]


def test_too_many_pairs_compare_fewer_points() -> None:
    a = np.random.default_rng(2).uniform(0, 1, (300, 3))
    here, there = near_pairs(a, a, 3.0, 500)
    # 90,000 otherwise; each with each of what is left.
    assert 300 < len(here) <= 500
    assert len(here) == len(np.unique(here)) * len(np.unique(there))
    assert np.unique(here)[[0, -1]].tolist() == [0, 299]


def test_empty_points_have_no_pairs() -> None:
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


def test_within_cells_about_places_that_are_far_apart() -> None:
    places = np.array([[0.0, 0, 0], [5, 5, 0], [4_000, -3_000, 0]])
    points = np.array(
        [[1.0, 1, 0], [4_001, -3_001, 1], [2_000, -1_500, 0], [4_000, 0, 0], [0, -3_000, 0]]
    )
    assert within(points, places, 1.0).tolist() == [0, 1]
    assert within(points, places[:1], 1.0).tolist() == [0]
    assert within(points[2:], places, 1.0).tolist() == []


@given(
    seed=st.integers(0, 2**32 - 1),
    extent=st.sampled_from([1.0, 100.0, 260.0, 5_000.0, 1e5]),
    meters=st.sampled_from([0.5, 1.5, 20.0]),
)
def test_within_returns_all_near_points_and_few_others(
    seed: int, extent: float, meters: float
) -> None:
    random = np.random.default_rng(seed)
    places = random.uniform(-extent, extent, (8, 3)) * (1, random.choice([1, 0.01]), 0.01)
    about = np.repeat(places, 6, axis=0)
    # Some exactly at the limit.
    off = random.uniform(-3, 3, about.shape) * meters
    points = np.concatenate([about + off, about + meters * np.sign(off) * (1 - 1e-9)])
    apart = np.abs(points[:, None] - places)
    near = np.flatnonzero((apart <= meters).all(axis=2).any(axis=1))
    found = within(points, places, meters)
    assert set(near) <= set(found)
    assert (np.diff(found) > 0).all()
    low, high = places.min(axis=0) - meters, places.max(axis=0) + meters
    box = ((points >= low) & (points <= high)).all(axis=1)
    if (high - low)[:2].max() <= WHOLE:
        np.testing.assert_array_equal(found, np.flatnonzero(box))
    else:
        assert box[found].all()
        cell = max(CELL, 2 * meters, (high - low)[:2].max() / CELLS)
        assert (apart[found, :, :2].max(axis=2).min(axis=1) <= 2 * cell).all()
