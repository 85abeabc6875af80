"""The doctor on drives in known layouts and on Placecell's own files; its picture and command."""

import json
from pathlib import Path

import numpy as np
import pytest
from placecell_client.maps.map_file import encode
from typer.testing import CliRunner

from cli import app
from placecell.core.parameters import PROTOCOL_V1
from placecell.datasets import open_drive
from placecell.inspection.inspect import inspect_source
from placecell.segmentation.pipeline import record
from tests.client.map_builders import random_map
from tests.placecell.inspection.scan_builders import way, write_clouds, yards

FIXTURES = Path(__file__).parents[2] / "fixtures"


def write_kitti(folder: Path, scans: int = 6) -> Path:
    """Write a drive through the yard in the KITTI layout."""
    (folder / "velodyne").mkdir(parents=True)
    for index, cloud in enumerate(yards(scans)):
        table = np.column_stack([cloud, np.full(len(cloud), 0.5)]).astype("<f4")
        (folder / "velodyne" / f"{index:06d}.bin").write_bytes(table.tobytes())
    rows = way(scans)[:, :3].reshape(scans, 12)
    np.savetxt(folder / "poses.txt", rows)
    np.savetxt(folder / "times.txt", 0.1 * np.arange(scans))
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    return folder


def test_kitti_drive_is_told(tmp_path: Path) -> None:
    facts = inspect_source(write_kitti(tmp_path / "drive")).as_dict()
    assert facts["format"] == "KITTI odometry"
    assert (facts["scans"], facts["poses"]) == (6, 6)
    assert facts["rate_hz"] == pytest.approx(10)
    assert facts["fields"] == ["x", "y", "z", "reflectance"]
    assert facts["sensor_height_m"] == pytest.approx(1.5, abs=0.03)
    assert facts["usable"]


def test_kitti_drive_with_damaged_poses_still_tells_its_scans(tmp_path: Path) -> None:
    drive = write_kitti(tmp_path / "drive")
    (drive / "poses.txt").write_text("1 2 3\n")
    found = inspect_source(drive)
    assert found.as_dict()["scans"] == 6
    assert "poses.txt" in found.problems[0].what
    assert not found.usable


def test_kitti_drive_with_a_cut_scan_is_usable(tmp_path: Path) -> None:
    drive = write_kitti(tmp_path / "drive")
    scan = drive / "velodyne" / "000003.bin"
    scan.write_bytes(scan.read_bytes()[:-5])
    found = inspect_source(drive)
    assert found.usable
    assert any("000003.bin" in problem.what for problem in found.problems)


def test_recording_and_map_are_named(tmp_path: Path) -> None:
    drive = open_drive(write_kitti(tmp_path / "drive"))
    file = tmp_path / "drive.safetensors"
    record(drive, PROTOCOL_V1.for_drive(len(drive))).save(file)
    found = inspect_source(file)
    assert found.as_dict()["format"] == "Placecell recording"
    assert "a recording of Placecell" in found.problems[0].what
    file = tmp_path / "yard.map"
    file.write_bytes(encode(random_map(20)))
    assert inspect_source(file).as_dict()["format"] == "Placecell map file"


def test_delta_file_is_named_and_not_usable() -> None:
    found = inspect_source(FIXTURES / "version-1.delta")
    assert found.as_dict()["format"] == "Placecell delta file"
    assert not found.usable


def test_listed_files_of_a_ros2_bag_may_have_the_key_path(tmp_path: Path) -> None:
    from placecell.sources.bags.containers.bag import LISTED

    text = "relative_file_paths:\n  - run_0.db3\nfiles:\n  - path: run_1.db3\n"
    assert LISTED.findall(text) == ["run_0.db3", "run_1.db3"]


def test_command_writes_json_and_picture_and_tells_cures(tmp_path: Path) -> None:
    drive = write_kitti(tmp_path / "drive")
    words = ["inspect", drive, "--json", tmp_path / "a.json", "--plot", tmp_path / "a.png"]
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    assert "KITTI odometry" in result.output
    assert "Placecell can use this source." in result.output
    assert json.loads((tmp_path / "a.json").read_text())["scans"] == 6
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_command_fails_for_a_source_that_cannot_be_used(tmp_path: Path) -> None:
    folder = write_clouds(tmp_path / "scans", [np.full((9, 3), np.nan)])
    result = CliRunner().invoke(app, ["inspect", str(folder), "--plot", str(tmp_path / "a.png")])
    assert result.exit_code == 1
    assert "Placecell cannot use this source as it is." in result.output
    assert not (tmp_path / "a.png").exists()
    assert CliRunner().invoke(app, ["inspect", str(tmp_path / "none")]).exit_code == 1
