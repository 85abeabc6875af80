from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.core.types import Float64, Int64
from town.streets.network import Network
from town.streets.planner import Planner, Way
from town.streets.postman import postman


@pytest.fixture(scope="module")
def planner() -> Planner:
    return Planner.of(Network.draw(seed=7, meters=3000.0))


def turns_on_the_spot(way: Way) -> bool:
    return any(one == three for (one, _), (_, three) in pairwise(pairwise(way)))


def streets_of(planner: Planner, way: Way) -> list[int]:
    return [arc % len(planner.network.streets) for arc in planner.arcs_of(way)]


def test_every_street_is_taken(planner: Planner) -> None:
    way = planner.every_street()
    assert set(streets_of(planner, way)) == set(range(len(planner.network.streets)))
    assert way[0] == way[-1]
    assert not turns_on_the_spot(way)
    assert planner.meters(way) < 1.35 * planner.network.meters()


def test_between_takes_the_shortest_way(planner: Planner) -> None:
    way = planner.between((0, 0), (3, 4))
    assert (way[0], way[-1]) == ((0, 0), (3, 4))
    count = len(planner.network.joined)
    distance = np.full((count, count), np.inf)
    for (one, other), length in zip(planner.network.streets, planner.network.lengths, strict=True):
        distance[one, other] = distance[other, one] = length
    for middle in range(count):  # Floyd and Warshall's, by hand
        distance = np.minimum(distance, distance[:, middle, None] + distance[None, middle])
    start, goal = planner.network.number(way[0]), planner.network.number(way[-1])
    assert planner.meters(way) == pytest.approx(distance[start, goal])


def test_between_needs_two_crossings_of_the_town(planner: Planner) -> None:
    with pytest.raises(ValueError, match="twice"):
        planner.between((1, 1), (1, 1))
    with pytest.raises(ValueError, match="no crossing"):
        planner.between((1, 1), (99, 0))


@given(length=st.floats(1.0, 3000.0), seed=st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_wander_is_as_long_as_asked(planner: Planner, length: float, seed: int) -> None:
    way = planner.wander(length, np.random.default_rng(seed))
    assert length <= planner.meters(way) < length + 100.0
    assert not turns_on_the_spot(way)


@given(length=st.floats(1.0, 2000.0), laps=st.integers(1, 3), seed=st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_a_loop_ends_with_the_street_it_begins_with(
    planner: Planner, length: float, laps: int, seed: int
) -> None:
    way = planner.loop(length, np.random.default_rng(seed), laps)
    assert way[:2] == way[-2:]
    assert not turns_on_the_spot(way)
    lap = planner.meters(way[:-1]) / laps
    assert lap >= length
    streets = (len(way) - 2) // laps
    assert way[:streets] * laps == way[:-2]


def test_a_loop_has_laps(planner: Planner) -> None:
    with pytest.raises(ValueError, match="one lap or more"):
        planner.loop(500.0, np.random.default_rng(0), laps=0)


@pytest.mark.parametrize(
    ("way", "message"),
    [
        ([(0, 0)], "two crossings"),
        ([(0, 0), (1, 1)], "no street joins"),
        ([(0, 0), (0, 1), (0, 0)], "turns on the spot at"),
    ],
)
def test_invalid_paths_are_refused(planner: Planner, way: Way, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        planner.arcs_of(way)


def shortest(pairs: list[int], distance: Float64) -> float:
    """Return the smallest total distance of a pairing, by trying all."""
    if not pairs:
        return 0.0
    first, *rest = pairs
    return min(
        float(distance[first, other]) + shortest([one for one in rest if one != other], distance)
        for other in rest
    )


def length_by_hand(streets: Int64, lengths: Float64) -> float:
    count = int(streets.max()) + 1
    distance = np.full((count, count), np.inf)
    np.fill_diagonal(distance, 0.0)
    for (one, other), length in zip(streets, lengths, strict=True):
        distance[one, other] = distance[other, one] = length
    for middle in range(count):
        distance = np.minimum(distance, distance[:, middle, None] + distance[None, middle])
    odd = np.flatnonzero(np.bincount(streets.ravel()) % 2)
    return float(lengths.sum()) + shortest(odd.tolist(), distance)


def check_round(streets: Int64, lengths: Float64) -> None:
    count = len(streets)
    arcs = np.concatenate([streets, streets[:, ::-1]])
    tour = postman(streets, lengths)
    assert {arc % count for arc in tour} == set(range(count))
    for one, other in pairwise([*tour, tour[0]]):
        assert arcs[one, 1] == arcs[other, 0]
        assert abs(one - other) != count  # no turn on the spot
    assert lengths[np.array(tour) % count].sum() == pytest.approx(length_by_hand(streets, lengths))


def test_a_square_with_a_diagonal() -> None:
    """Both ends of the diagonal are odd: it is used twice if it is shorter than two sides."""
    streets = np.array([[0, 1], [1, 2], [2, 3], [0, 3], [0, 2]])
    for diagonal in (1.4, 2.6):
        check_round(streets, np.array([1.0, 1.1, 1.2, 1.3, diagonal]))


def test_an_even_network_is_taken_once() -> None:
    """Two triangles have a common crossing."""
    streets = np.array([[0, 1], [1, 2], [0, 2], [2, 3], [3, 4], [2, 4]])
    assert sorted(arc % 6 for arc in postman(streets, np.ones(6))) == list(range(6))
    check_round(streets, np.ones(6))


@given(seed=st.integers(0, 10_000), meters=st.floats(1.0, 1500.0))
@settings(max_examples=40, deadline=None)
def test_tour_is_the_shortest(seed: int, meters: float) -> None:
    network = Network.draw(seed, meters)
    check_round(network.streets, network.lengths)
