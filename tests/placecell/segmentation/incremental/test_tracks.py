import numpy as np
import pytest

from placecell.segmentation.incremental.tracks import (
    Track,
    label_voxels,
    persistent_ids,
    shared_voxels,
)


def ids_of(
    pairs: list[tuple[int, int, int]], before: list[int], regions: int
) -> tuple[list[int], int]:
    """Return the ids of regions from (region, region before, shared voxels); new ids from 100."""
    columns = np.array(pairs, dtype=np.int64).reshape(-1, 3).T
    ids, next_id = persistent_ids(
        columns[0], columns[1], columns[2], np.array(before, dtype=np.int64), regions, 100
    )
    return ids.tolist(), next_id


def test_regions_that_grow_keep_their_ids() -> None:
    assert ids_of([(0, 1, 50), (1, 0, 70)], [4, 9], 2) == ([9, 4], 100)


def test_new_regions_get_new_ids() -> None:
    assert ids_of([(1, 0, 5)], [4], 3) == ([100, 4, 101], 102)
    assert ids_of([], [], 2) == ([100, 101], 102)


def test_region_with_most_of_the_merged_voxels_passes_its_id_on() -> None:
    assert ids_of([(0, 0, 60), (0, 1, 61)], [4, 9], 1) == ([9], 100)


def test_part_with_most_of_the_voxels_keeps_the_id_of_a_region_that_splits() -> None:
    assert ids_of([(0, 0, 30), (1, 0, 31)], [4], 2) == ([100, 4], 101)


def test_older_id_wins_a_tie() -> None:
    assert ids_of([(0, 1, 60), (0, 0, 60)], [4, 9], 1) == ([4], 100)


def test_part_that_lost_its_first_id_takes_the_next_best() -> None:
    # Region 1 shares more with id 4 than with id 9, but region 0 shares even more with id 4.
    assert ids_of([(0, 0, 90), (1, 0, 40), (1, 1, 30)], [4, 9], 2) == ([4, 9], 100)


def test_shared_voxels_by_hand() -> None:
    labels = np.array([1, 1, 0, -1, 2, 2, -1, -1], dtype=np.int32)
    regions, before, shared = shared_voxels(labels, np.array([4, 6, 8]), 3)
    found = sorted(zip(regions.tolist(), before.tolist(), shared.tolist(), strict=True))
    assert found == [(0, 0, 1), (0, 1, 2), (1, 2, 2)]


def test_no_regions_share_no_voxels() -> None:
    nothing = np.zeros(0, dtype=np.int64)
    assert [len(column) for column in shared_voxels(nothing.astype(np.int32), nothing, 0)] == [
        0
    ] * 3


def test_labels_are_overwritten() -> None:
    labels = np.full(6, 5, dtype=np.int32)
    label_voxels(labels, np.array([4, 0, 2]), np.array([1, 3]))
    assert labels.tolist() == [1, -1, 1, -1, 0, -1]


@pytest.mark.parametrize(
    ("clear", "voxels", "is_clear", "improved"),
    [
        (True, 104, True, False),
        (True, 105, True, True),
        (True, 500, False, False),
        (False, 10, True, True),
        (False, 120, False, True),
        (False, 90, False, False),
    ],
)
def test_better_view_is_clear_of_the_border_then_larger(
    clear: bool, voxels: int, is_clear: bool, improved: bool
) -> None:
    nothing = np.zeros((0, 3), dtype=np.float32)
    track = Track(100, clear, 0, np.zeros(3, np.float32), nothing)
    assert track.is_improved_by(voxels, is_clear) == improved
