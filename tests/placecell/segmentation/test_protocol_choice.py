"""The protocol of a drive follows from its segments per capture."""

from pathlib import Path

import numpy as np
import pytest

from cli.evaluate_poses import segmented
from cli.sources import protocol_named
from evaluation.poses.queries import Pair
from evaluation.poses.recordings import recording_of
from placecell.core.parameters import PROTOCOL_SPARSE, PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.segmentation.protocol_choice import FEWEST, is_sparse
from placecell.segmentation.recording import Recording
from tests.evaluation.test_recordings import street


def recorded(counts: list[int]) -> Recording:
    """Return a recording with so many segments in each capture."""
    total = sum(counts)
    numbers = np.zeros(total, dtype=np.int64)
    return Recording(
        name="drive",
        parameters=PROTOCOL_V1,
        segments=Segments.of([np.zeros((1, 3), np.float32)] * total, np.zeros((total, 3))),
        captures=np.repeat(2 * np.arange(len(counts)), counts),
        groups=numbers,
        distinct=numbers == 0,
        scans=2 * len(counts),
        scan_hashes=(),
        path_length=0.0,
    )


@pytest.mark.parametrize(
    ("counts", "expected"),
    [
        ([FEWEST - 1], True),
        ([FEWEST], False),
        ([0, 100, 100], False),
        ([0, 0, 100], True),  # captures without segments count
    ],
)
def test_median_capture_decides(counts: list[int], expected: bool) -> None:
    assert is_sparse([recorded(counts)]) == expected


def test_captures_of_all_recordings_count() -> None:
    assert is_sparse([recorded([100]), recorded([1, 1])])
    assert not is_sparse([recorded([100, 100]), recorded([1])])


def test_protocol_v1_is_unchanged() -> None:
    assert Parameters() == PROTOCOL_V1
    assert (PROTOCOL_V1.growing_radius, PROTOCOL_V1.min_points) == (0.25, 100)
    assert PROTOCOL_SPARSE.for_drive(10).protocol == "sparse"


@pytest.mark.parametrize(
    ("name", "can_change", "expected"),
    [
        ("auto", True, "sparse"),
        ("auto", False, "v1"),
        ("v1", True, "v1"),
        ("sparse", False, "sparse"),
    ],
)
def test_both_drives_are_segmented_by_one_protocol(
    name: str, can_change: bool, expected: str, tmp_path: Path
) -> None:
    few = street(tmp_path / "few")

    def made(protocol: Parameters) -> Pair:
        return Pair.of(few.folder, protocol=protocol)

    pair = segmented(made, name, can_change)
    for robot in (pair.mapper, pair.asker):
        assert {each.parameters.protocol for each in robot.recordings} == {expected}


def test_unknown_protocol_is_refused() -> None:
    with pytest.raises(ValueError, match="'dense': expected v1 or sparse"):
        protocol_named("dense")


def test_recording_of_another_protocol_is_refused(tmp_path: Path) -> None:
    drive = street(tmp_path / "robot")
    file = tmp_path / "robot.safetensors"
    recording_of(drive, protocol=PROTOCOL_SPARSE).save(file)
    assert recording_of(drive, prepared=file, protocol=PROTOCOL_SPARSE).parameters.min_points == 20
    with pytest.raises(ValueError, match="protocol sparse"):
        recording_of(drive, prepared=file)
