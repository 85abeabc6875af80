import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.segmentation.grouping import Grouper, nearest_pairs


def at(*xs: float) -> Float64:
    """Return centroids on the x axis."""
    return np.array([[x, 0.0, 0.0] for x in xs]).reshape(-1, 3)


def pairs(a: Float64, b: Float64, limit: float = 1.5) -> dict[int, int]:
    left, right = nearest_pairs(a, b, limit)
    return dict(zip(left.tolist(), right.tolist(), strict=True))


def test_groups_are_numbered_in_order_of_appearance() -> None:
    grouper = Grouper(1.5)
    assert grouper.add_capture(at(0, 10, 20)).tolist() == [0, 1, 2]
    assert grouper.add_capture(at(30, 20.1, 0.1)).tolist() == [3, 2, 0]
    assert grouper.add_capture(at(10, 0.2)).tolist() == [4, 0]
    assert grouper.count == 5


def test_group_follows_a_drifting_centroid() -> None:
    grouper = Grouper(1.5)
    numbers = [grouper.add_capture(at(1.4 * frame)).tolist() for frame in range(8)]
    assert numbers == [[0]] * 8


def test_group_ends_at_a_capture_without_it() -> None:
    grouper = Grouper(1.5)
    grouper.add_capture(at(0, 10))
    assert grouper.add_capture(at(10)).tolist() == [1]
    assert grouper.add_capture(at(0, 10)).tolist() == [2, 1]


def test_empty_capture_ends_every_group() -> None:
    grouper = Grouper(1.5)
    assert grouper.add_capture(at(0)).tolist() == [0]
    assert grouper.add_capture(at()).tolist() == []
    assert grouper.add_capture(at(0)).tolist() == [1]


def test_limit_is_inclusive() -> None:
    # Exactly 1.5 m is the same group; the next number beyond it is not.
    assert pairs(at(0), at(1.5)) == {0: 0}
    assert pairs(at(0), at(np.nextafter(1.5, 2))) == {}


def test_distance_is_measured_in_space() -> None:
    assert pairs(at(0), np.array([[0.9, 0.9, 0.9]])) == {}  # 1.56 m
    assert pairs(at(0), np.array([[0.8, 0.8, 0.8]])) == {0: 0}  # 1.39 m


def test_centroid_that_has_not_moved_is_paired() -> None:
    assert pairs(at(3, 7), at(7, 3)) == {0: 1, 1: 0}


def test_one_to_one() -> None:
    # Two come from where one was: the nearer takes its group, the other begins one.
    grouper = Grouper(1.5)
    grouper.add_capture(at(0))
    assert grouper.add_capture(at(-0.6, 0.5)).tolist() == [1, 0]


def test_nearest_pair_first_even_if_another_loses_its_only_mate() -> None:
    # a0 is 1.0 from b0; a1 is 0.4 from b0 and 1.3 from b1: a1 takes b0, a0 gets none.
    assert pairs(at(0, 1.4), at(1.0, 2.7)) == {1: 0}


def test_point_without_its_nearest_gets_the_next() -> None:
    assert pairs(at(0, 0.2), at(0.3, -1.0)) == {1: 0, 0: 1}


def slow_pairs(a: Float64, b: Float64, limit: float) -> dict[int, int]:
    distances = {
        (i, j): float(np.linalg.norm(p - q)) for i, p in enumerate(a) for j, q in enumerate(b)
    }
    found: dict[int, int] = {}
    while distances:
        i, j = min(distances, key=lambda pair: distances[pair])
        if distances[i, j] > limit:
            break
        found[i] = j
        distances = {pair: d for pair, d in distances.items() if pair[0] != i and pair[1] != j}
    return found


@pytest.mark.parametrize("seed", range(5))
def test_against_slow_reference(seed: int) -> None:
    generator = np.random.default_rng(seed)
    a, b = generator.uniform(0, 6, (25, 3)), generator.uniform(0, 6, (30, 3))
    expected = slow_pairs(a, b, 1.5)
    assert pairs(a, b) == expected
    assert len(expected) > 5


def test_ties_are_resolved_by_order() -> None:
    assert pairs(at(0), at(-1, 1)) == {0: 0}
    assert pairs(at(-1, 1), at(0)) == {0: 0}
