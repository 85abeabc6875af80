import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.peers.exchange import Cloud
from benchmarks.peers.systems.scan_context import (
    ScanContextParameters,
    ScanContexts,
    distances,
    ring_key,
    scan_context,
)

SMALL = ScanContextParameters(rings=2, sectors=4, radius=20.0, sensor_height=2.0)


def cloud(*rows: tuple[float, float, float]) -> Cloud:
    return np.array(rows, dtype=np.float32).reshape(-1, 3)


def polar(distance: float, degrees: float, height: float) -> tuple[float, float, float]:
    angle = np.radians(degrees)
    return distance * np.cos(angle), distance * np.sin(angle), height


def scene(seed: int, count: int = 400) -> Cloud:
    """Return points of poles of different heights around the sensor."""
    random = np.random.default_rng(seed)
    distance, degrees = random.uniform(3, 70, count), random.uniform(0, 360, count)
    heights = random.uniform(-1.5, 8, count)
    return cloud(*map(polar, distance, degrees, heights))


def test_context_holds_the_largest_height_of_each_cell() -> None:
    context = scan_context(
        cloud(
            polar(5, 10, 1.0),  # ring 0, sector 0
            polar(6, 80, 3.0),  # the same cell: the largest height counts
            polar(7, 45, -1.0),
            polar(15, 100, 0.5),  # ring 1, sector 1
            polar(9.99, 350, -1.9),  # ring 0, sector 3
            polar(20.01, 200, 9.0),  # beyond the radius
        ),
        SMALL,
    )
    expected = [[5.0, 0, 0, 0.1], [0, 2.5, 0, 0]]
    assert context == pytest.approx(np.array(expected), abs=1e-6)


def test_angle_just_below_a_full_turn_is_in_the_last_sector() -> None:
    assert scan_context(cloud((5.0, -0.01, 1.0)), SMALL)[0].tolist() == [0, 0, 0, 3]
    # Rounded to a full turn, it is in the first sector, not one beyond the last.
    assert scan_context(cloud((5.0, -1e-12, 1.0)), SMALL)[0].sum() == 3


def test_default_parameters_are_those_of_the_paper() -> None:
    parameters = ScanContextParameters()
    assert (parameters.rings, parameters.sectors, parameters.radius) == (20, 60, 80.0)
    assert scan_context(cloud()).shape == (20, 60)
    assert not scan_context(cloud()).any()


def test_ring_key_is_the_share_of_occupied_sectors() -> None:
    context = np.array([[5.0, 0, 0, 0.1], [0, 2.5, 0, 0]])
    assert ring_key(context).tolist() == [0.5, 0.25]


def test_distances_equal_those_computed_by_hand() -> None:
    # Columns of the query: (1, 0), (0, 1), none; of the candidate: (0, 2), none, (1, 1).
    query = np.array([[1.0, 0, 0], [0, 1, 0]])
    candidate = np.array([[0.0, 0, 1], [2, 0, 1]])
    half = np.sqrt(0.5)
    expected = [
        1 - 0,  # (1, 0) against (0, 2); the second has no counterpart
        1 - half,  # (0, 1) against (1, 1); the first has none
        1 - (half + 1) / 2,  # (1, 0) against (1, 1), (0, 1) against (0, 2)
    ]
    assert distances(query, candidate) == pytest.approx(np.array(expected))


def test_contexts_without_common_sectors_have_the_largest_distance() -> None:
    empty, full = np.zeros((2, 3)), np.ones((2, 3))
    assert distances(empty, full).tolist() == [1, 1, 1]


@given(st.integers(0, 59), st.integers(0, 1000))
def test_rotation_of_the_query_shifts_the_distances(turn: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    query, candidate = (random.uniform(0, 5, (20, 60)) for _ in range(2))
    turned = distances(np.roll(query, -turn, axis=1), candidate)
    assert turned == pytest.approx(np.roll(distances(query, candidate), turn))


def test_context_has_distance_zero_from_itself() -> None:
    context = scan_context(scene(0))
    apart = distances(context, context)
    assert apart[0] == pytest.approx(0)
    assert apart[1:].min() > 0.1


def test_local_map_of_the_query_is_found_first() -> None:
    contexts = ScanContexts([scene(seed) for seed in range(30)])
    for frame in (0, 17, 29):
        best = contexts.find(scene(frame))[0]
        assert (best.frame, best.yaw) == (frame, 0.0)
        assert best.distance == pytest.approx(0)


def test_number_of_candidates_is_limited_by_the_map() -> None:
    few = ScanContexts([scene(0), scene(1)])
    assert sorted(found.frame for found in few.find(scene(5))) == [0, 1]
    many = ScanContexts([scene(seed) for seed in range(15)])
    found = many.find(scene(20))
    assert len(found) == 10
    assert [one.distance for one in found] == sorted(one.distance for one in found)
