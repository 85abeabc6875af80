"""Tests of the labels of points in SemanticKITTI's files."""

from pathlib import Path

import numpy as np
import pytest

from placecell.core.segment_classes import CLASSES
from placecell.datasets import DriveError, KittiOdometry
from placecell.datasets.labels import (
    CODES,
    NO_CLASS,
    class_of_code,
    has_labels,
    read_codes,
    write_codes,
)

POINTS = np.array([[5, 0, 0, 1], [0, 0, 0, 0], [6, 1, 0, 1], [np.nan, 1, 1, 1]], np.float32)


@pytest.fixture
def drive(tmp_path: Path) -> KittiOdometry:
    (tmp_path / "velodyne").mkdir()
    for scan in range(2):
        (tmp_path / "velodyne" / f"{scan:06d}.bin").write_bytes(POINTS.tobytes())
    (tmp_path / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n")
    (tmp_path / "times.txt").write_text("0\n0.1\n")
    (tmp_path / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    return KittiOdometry(tmp_path)


def test_classes_have_the_order_of_the_stored_byte() -> None:
    assert tuple(CODES) == CLASSES


def test_moving_car_is_a_vehicle_and_an_outlier_has_no_class() -> None:
    table = class_of_code()
    assert [CLASSES[table[code]] for code in (252, 71, 40, 31)] == [
        "vehicle",
        "pole",
        "other",
        "person",
    ]
    assert (table[[0, 1, 12345]] == NO_CLASS).all()


def test_read_codes_drops_the_points_that_the_scan_drops(drive: KittiOdometry) -> None:
    assert not has_labels(drive)
    write_codes(drive.folder, "000000", np.array([50, 1, 70, 10], np.uint16))
    assert has_labels(drive)
    assert len(drive.scan(0)) == 2
    assert read_codes(drive, 0).tolist() == [50, 70]
    assert read_codes(drive, 1).tolist() == [0, 0]  # this scan has no label file


def test_read_codes_ignores_the_number_of_the_object(drive: KittiOdometry) -> None:
    labels = np.array([50, 1, (7 << 16) | 10, 10], "<u4")
    (drive.folder / "labels").mkdir()
    (drive.folder / "labels" / "000000.label").write_bytes(labels.tobytes())
    assert read_codes(drive, 0).tolist() == [50, 10]


def test_label_file_of_another_length_is_refused(drive: KittiOdometry) -> None:
    write_codes(drive.folder, "000000", np.array([50, 1, 70], np.uint16))
    with pytest.raises(DriveError, match="12 bytes, expected 16: 4 bytes for each of the 4 points"):
        read_codes(drive, 0)
