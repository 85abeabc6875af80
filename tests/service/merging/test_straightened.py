"""Maps whose odometry is corrected before they are aligned for a merge that bends."""

from dataclasses import replace

import numpy as np
import pytest

from evaluation.trajectory import absolute_error
from service.merging.bending import straightened
from tests.service.merging.drifting_maps import drifting_map


@pytest.mark.parametrize("odometry", [True, False])
def test_straightened_map_has_smaller_errors_and_the_same_odometry(odometry: bool) -> None:
    content, true = drifting_map("model", 3, laps=1, odometry=odometry)
    after = straightened(content)
    errors = [absolute_error(each.frame_positions, true).rmse for each in (content, after)]
    assert errors[1] < 0.7 * errors[0]
    assert sorted(after.ids.tolist()) == sorted(content.ids.tolist())
    assert after.frame_odometry is not None
    np.testing.assert_allclose(after.frame_odometry[:, :3], content.frame_positions, atol=1e-9)


def test_map_that_was_moved_is_not_straightened() -> None:
    content, _ = drifting_map("model", 3, laps=1, odometry=True)
    moved = replace(content, frame_positions=content.frame_positions + 1.0)
    assert straightened(moved) is moved


def test_map_without_captures_is_not_straightened() -> None:
    content, _ = drifting_map("model", 3, laps=1, side=2)
    nothing = replace(
        content,
        codes=content.codes[:0],
        centroids=content.centroids[:0],
        ids=content.ids[:0],
        robot=content.robot[:0],
        frame_index=content.frame_index[:0],
        frame_times=content.frame_times[:0],
        frame_positions=content.frame_positions[:0],
        frame_orientations=content.frame_orientations[:0],
    )
    assert straightened(nothing) is nothing
