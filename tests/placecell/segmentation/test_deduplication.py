import numpy as np
import pytest

from placecell.core.types import Bool, UInt8
from placecell.segmentation.deduplication import keep_distinct

BITS = 38 * 38 * 18


def packed(*grids: Bool) -> UInt8:
    return np.packbits(np.stack(grids), axis=1)


def grid(*occupied: int | range) -> Bool:
    bits = np.zeros(BITS, dtype=bool)
    for some in occupied:
        bits[some if isinstance(some, int) else list(some)] = True
    return bits


@pytest.mark.parametrize(("differing", "stays"), [(0, False), (49, False), (50, True), (51, True)])
def test_duplicate_below_th_H_of_50(differing: int, stays: bool) -> None:
    grids = packed(grid(range(100)), grid(range(100 + differing)))
    assert keep_distinct(grids, np.array([3, 3]), th_H=50).tolist() == [True, stays]


def test_voxels_gained_and_lost_both_count() -> None:
    # 25 gone and 25 new are 50.
    grids = packed(grid(range(100)), grid(range(25, 125)), grid(range(24, 124)))
    assert keep_distinct(grids[[0, 1]], np.array([0, 0]), 50).all()
    assert keep_distinct(grids[[0, 2]], np.array([0, 0]), 50).tolist() == [True, False]


def test_duplicates_are_found_only_within_groups() -> None:
    same = grid(range(80))
    groups = np.array([0, 1, 0, 2, 1])
    kept = keep_distinct(packed(same, same, same, same, same), groups, 50)
    assert kept.tolist() == [True, True, False, True, False]


def test_greedy_in_time_order() -> None:
    # Each is 30 from the last: the second falls to the first; the third, 60 from the first, stays,
    # although the second, now gone, is only 30 from it.
    grids = packed(*(grid(range(30 * step)) for step in range(5)))
    kept = keep_distinct(grids, np.zeros(5, np.int64), 50)
    assert kept.tolist() == [True, False, True, False, True]


def test_compared_with_all_that_stay_not_with_the_last() -> None:
    first, other = grid(range(100)), grid(range(500, 600))
    kept = keep_distinct(packed(first, other, first), np.zeros(3, np.int64), 50)
    assert kept.tolist() == [True, True, False]


def slow(grids: list[Bool], groups: list[int], th_H: int) -> list[bool]:
    kept: list[bool] = []
    for index, mine in enumerate(grids):
        before = [
            sum(a != b for a, b in zip(grids[other].tolist(), mine.tolist(), strict=True))
            for other in range(index)
            if kept[other] and groups[other] == groups[index]
        ]
        kept.append(all(differing >= th_H for differing in before))
    return kept


def test_against_slow_reference() -> None:
    generator = np.random.default_rng(0)
    base = generator.random((3, 200)) < 0.3
    groups = generator.integers(0, 3, 60)
    flips = generator.random((60, 200)) < generator.uniform(0, 0.1, (60, 1))
    grids = list(base[groups] ^ flips)
    expected = slow(grids, groups.tolist(), 20)
    assert keep_distinct(packed(*grids), groups, 20).tolist() == expected
    assert 10 < sum(expected) < 50  # the case is worth something


def test_no_segments() -> None:
    assert keep_distinct(np.zeros((0, 10), np.uint8), np.zeros(0, np.int64), 50).shape == (0,)
