import warnings

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.segmentation.drive_splits import alternate_blocks, parameters_of
from tests.placecell.segment_builders import MemoryDrive, pose


def drive_along(*positions: float) -> MemoryDrive:
    return MemoryDrive([[] for _ in positions], [pose(x) for x in positions])


def check_partition(drive: MemoryDrive) -> None:
    asked = alternate_blocks(drive)
    scans = [scan for blocks in asked for block in blocks for scan in block]
    assert len(scans) == len(set(scans))
    assert sorted(scans) == list(range(len(drive)))


def test_long_drive_alternates_every_12_meters() -> None:
    drive = drive_along(*np.arange(61.0))  # 60 m: five blocks of 12 m
    maps, queries = alternate_blocks(drive)
    # The last scan, at 60 m, closes the last block.
    assert maps == [range(12), range(24, 36), range(48, 61)]
    assert queries == [range(12, 24), range(36, 48)]
    check_partition(drive)


def test_last_block_may_be_short() -> None:
    drive = drive_along(*np.arange(31.0))
    maps, queries = alternate_blocks(drive)
    assert maps == [range(12), range(24, 31)]
    assert queries == [range(12, 24)]


def test_short_drive_is_halved() -> None:
    # Ten scans on 7 m: halves of 3.5 m.
    drive = drive_along(*np.linspace(0, 7, 10))
    maps, queries = alternate_blocks(drive)
    assert maps == [range(5)]
    assert queries == [range(5, 10)]
    check_partition(drive)


def test_path_is_measured_along_the_way_not_as_the_crow_flies() -> None:
    # There and back again: it ends where it began, after 24 m.
    out = [float(x) for x in range(13)]
    drive = drive_along(*out, *reversed(out[:-1]))
    maps, queries = alternate_blocks(drive)
    assert maps == [range(12)]
    assert queries == [range(12, 25)]


def test_scans_during_a_stop_stay_in_one_block() -> None:
    drive = drive_along(*range(6), *[5.0] * 50, *range(6, 25))
    maps, queries = alternate_blocks(drive)
    assert maps == [range(62)]
    assert queries == [range(62, 75)]


def test_jump_over_a_block_still_alternates() -> None:
    drive = drive_along(0, 1, 2, 30, 31, 32)
    maps, queries = alternate_blocks(drive)
    assert maps == [range(3)]
    assert queries == [range(3, 6)]
    check_partition(drive)


@pytest.mark.parametrize("scans", [1, 2, 20])
def test_standing_drive_has_no_query_block(scans: int) -> None:
    drive = drive_along(*[4.0] * scans)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        maps, queries = alternate_blocks(drive)
    assert maps == [range(scans)]
    assert queries == []


@pytest.mark.parametrize("seed", range(10))
def test_every_scan_is_in_one_block_on_random_drives(seed: int) -> None:
    generator = np.random.default_rng(seed)
    steps = generator.exponential(generator.uniform(0.1, 3), 80)
    check_partition(drive_along(*np.cumsum(steps)))


@pytest.mark.parametrize(
    ("lengths", "window", "step"),
    [
        ((222, 17, 13, 11, 11, 10, 11, 5), 5, 2),  # a stub at the end
        ((37, 27, 30, 22, 20, 18), 10, 2),
        ((5, 5), 2, 2),
        ((1, 1), 1, 1),
        ((9, 8, 9, 9, 1), 4, 2),
    ],
)
def test_the_window_is_that_of_a_usual_block(
    lengths: tuple[int, ...], window: int, step: int
) -> None:
    found = parameters_of([range(length) for length in lengths], PROTOCOL_V1)
    assert (found.accumulated_scans, found.frame_step) == (window, step)
