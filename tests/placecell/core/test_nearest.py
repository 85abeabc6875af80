import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.nearest import nearest_within
from placecell.core.types import Float64


def by_hand(places: Float64, points: Float64, radius: float, most: int) -> list[tuple[int, int]]:
    off = np.linalg.norm(places[:, None] - points, axis=2)
    return [
        (place, point)
        for place, row in enumerate(off)
        for point in np.argsort(row, kind="stable")[:most].tolist()
        if row[point] < radius
    ]


@given(st.integers(0, 10_000), st.integers(1, 12), st.floats(-1e6, 1e6))
def test_nearest_points_match_a_full_comparison(seed: int, most: int, far: float) -> None:
    random = np.random.default_rng(seed)
    places = random.uniform(-6, 6, (30, 3)) + far
    points = random.uniform(-7, 7, (200, 3)) + far
    here, there, distances = nearest_within(places, points, 1.5, most)
    np.testing.assert_allclose(distances, np.linalg.norm(places[here] - points[there], axis=1))
    assert [*zip(here.tolist(), there.tolist(), strict=True)] == by_hand(places, points, 1.5, most)


def test_points_in_one_place_are_limited_for_each_place() -> None:
    here, there, distances = nearest_within(np.zeros((5, 3)), np.zeros((1_000, 3)), 1.5, 3)
    assert here.tolist() == np.repeat(np.arange(5), 3).tolist()
    assert there.tolist() == [0, 1, 2] * 5
    assert not distances.any()


@pytest.mark.parametrize("counts", [(0, 5), (5, 0), (0, 0)])
def test_nothing_is_near_nothing(counts: tuple[int, int]) -> None:
    places, points = (np.zeros((count, 3)) for count in counts)
    assert [len(each) for each in nearest_within(places, points, 1.5, 3)] == [0, 0, 0]
