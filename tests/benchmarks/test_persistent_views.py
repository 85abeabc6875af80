"""Best views of persistent segments, compared with the views of all captures."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.robot.persistent_views import (
    one_of_each,
    persistent_views,
    search_across_views,
)
from cli import app
from placecell.core.parameters import PROTOCOL_V1
from placecell.segmentation.pipeline import record
from tests.benchmarks.drive_builders import trip


@pytest.mark.slow
def test_each_id_has_one_best_view(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 16, range(0))
    recording = record(drive, PROTOCOL_V1.for_drive(len(drive)))
    views = persistent_views(drive, recording)
    assert (views.ids >= 0).all()
    assert sorted(views.ids[views.is_best].tolist()) == np.unique(views.ids).tolist()
    assert not (views.is_final & ~views.is_best).any()
    # The objects of the drive never touch each other, so ids and groups are the same things.
    pairs = set(zip(views.ids.tolist(), recording.groups.tolist(), strict=True))
    assert len(pairs) == len(np.unique(views.ids)) == len(np.unique(recording.groups))


@pytest.mark.slow
def test_recording_of_other_scans_is_refused(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 8, range(0))
    other = trip(tmp_path / "other", 8, range(2, 4), unseen=2)
    recording = record(other, PROTOCOL_V1.for_drive(len(other)))
    with pytest.raises(ValueError, match="the recording other is of other scans"):
        persistent_views(drive, recording)


def test_search_leaves_out_mates_seen_from_near() -> None:
    codes = np.array([[0.0], [0.1], [1.0], [5.0], [0.2]], dtype=np.float32)
    groups = np.array([0, 0, 0, 1, 2])
    sensors = np.array([[0, 0, 0], [5, 0, 0], [20, 0, 0], [0, 0, 0], [0, 0, 0]], np.float32)
    queries = np.array([0, 2, 3])
    found = search_across_views(codes, groups, sensors, queries, np.array([1, 2, 3]))
    # 0: view 1 is too near, view 2 is a mate and nearest. 2: view 1 is the mate. 3: it is alone.
    assert found.has_mate.tolist() == [True, True, False]
    assert found.right.tolist() == [True, True, False]
    found = search_across_views(codes, groups, sensors, queries, np.array([1, 2, 3, 4]))
    assert found.right.tolist() == [False, False, False]


def test_one_row_of_each_key_in_the_given_order() -> None:
    keys = np.array([7, 3, 7, 3, 9])
    assert one_of_each(keys, np.array([2, 3, 0, 1, 4])).tolist() == [2, 3, 4]
    assert one_of_each(keys, np.array([1, 0])).tolist() == [0, 1]


@pytest.mark.slow
def test_command_compares_both_maps(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 24, range(0))
    file = tmp_path / "persistent.json"
    words = ("bench", "persistent", drive.folder, "--scans", "0:23", "--json", file)
    run = CliRunner().invoke(app, [str(each) for each in words])
    assert run.exit_code == 0, run.output
    report = json.loads(file.read_text())
    databases = report["recognition"]["databases"]
    assert databases["best view of each id"]["segments"] < databases["captures"]["segments"]
    poses = report["poses_by_blocks"]
    assert set(poses) == {"captures", "best view of each id"}
    assert poses["captures"]["queries"] == poses["best view of each id"]["queries"]
    assert "recognition across views" in run.output


def test_scans_without_groups_are_refused(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 4, range(0))
    words = ["bench", "persistent", str(drive.folder), "--scans", "1:2"]
    run = CliRunner().invoke(app, words)
    assert run.exit_code == 1
    assert "no group lies within scans 1 to 2" in run.output
