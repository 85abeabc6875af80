"""Prepared recordings are accepted for their own drive only."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.poses.queries import Pair
from evaluation.poses.recordings import recording_of
from placecell.core.parameters import PROTOCOL_V1
from placecell.datasets import Drive, open_drive
from placecell.segmentation.pipeline import record
from tests.placecell.segment_builders import box, pose, write_odometry


def street(folder: Path, scans: int = 6, further: float = 0.0) -> Drive:
    """Return a drive along boxes, with points in the sensor's frame."""
    boxes = np.concatenate([box((x, 5.0, -1.5), (2, 1, 3)) for x in (0.0, 6.0, 12.0)])
    at = [index + further for index in range(scans)]
    seen = [boxes - np.array([x, 0, 0]) for x in at]
    return open_drive(write_odometry(folder, seen, [pose(index) for index in range(scans)]))


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    return street(tmp_path / "robot")


@pytest.fixture
def prepared(drive: Drive, tmp_path: Path) -> Path:
    file = tmp_path / "robot.safetensors"
    record(drive, PROTOCOL_V1.for_drive(len(drive))).save(file)
    return file


def test_prepared_recording_equals_a_new_one(drive: Drive, prepared: Path) -> None:
    made, read = recording_of(drive), recording_of(drive, prepared=prepared)
    assert len(made.segments) > 0
    np.testing.assert_array_equal(made.segments.points, read.segments.points)
    assert made.parameters == read.parameters


@pytest.mark.parametrize(("scans", "further"), [(5, 0.0), (6, 0.5)])
def test_recording_of_another_drive_is_refused(
    prepared: Path, tmp_path: Path, scans: int, further: float
) -> None:
    other = street(tmp_path / "other", scans, further)
    with pytest.raises(ValueError, match="is not a recording of"):
        recording_of(other, prepared=prepared)


def test_recording_with_other_parameters_is_refused(
    drive: Drive, prepared: Path, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match="--every 3"):
        recording_of(drive, every=3, prepared=prepared)
    wider = tmp_path / "wider.safetensors"
    record(drive, replace(PROTOCOL_V1.for_drive(len(drive)), growing_radius=0.5)).save(wider)
    with pytest.raises(ValueError, match="Prepare the drive again, or"):
        recording_of(drive, prepared=wider)


def test_file_that_is_no_recording_is_refused(drive: Drive, tmp_path: Path) -> None:
    file = tmp_path / "text.safetensors"
    file.write_text("no recording")
    with pytest.raises(ValueError, match="not a recording"):
        recording_of(drive, prepared=file)


def test_recording_for_a_drive_in_blocks_is_refused(drive: Drive, prepared: Path) -> None:
    with pytest.raises(ValueError, match="blocks"):
        Pair.of(drive.folder, prepared=(prepared, None))
