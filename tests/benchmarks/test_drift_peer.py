"""KISS-SLAM on a simulated drive, with a program in its place."""

import sys
from pathlib import Path

import pytest

from benchmarks.drift.kiss_slam import kiss_slam_row
from benchmarks.drift.town_maps import DriftCase, robot_maps

pytestmark = [pytest.mark.slow, pytest.mark.integration]

PROGRAM = """#!{python}
import sys
import numpy as np

assert sys.argv[1:3] == ["-m", "benchmarks.drift.kiss_slam_program"]
poses = []
while header := sys.stdin.buffer.read(8):
    count = int(np.frombuffer(header, np.uint64)[0])
    assert len(sys.stdin.buffer.read(12 * count)) == 12 * count
    pose = np.eye(4)
    pose[0, 3] = len(poses)
    poses.append(pose)
if {status}:
    sys.exit({status})
np.savez(sys.argv[3], poses=np.array(poses), closures=2, seconds=1.5)
"""


def program(folder: Path, status: int = 0) -> Path:
    file = folder / "python"
    file.write_text(PROGRAM.format(python=sys.executable, status=status))
    file.chmod(0o755)
    return file


def test_error_of_the_peer_is_that_at_our_captures(tmp_path: Path) -> None:
    case = DriftCase(30.0, seed=3)
    maps = robot_maps(case, [1.0], tmp_path)[1.0]
    row = kiss_slam_row(case, maps, program(tmp_path), tmp_path)
    # The route is nearly straight for so few meters, and a scan is 1 m after the one before.
    assert row["kiss_slam_ate_m"] < 0.5
    assert row["kiss_slam_closures"] == 2
    assert row["kiss_slam_seconds"] == 1.5
    again = kiss_slam_row(case, maps, tmp_path / "missing", tmp_path)
    assert again == row


def test_failure_of_the_peer_is_an_error(tmp_path: Path) -> None:
    case = DriftCase(30.0, seed=3)
    with pytest.raises(RuntimeError, match="status 3"):
        kiss_slam_row(case, [], program(tmp_path, status=3), tmp_path)
