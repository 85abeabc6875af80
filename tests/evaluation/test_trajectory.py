"""Errors of trajectories, against numbers of the program evo and by hand."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from evaluation.trajectory import TrajectoryError, absolute_error, relative_error

FOLDER = Path(__file__).parent / "trajectories"


def poses(name: str) -> np.ndarray:
    table = np.loadtxt(FOLDER / f"{name}.tum")
    found = np.tile(np.eye(4), (len(table), 1, 1))
    found[:, :3, 3] = table[:, 1:4]
    found[:, :3, :3] = Rotation.from_quat(table[:, 4:]).as_matrix()
    return found


def evo(command: str) -> TrajectoryError:
    """Return the numbers that evo printed for a command."""
    lines = (FOLDER / "evo.txt").read_text().splitlines()
    words = lines[lines.index(command) + 1].split()
    told = dict(zip(words[::2], map(float, words[1::2]), strict=True))
    return TrajectoryError(told["rmse"], told["mean"], told["median"], told["max"])


def assert_same(found: TrajectoryError, expected: TrajectoryError) -> None:
    for name in TrajectoryError.__slots__:
        assert getattr(found, name) == pytest.approx(getattr(expected, name), abs=2e-6), name


@pytest.mark.parametrize(
    ("options", "align", "scale"), [("", False, False), (" -a", True, False), (" -as", True, True)]
)
def test_absolute_error_equals_that_of_evo(options: str, align: bool, scale: bool) -> None:
    estimated, true = poses("estimated")[:, :3, 3], poses("true")[:, :3, 3]
    assert_same(
        absolute_error(estimated, true, align, scale),
        evo(f"evo_ape tum true.tum estimated.tum{options}"),
    )


def test_relative_error_equals_that_of_evo() -> None:
    meters, degrees = relative_error(poses("estimated"), poses("true"), 10)
    command = "evo_rpe tum true.tum estimated.tum -d 10 -u f -r"
    assert_same(meters, evo(f"{command} trans_part"))
    assert_same(degrees, evo(f"{command} angle_deg"))


def test_moved_trajectory_has_no_error_after_alignment() -> None:
    true = poses("true")[:, :3, 3]
    turned = true @ Rotation.from_euler("z", 1.0).as_matrix().T + 100.0
    assert absolute_error(turned, true).largest < 1e-9
    assert absolute_error(turned, true, align=False).rmse > 10.0
    assert absolute_error(true[:0], true[:0]) == TrajectoryError(0.0, 0.0, 0.0, 0.0)


def test_trajectories_of_different_lengths_are_refused() -> None:
    true = poses("true")
    with pytest.raises(ValueError, match="equal shapes"):
        absolute_error(true[:3, :3, 3], true[:4, :3, 3])
    with pytest.raises(ValueError, match="step of 1 or more"):
        relative_error(true, true, 0)
