"""Extrinsic calibrations: numbers and files."""

from pathlib import Path

import numpy as np
import pytest

from placecell.core.errors import DriveError
from placecell.trajectories.extrinsic import describe_extrinsic, parse_extrinsic

TURNED = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1.0]])
"""Sensor at (1, 2, 3), turned to the left by 90 degrees."""

ROWS = "0 -1 0 1 1 0 0 2 0 0 1 3"


@pytest.mark.parametrize(
    "text",
    [
        "1 2 3 0 0 1.5707963267948966",
        "1 2 3 0 0 90 deg",
        "1, 2, 3, 0, 0, 1.5707963267948966 rad",
        "1 2 3 0 0 0.7071067811865476 0.7071067811865476",
        ROWS,
        ROWS + " 0 0 0 1",
    ],
)
def test_numbers(text: str) -> None:
    assert parse_extrinsic(text) == pytest.approx(TURNED, abs=1e-9)


def test_identity() -> None:
    assert parse_extrinsic(" Identity ").tolist() == np.eye(4).tolist()


@pytest.mark.parametrize(
    "content",
    [
        f"P0: 1 2 3\nTr: {ROWS}\n",
        "calib_time: today\nR: 0 -1 0 1 0 0 0 0 1\nT: 1 2 3\n",
        "# sensor to base\n0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n",
        "sensor_type: lidar\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, 0.0, 1.0,\n"
        "         1.0, 0.0, 0.0, 2.0,\n  0.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 1.0]\n",
    ],
)
def test_files(tmp_path: Path, content: str) -> None:
    (tmp_path / "calib.txt").write_text(content)
    assert parse_extrinsic(str(tmp_path / "calib.txt")) == pytest.approx(TURNED, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("none.txt", "'none.txt': no such file, and no numbers. Expected identity;"),
        ("1 2 3", "3 numbers, expected identity"),
        ("1 2 3 0 0 90", "angles of up to 90 rad, expected at most 6.28. Append deg"),
        ("0 0 0 1 1 1 1", "the quaternion .* has the length 2, expected 1"),
        ("1 0 0 0 0 1 0 0 0 0 2 0", "is no rotation"),
        ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "last row of the 4x4 matrix is not 0 0 0 1"),
    ],
)
def test_wrong_numbers_are_refused(text: str, said: str) -> None:
    with pytest.raises(DriveError, match=said):
        parse_extrinsic(text)


@pytest.mark.parametrize("content", ["Tr: one\n", "R: 1\nT: 1 2 3\n", "mount: front\n", ""])
def test_file_without_a_calibration_is_refused(tmp_path: Path, content: str) -> None:
    (tmp_path / "calib.txt").write_text(content)
    with pytest.raises(DriveError, match=r"calib\.txt"):
        parse_extrinsic(str(tmp_path / "calib.txt"))


def test_description() -> None:
    assert describe_extrinsic(TURNED) == "1.00 2.00 3.00 m, 0.0 0.0 90.0 deg (roll, pitch, yaw)"
