"""Known pose of a map in a merged map, from shared segments."""

from dataclasses import replace

import numpy as np
import pytest
from placecell_client import CompactMap, moved, originated
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import take

from placecell.localization import LocalizationParameters, Pose
from placecell.map_alignment import AlignmentParameters
from service.merging.join import known_pose
from tests.service.merging.merged_map_builders import driven

TRUTH = Pose.of_yaw(2.5, np.array([300.0, -800.0, 4.0]))
PARAMETERS = AlignmentParameters()


@pytest.fixture
def part() -> CompactMap:
    return originated(driven("tiny-0123456789abcdef", "west", 0, 60), "west")


def empty_merged_map(part: CompactMap, rows: np.ndarray) -> CompactMap:
    """Return a merged map of these segments, transformed and rounded as a merge does."""
    return canonical(moved(take(part, rows), TRUTH.rotation, TRUTH.translation, "site"))


def seen_from(part: CompactMap, *frames: int) -> np.ndarray:
    return np.flatnonzero(np.isin(part.frame_index, frames))


def turned(part: CompactMap) -> CompactMap:
    """Return the map with other orientations of the sensor."""
    left = np.array([0, 0, np.sqrt(0.5), np.sqrt(0.5)], np.float32)
    return replace(part, frame_orientations=np.tile(left, (len(part.frame_times), 1)))


def assert_laid(part: CompactMap, site: CompactMap, motion: str = "yaw") -> None:
    local = LocalizationParameters(model="se3" if motion == "se3" else "yaw")
    pose = known_pose(site, part, AlignmentParameters(local=local))
    assert pose is not None
    off = pose.apply(part.centroids) - TRUTH.apply(part.centroids)
    assert np.abs(off).max() < 1e-3


@pytest.mark.parametrize("motion", ["yaw", "se3"])
def test_few_shared_segments_determine_the_pose(part: CompactMap, motion: str) -> None:
    for rows in (
        np.array([0]),
        seen_from(part, 0)[:5],
        np.array([seen_from(part, 0)[0], seen_from(part, 3)[0]]),
        np.arange(len(part)),
    ):
        assert_laid(part, empty_merged_map(part, rows), motion)


def test_sensor_positions_determine_the_pose_without_orientations(part: CompactMap) -> None:
    two = np.array([seen_from(part, 0)[0], seen_from(part, 3)[0]])
    assert_laid(turned(part), empty_merged_map(part, two))
    assert known_pose(empty_merged_map(part, two[:1]), turned(part), PARAMETERS) is None


def test_moved_segments_leave_the_pose_unclear(part: CompactMap) -> None:
    rows = np.array([0, 1, 2])
    site = empty_merged_map(part, rows)
    off = replace(part, centroids=part.centroids + (0.0, 0.1, 0.0))
    assert known_pose(site, off, PARAMETERS) is None
    positions = part.frame_positions + np.arange(len(part.frame_times))[:, None]
    both = np.array([seen_from(part, 0)[0], seen_from(part, 3)[0]])
    bent = replace(part, frame_positions=positions)
    assert known_pose(empty_merged_map(part, both), bent, PARAMETERS) is None


def test_segments_of_other_times_do_not_determine_the_pose(
    part: CompactMap,
) -> None:
    few = np.arange(3)
    site = empty_merged_map(part, few)
    assert known_pose(site, take(part, np.arange(3, 30)), PARAMETERS) is None
    later = replace(part, frame_times=part.frame_times + 60.0)
    assert known_pose(site, later, PARAMETERS) is None
    assert known_pose(empty_merged_map(part, few[:0]), part, PARAMETERS) is None
