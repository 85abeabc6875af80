"""Benefit of decoded shapes for poses and recognition."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.localization.completion import (
    WAYS,
    SegmentPoints,
    error_figures,
    mapped_segments,
    overlaps_of,
    packed,
    share_right,
)
from benchmarks.localization.registration import Registration
from cli import app
from evaluation.poses.robots import robots_of_drive
from evaluation.recognition.retrieval import Retrieval
from placecell.core.types import Float64
from placecell.localization import Pose
from placecell.segmentation.pipeline import silent
from tests.benchmarks.drive_builders import trip


def corner() -> Float64:
    """Return random points on a floor and on two walls, meters."""
    points = np.random.default_rng(0).uniform(0, 4, (6000, 3))
    points[np.arange(6000), np.arange(6000) % 3] = 0
    return points


def test_registration_finds_a_known_transform() -> None:
    target = corner()
    moved = Pose.of_yaw(0.05, np.array([0.2, -0.1, 0.05]))
    found = Registration().align(moved.inverse().apply(target), target, np.eye(4))
    meters, angle = Pose.of_matrix(found).difference(moved, np.array([2.0, 2.0, 1.0]))
    assert meters < 0.02
    assert np.degrees(angle) < 0.5


def test_surfaces_hold_the_points_of_each_row() -> None:
    points = np.arange(15.0).reshape(5, 3)
    surfaces = SegmentPoints(points, np.array([2, 2, 5]))
    assert surfaces.of(np.array([2, 0])).tolist() == points[[2, 3, 4, 0, 1]].tolist()
    assert len(surfaces.of(np.array([1]))) == 0


def test_overlap_is_intersection_over_union() -> None:
    grids = np.zeros((3, 1, 1, 4), bool)
    grids[0, ..., :2] = grids[1, ..., 1:3] = grids[2, ..., :4] = True
    candidates = np.array([[1, 2], [2, -1], [0, 1]])
    found = overlaps_of(packed(grids), candidates)
    np.testing.assert_allclose(found, [[1 / 3, 0.5], [0.5, -1.0], [0.5, 0.5]])


def test_share_right_takes_the_best_score_of_the_candidates() -> None:
    groups = np.array([0, 0, 1, 1])
    found = Retrieval(
        right=np.zeros(4, bool),
        has_mate=np.array([True, True, True, False]),
        recalled=np.zeros(4, bool),
        nearest=np.zeros(4, np.int64),
        candidates=np.array([[2, 1], [0, -1], [0, 1], [2, 0]]),
        distances=np.zeros((4, 2)),
    )
    scores = np.array([[0.1, 0.9], [0.1, 5.0], [1.0, 0.5], [1.0, 0.0]])
    assert share_right(found, groups, scores) == pytest.approx(2 / 3, abs=1e-4)


def test_errors_of_no_pose_are_unknown() -> None:
    assert error_figures(np.zeros((0, 2)))["median_m"] is None
    assert error_figures(np.array([[0.1, 1.0], [0.3, 2.0]]))["median_m"] == 0.2


@pytest.mark.slow
def test_drive_is_measured_in_each_way(tmp_path: Path) -> None:
    folder = trip(tmp_path / "trip", 40, range(0)).folder
    robot, _ = robots_of_drive(folder, silent)
    kept = sum(int(distinct.sum()) for _, _, distinct in robot.views())
    assert len(mapped_segments(robot)) == kept > 0
    report = tmp_path / "report.json"
    called = ["bench", "completion", str(folder), "--queries", "3", "--json", str(report)]
    result = CliRunner().invoke(app, called)
    assert result.exit_code == 0, result.output
    content = json.loads(report.read_text())
    assert list(content["poses"]) == list(WAYS)
    assert content["recognition"]["top1"]["queries"] > 0
    assert 0.0 <= content["recognition"]["top1"]["decoded shapes"] <= 1.0


def test_model_without_decoder_is_refused(tmp_path: Path) -> None:
    folder = trip(tmp_path / "trip", 16, range(0)).folder
    called = ["bench", "completion", str(folder), "--model", "group"]
    result = CliRunner().invoke(app, called)
    assert result.exit_code != 0
    assert "has no shape decoder" in result.output
