"""Tests of the commands on a small town: town, prepare, train, evaluate, demo."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner, Result

import town
from cli import app
from cli.fit_confidence import DRIVES, parse_pair, simulated_pairs
from cli.sources import TOWN_SCANS, town_recordings
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.descriptors.manifest import Manifest
from placecell.localization import Confidence
from placecell.segmentation.recording import Recording
from tests.placecell.datasets.test_kitti_raw import record, unit_at_the_sensor
from tests.placecell.segment_builders import pose, write_odometry, write_raw

pytestmark = pytest.mark.slow

FIGURES = {
    "model_id",
    "top1",
    "top1_with_mate",
    "cross_view_top1",
    "cross_view_queries",
    "reranked_top1",
    "reranked_top1_with_mate",
    "reranked_cross_view_top1",
    "recall_at_25",
    "pair_auc",
    "pair_accuracy",
    "pair_by",
    "expected_calibration_error",
    "brier",
    "seen",
}


def run(*words: str | Path | int, status: int = 0) -> Result:
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == status, result.output
    return result


@pytest.fixture(scope="module", autouse=True)
def short_calibration() -> Iterator[None]:
    """Find the ranges of 8-bit activations from few segments; tests/training uses all."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("training.export.quantization.CALIBRATION_SEGMENTS", 128)
        yield


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulate and prepare two town drives, and train a model on robot A's."""
    folder = tmp_path_factory.mktemp("workshop")
    run("town", folder / "drives", "--scans", 40, "--columns", 500, "--seed", 3)
    drives = [folder / "drives" / name for name in ("robot_a", "robot_b")]
    run("prepare", *drives, "--output", folder / "data")
    run(
        *("train", "group", folder / "data" / "robot_a.safetensors@0:30", "--epochs", 1),
        *("--runs", folder / "runs", "--output", folder / "tiny", "--license", "free"),
    )
    return folder


@pytest.fixture(scope="module")
def small_town() -> tuple[Recording, Recording]:
    """Simulate two robots in a small part of the town with seed 5."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("town.two_robots", partial(town.two_robots, columns=500))
        first, second = town_recordings(5, scans=14)
    return first, second


@pytest.fixture
def towns(monkeypatch: pytest.MonkeyPatch, small_town: tuple[Recording, Recording]) -> None:
    """Replace the drives of `town:5` by shorter ones that are simulated once."""

    def driven(
        seed: int, scans: int, sensor: str, place: str, *, opposite: bool
    ) -> tuple[Recording, Float64]:
        assert (seed, scans, sensor, place) == (5, TOWN_SCANS, "hdl-64e", "streets")
        return small_town[opposite], origins[opposite]

    origins = [np.eye(4), np.diag([-1.0, -1, 1, 1])]
    monkeypatch.setattr("cli.sources.town_drive", driven)


def test_train_writes_model_card_and_provenance(workshop: Path) -> None:
    manifest = Manifest.load(workshop / "tiny")
    (source,) = manifest.training["sources"]
    assert source["drive"] == "robot_a"
    assert source["scans"] == [0, 30]
    assert len(source["scan_hashes"]) == 31
    assert manifest.training["seed"] == 0
    card = (workshop / "tiny" / "README.md").read_text()
    assert manifest.model_id in card
    assert "placecell train group" in card
    assert "free" in card


def test_evaluate_writes_the_documented_json_keys(workshop: Path) -> None:
    file = workshop / "figures.json"
    result = run(
        *("evaluate", workshop / "data" / "robot_a.safetensors"),
        *("--model", workshop / "tiny", "--json", file),
    )
    assert "eigenvalue" in result.output
    report = json.loads(file.read_text())
    assert set(report) >= {
        *("drive", "scans", "segments_raw", "segments", "groups", "default", "extractors"),
        *("protocol", "machine", "seed"),
    }
    assert report["protocol"] == "v1"
    assert report["scans"] == [0, 39]
    assert report["segments_raw"] >= report["segments"] > report["groups"] > 0
    assert set(report["extractors"]) == {"tiny", "eigenvalue"}
    for figures in report["extractors"].values():
        assert set(figures) >= FIGURES
    assert report["extractors"]["tiny"]["seen"]
    assert not report["extractors"]["eigenvalue"]["seen"]


def test_evaluate_of_later_scans_of_a_drive_folder_is_not_seen(
    workshop: Path,
) -> None:
    file = workshop / "later.json"
    run(
        *("evaluate", workshop / "drives" / "robot_a", "--scans", "31:39", "--every", 2),
        *("--model", workshop / "tiny", "--json", file),
    )
    report = json.loads(file.read_text())
    assert not report["extractors"]["tiny"]["seen"]
    assert report["every"] == 2


def test_model_folder_named_like_the_baseline_is_evaluated_too(
    workshop: Path, tmp_path: Path
) -> None:
    namesake = tmp_path / "eigenvalue"
    namesake.mkdir()
    for file in (workshop / "tiny").iterdir():
        (namesake / file.name).write_bytes(file.read_bytes())
    file = tmp_path / "figures.json"
    recording = workshop / "data" / "robot_a.safetensors"
    run("evaluate", recording, "--model", namesake, "--json", file)
    found = json.loads(file.read_text())["extractors"]
    assert found["eigenvalue"]["model_id"] != Manifest.load(workshop / "tiny").model_id
    assert found[str(namesake)]["model_id"] == Manifest.load(workshop / "tiny").model_id


def test_failed_start_of_a_training_keeps_the_checkpoint(workshop: Path) -> None:
    checkpoint = workshop / "runs" / "group-fast-0" / "checkpoint.pt"
    before = checkpoint.read_bytes()
    words = ("train", "group", "nowhere", "--runs", workshop / "runs")
    run(*words, "--output", workshop / "none", status=1)
    assert checkpoint.read_bytes() == before


def test_resume_on_other_drives_is_refused(workshop: Path, tmp_path: Path) -> None:
    words = ("train", "group", workshop / "data" / "robot_b.safetensors", "--epochs", 1)
    folders = ("--runs", workshop / "runs", "--output", tmp_path / "m")
    assert "other drives" in run(*words, *folders, "--resume", status=1).output


def test_help_shows_the_defaults() -> None:
    assert "default: 2" in " ".join(run("evaluate", "--help").output.split())


def test_evaluate_refuses_another_frame_step_than_the_recordings(workshop: Path) -> None:
    recording = workshop / "data" / "robot_a.safetensors"
    result = run("evaluate", recording, "--every", 3, status=1)
    assert "prepare the drive again" in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["evaluate", "nowhere"], "nowhere"),
        (["evaluate", "nowhere", "--scans", "9:3"], "FIRST:LAST"),
        (["prepare", "nowhere"], "nowhere"),
        (["train", "group", "nowhere@0:3"], "nowhere"),
        (["demo", "--drive", "nowhere"], "nowhere"),
    ],
)
def test_wrong_arguments_are_named_without_a_stack_trace(words: list[str], said: str) -> None:
    result = run(*words, status=1)
    assert said in result.output
    assert "Traceback" not in result.output


def test_evaluate_of_scans_without_groups_is_an_error(workshop: Path) -> None:
    recording = workshop / "data" / "robot_a.safetensors"
    assert "no group" in run("evaluate", recording, "--scans", "900:901", status=1).output


def test_B4_prepare_of_a_drive_without_segments_fails(tmp_path: Path) -> None:
    points = np.random.default_rng(0).normal(size=(40, 3)) + [8, 0, 0]
    drive = write_odometry(tmp_path / "bare", [points] * 3, [pose(x) for x in range(3)])
    said = run("prepare", drive, "--output", tmp_path / "data", status=1).output
    assert "no segments were found in 3 scans of 40 points" in said
    assert "--columns" in said
    assert not (tmp_path / "data").exists()


def test_B10_skipped_scans_are_counted_in_the_figures(workshop: Path, tmp_path: Path) -> None:
    drive = tmp_path / "robot_b"
    shutil.copytree(workshop / "drives" / "robot_b", drive)
    for number in range(16, 40):
        (drive / "velodyne" / f"{number:06d}.bin").unlink()
    for name in ("poses.txt", "times.txt"):
        lines = (drive / name).read_text().splitlines()[:16]
        (drive / name).write_text("\n".join(lines))
    (drive / "velodyne" / "000003.bin").write_bytes(b"")
    values = np.fromfile(drive / "velodyne" / "000005.bin", "<f4")
    values[:8] = np.nan
    values.tofile(drive / "velodyne" / "000005.bin")
    file = tmp_path / "prepared.json"
    done = run("prepare", drive, "--output", tmp_path / "data", "--json", file)
    assert "1 of 16 scans skipped (000003.bin: no points (0 bytes))" in done.output
    (row,) = json.loads(file.read_text())["recordings"]
    assert (row["skipped_scans"], row["dropped_points"]) == (1, 2)
    prepared = tmp_path / "data" / "robot_b.safetensors"
    assert Recording.load(prepared).skipped_scans == (3,)
    run("evaluate", prepared, "--model", "eigenvalue", "--json", file)
    report = json.loads(file.read_text())
    assert (report["skipped_scans"], report["dropped_points"]) == (1, 2)
    refused = run("prepare", drive, "--strict", "--output", tmp_path / "data", status=1).output
    assert "000003.bin" in refused
    assert "--strict" in refused


def test_an_altered_model_is_refused(workshop: Path, tmp_path: Path) -> None:
    for file in (workshop / "tiny").iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    weights = bytearray((tmp_path / "model.onnx").read_bytes())
    weights[len(weights) // 2] ^= 1
    (tmp_path / "model.onnx").write_bytes(weights)
    recording = workshop / "data" / "robot_a.safetensors"
    result = run("evaluate", recording, "--model", tmp_path, status=1)
    assert "SHA-256" in result.output


@pytest.mark.integration
def test_demo_runs_on_a_recorded_drive(workshop: Path, tmp_path: Path) -> None:
    result = run("demo", "--drive", workshop / "drives" / "robot_b", "--output", tmp_path)
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert figures["queries_findable"] > 0
    assert figures["bytes_per_segment"] > 0
    assert (tmp_path / "matches.png").read_bytes().startswith(b"\x89PNG")
    assert "It works" in result.output


@pytest.mark.parametrize(
    "command", [[], ["town"], ["prepare"], ["train"], ["evaluate"], ["serve"], ["demo"]]
)
def test_help_shows_the_usage(command: list[str]) -> None:
    assert "Usage" in run(*command, "--help").output


def in_raw_layout(drive: Path, folder: Path, scans: int) -> Path:
    """Convert the begin of a drive to the KITTI raw layout: oxts files instead of poses."""
    poses = open_drive(drive).poses[:scans]
    east, north, up = poses[:, :3, 3].T
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_euler("ZYX")
    write_raw(
        folder,
        [
            record(x, y, z, yaw=yaw, pitch=pitch, roll=roll)
            for x, y, z, (yaw, pitch, roll) in zip(east, north, up, turns, strict=True)
        ],
    )
    unit_at_the_sensor(folder)
    for number, scan in enumerate(sorted((drive / "velodyne").iterdir())[:scans]):
        shutil.copy(scan, folder / "velodyne_points" / "data" / f"{number:010d}.bin")
    return folder


def test_experiments_run_on_a_raw_drive_and_repeat_no_training(
    workshop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("training.export.pair_classifier.TREES", 4)
    raw = in_raw_layout(workshop / "drives" / "robot_a", tmp_path / "drive_0018_sync", 10)
    tmp_path = tmp_path / "report"
    words = (
        *("experiments", "--quick", "--epochs", 1, "--output", tmp_path),
        *("--train", raw, "--test", f"{workshop / 'data' / 'robot_b.safetensors'}@0:15"),
    )
    run(*words)
    report = json.loads((tmp_path / "report.json").read_text())
    assert set(report["models"]) == {
        *("eigenvalue", "group-fast-0", "siamese-fast-0", "contrastive-fast-0"),
        *("siamese-fast-0-dropout-0.0", "siamese-fast-0-dropout-0.5"),
        "contrastive-fast-0-random-pairs",
    }
    text = (tmp_path / "report.md").read_text()
    for picture in ("training", "roc", "candidates", "distances", "overfitting", "reliability"):
        assert f"({picture}.png)" in text
        assert (tmp_path / f"{picture}.png").read_bytes().startswith(b"\x89PNG")
    before = {file: file.stat().st_mtime_ns for file in (tmp_path / "models").rglob("*.onnx")}
    # Reuse the figures of the first run; the test is about the training.
    monkeypatch.setattr(
        "training.experiments.experiments.compare",
        lambda folder, *_, **__: report["models"][folder.name],
    )
    run(*words)
    assert {f: f.stat().st_mtime_ns for f in (tmp_path / "models").rglob("*.onnx")} == before


def test_train_refuses_too_few_groups_and_an_unknown_network(
    workshop: Path, tmp_path: Path
) -> None:
    recording = workshop / "data" / "robot_a.safetensors"
    little = run("train", "group", f"{recording}@0:1", "--output", tmp_path / "m", status=1)
    assert "too few groups" in " ".join(little.output.split())
    words = ("train", "group", recording, "--output", tmp_path / "m", "--runs", tmp_path)
    assert "paper-reduced" in run(*words, "--network", "huge", status=1).output
    assert not (tmp_path / "m").exists()


def test_experiments_on_other_drives_refuse_the_same_folder(workshop: Path, tmp_path: Path) -> None:
    (tmp_path / "identity").write_text("of other drives")
    data = workshop / "data"
    words = ("--train", data / "robot_a.safetensors", "--test", data / "robot_b.safetensors")
    said = run("experiments", "--quick", "--output", tmp_path, *words, status=1).output
    assert "other drives" in " ".join(said.split())


def test_experiments_refuse_test_scans_that_are_training_scans(
    workshop: Path, tmp_path: Path
) -> None:
    recording = workshop / "data" / "robot_a.safetensors"
    words = ("--train", f"{recording}@0:20", "--test", f"{recording}@20:39")
    said = run("experiments", "--quick", "--output", tmp_path, *words, status=1).output
    assert "shares scans" in " ".join(said.split())


def test_context_model_uses_neighborhoods_and_trains_on_towns(
    workshop: Path, tmp_path: Path, towns: None
) -> None:
    recording = workshop / "data" / "robot_a.safetensors"
    words = ("train", "context", recording, "town:5", "--epochs", 1, "--runs", tmp_path)
    run(*words, "--output", tmp_path / "around")
    manifest = Manifest.load(tmp_path / "around")
    drives = [source["drive"] for source in manifest.training["sources"]]
    assert drives == ["robot_a", "town:5"]
    assert "data/robot_a.safetensors town:5 --seed 0" in manifest.training["command"]
    both = ("train", "context", recording, "town:5", "town:5+robot-b")
    run(*both, "--keep-network", tmp_path / "around", "--output", tmp_path / "refit")
    refit = Manifest.load(tmp_path / "refit")
    drives = [source["drive"] for source in refit.training["sources"]]
    assert drives == ["robot_a", "town:5", "town:5+robot-b"]
    assert refit.model_id != manifest.model_id
    lines = refit.training["command"].splitlines()
    assert lines[-2].startswith("placecell train context data/robot_a.safetensors town:5 --seed")
    assert "town:5 town:5+robot-b --seed 0 --keep-network around" in lines[-1]
    said = run("train", "group", recording, "--keep-network", "context", status=1).output
    assert "needs the method context, not group" in " ".join(said.split())
    asked = workshop / "data" / "robot_b.safetensors"
    run("evaluate", asked, "--model", tmp_path / "around", "--json", tmp_path / "figures.json")
    figures = json.loads((tmp_path / "figures.json").read_text())["extractors"]["around"]
    assert figures["top1"] > figures["alone"]["top1"]
    assert 0 < figures["alone"]["top1_in_map"] < figures["top1"]


def test_study_writes_its_curves(workshop: Path, tmp_path: Path) -> None:
    recording = workshop / "data" / "robot_b.safetensors"
    result = run("study", recording, "--model", "eigenvalue", "--output", tmp_path)
    assert "near_place" in result.output
    assert (tmp_path / "study.png").read_bytes().startswith(b"\x89PNG")
    assert set(json.loads((tmp_path / "study.json").read_text())["models"]) == {"eigenvalue"}


def test_experiments_need_both_drives_or_none(workshop: Path) -> None:
    drive = workshop / "data" / "robot_a.safetensors"
    assert "both" in run("experiments", "--train", drive, status=1).output


def test_ablations_compare_variants_and_continue_a_run(
    workshop: Path, tmp_path: Path, towns: None
) -> None:
    a, b = (workshop / "data" / f"robot_{name}.safetensors" for name in "ab")
    words = ("ablations", "--train", a, "--train", "town:5", "--test", b, "--part", "data")
    shape = ("--epochs", 1, "--seeds", 1, "--output", tmp_path)
    run(*words, *shape)
    report = json.loads((tmp_path / "ablations.json").read_text())
    assert [row["name"] for row in report["rows"]] == ["seed-0", "without-towns"]
    assert all(0 < row["top1"] <= 1 for row in report["rows"])
    assert "wide int8" in report["throughput"]
    text = (tmp_path / "ablations.md").read_text()
    assert "--train=town:5" in text
    assert str(tmp_path) not in text
    history = tmp_path / "runs" / "model-seed-0" / "history.json"
    before = history.stat().st_mtime_ns
    run(*words, *shape)
    assert history.stat().st_mtime_ns == before
    assert "augmentation" in run(*words, *shape, "--part", "luck", status=1).output


def test_config_shows_each_setting_and_its_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "own.toml"
    file.write_text("port = 9000\n[limits]\nk = 50\n")
    monkeypatch.setenv("PLACECELL_CONFIG", str(file))
    monkeypatch.setenv("placecell_limits__deadline", "3")
    lines = {
        cells[1].strip(): [cell.strip() for cell in cells[2:4]]
        for line in run("config").output.splitlines()
        if len(cells := line.split("│")) > 4 and cells[1].strip()
    }
    assert lines["PLACECELL_PORT"][0] == "9000"
    assert lines["PLACECELL_PORT"][1] != "default"
    assert lines["PLACECELL_LIMITS__K"][0] == "50"
    assert lines["PLACECELL_LIMITS__DEADLINE"] == ["3.0", "environment"]
    assert lines["PLACECELL_WORKERS"] == ["2", "default"]
    file.write_text("prot = 9000\n")
    assert "prot" in run("config", status=1).output
    monkeypatch.setenv("PLACECELL_CONFIG", str(tmp_path / "absent.toml"))
    assert "which is not a file" in run("config", status=1).output


POSES = {
    *("queries", "localised_right", "wrong_but_sure", "not_localised", "median_position_error_m"),
    *("median_yaw_error_deg", "p50_ms", "p99_ms", "precision_recall", "reliability", "bounds_95"),
    *("metres_until_localised", "model_id", "protocol", "machine", "seed", "beyond_the_map"),
    *("best_pose_right", "told_share_of_right", "success_1m_3deg", "success_2m_5deg"),
    *("best_pose_2m_5deg", "expected_calibration_error", "brier", "place_recognition"),
    *("map_sensor", "query_sensor", "seen"),
}


def test_evaluate_poses_writes_the_documented_json_keys(workshop: Path, tmp_path: Path) -> None:
    drives = [workshop / "drives" / name for name in ("robot_a", "robot_b")]
    file, plot = tmp_path / "poses.json", tmp_path / "poses.png"
    result = run("evaluate-poses", *drives, "--json", file, "--plot", plot)
    assert "localized right" in result.output
    report = json.loads(file.read_text())
    assert set(report) >= POSES
    assert (report["map_drive"], report["query_drive"]) == ("robot_a", "robot_b")
    assert report["queries"] + report["beyond_the_map"]["queries"] == 40
    # The default model was not trained on this town.
    assert not report["seen"]
    assert report["localised_right"] > 0.5
    assert report["wrong_but_sure"] == 0
    assert plot.read_bytes().startswith(b"\x89PNG")
    # The result depends neither on the robot's frame nor on earlier segmentation of the drives.
    first, second = (workshop / "data" / f"{drive.name}.safetensors" for drive in drives)
    prepared = ("--map-recording", first, "--query-recording", second)
    run("evaluate-poses", *drives, *prepared, "--json", file, "--seed", 1)
    assert json.loads(file.read_text())["localised_right"] == report["localised_right"]


def test_evaluate_poses_reads_recordings_and_writes_each_answer(
    workshop: Path, tmp_path: Path
) -> None:
    drives = [workshop / "drives" / name for name in ("robot_a", "robot_b")]
    first, second = (workshop / "data" / f"{name}.safetensors" for name in ("robot_a", "robot_b"))
    file, answers = tmp_path / "poses.json", tmp_path / "told" / "answers.jsonl"
    prepared = ("--map-recording", first, "--query-recording", second)
    words = ("--queries", 5, "--model", workshop / "tiny", "--json", file, "--answers", answers)
    run("evaluate-poses", *drives, *prepared, *words)
    report = json.loads(file.read_text())
    rows = [json.loads(line) for line in answers.read_text().splitlines()]
    assert report["queries"] + report["beyond_the_map"]["queries"] == len(rows) == 5
    assert (rows[0]["scan"], rows[-1]["scan"]) == (0, 39)
    told = [row for row in rows if row["mapped"] and not row["reason"]]
    assert len(told) == report["queries"] - report["counts"]["not_localised"]
    # The model was trained on robot A's drive.
    assert report["seen"]
    wrong = run("evaluate-poses", *drives, "--map-recording", second, status=1)
    assert "is not a recording of" in wrong.output


def test_evaluate_poses_of_one_drive_uses_blocks_and_a_session(
    workshop: Path, tmp_path: Path
) -> None:
    file = tmp_path / "poses.json"
    drive = workshop / "drives" / "robot_b"
    words = ("--session", "--motion", "se3", "--model", "eigenvalue")
    run("evaluate-poses", drive, *words, "--json", file)
    report = json.loads(file.read_text())
    assert report["blocks"]
    assert report["session"]
    assert report["motion"] == "se3"
    assert report["model_id"].startswith("eigenvalue")
    assert report["beyond_the_map"]["queries"] == 0


def test_evaluate_poses_refuses_wrong_arguments(workshop: Path) -> None:
    drive = workshop / "drives" / "robot_a"
    assert "nowhere" in run("evaluate-poses", "nowhere", status=1).output
    assert "se2" in run("evaluate-poses", drive, "--motion", "se2", status=1).output


def test_evaluate_poses_of_a_sparse_sensor_is_an_error(tmp_path: Path) -> None:
    few = np.random.default_rng(0).uniform(-30, 30, (60, 3))
    drive = write_odometry(tmp_path / "sparse", [few] * 26, [pose(x) for x in range(26)])
    result = run("evaluate-poses", drive, "--model", "eigenvalue", status=1)
    assert "no segments" in result.output
    assert "sparse" in result.output
    assert "Traceback" not in result.output


def test_fit_confidence_writes_constants(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("town.sensor", lambda name: replace(town.HDL_64E, columns=300))
    file = tmp_path / "confidence.json"
    alike = "town:2:hdl-64e:look-alikes"
    words = ("--town", 1, "--drive", alike, "--scans", 20, "--model", "eigenvalue")
    result = run("fit-confidence", *words, "-o", file)
    assert "Brier" in result.output
    fitted = Confidence.load(file)
    assert 0 < fitted.highest < 1
    content = json.loads(file.read_text())
    assert content["fitted_on"]["towns"] == [2, 1]
    assert content["fitted_on"]["places"] == ["look-alikes", "streets"]
    assert content["fitted_on"]["look_alikes"] == [1.0, 0.5]
    assert content["held_out"]["reliability"]
    assert "two or more" in run("fit-confidence", "--town", 1, "-o", file, status=1).output


def test_fit_confidence_refuses_a_folder_without_pairs_and_an_unknown_sensor(
    tmp_path: Path,
) -> None:
    file = tmp_path / "confidence.json"
    empty = run("fit-confidence", "--pairs", tmp_path, "-o", file, status=1)
    assert "SEED-SENSOR-PLACE" in empty.output
    for name in ("town:1:sonar", "town:1:vlp-16+sonar", "town:1:sonar+vlp-16:campus"):
        strange = run("fit-confidence", "--drive", name, "-o", file, status=1)
        assert "sonar" in strange.output
    assert not file.exists()


@pytest.mark.parametrize(
    ("text", "parsed"),
    [
        ("town:3", (3, ("hdl-64e", "hdl-64e"), "streets")),
        ("town:3:os0-32:campus", (3, ("os0-32", "os0-32"), "campus")),
        ("town:3:os0-32+vlp-16", (3, ("os0-32", "vlp-16"), "streets")),
        ("town:3:os0-32+vlp-16:campus", (3, ("os0-32", "vlp-16"), "campus")),
    ],
)
def test_pair_of_a_fit_has_one_sensor_or_two(
    text: str, parsed: tuple[int, tuple[str, str], str]
) -> None:
    assert parse_pair(text) == parsed


@pytest.mark.parametrize("text", ["town:3:os0-32+", "town:3:+vlp-16", "town:3:a+b+c", "town:x"])
def test_pair_of_a_fit_with_another_form_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"expected|Invalid"):
        parse_pair(text)


def test_default_pairs_of_a_fit_have_each_sensor_in_towns_of_their_own() -> None:
    pairs = [parse_pair(text.removesuffix(":look-alikes")) for text in DRIVES]
    assert len({seed for seed, _, _ in pairs}) == len(pairs)
    crossed = [sensors for _, sensors, _ in pairs if sensors[0] != sensors[1]]
    assert {one for one, _ in crossed} == {other for _, other in crossed} == set(town.SENSORS)
    assert len({frozenset(sensors) for sensors in crossed}) == len(crossed)


def test_fit_confidence_simulates_a_pair_of_two_sensors(tmp_path: Path) -> None:
    small = {name: replace(town.sensor(name), columns=60) for name in ("vlp-16", "os1-32")}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("town.sensor", lambda name: small[name])
        (pair,) = simulated_pairs(tmp_path, ["town:3:vlp-16+os1-32"], 4)
    assert pair.sensors == ("vlp-16", "os1-32")
    counts = [len(robot.drive.scan(0)) for robot in (pair.pair.mapper, pair.pair.asker)]  # type: ignore[attr-defined]
    assert counts[0] < 60 * 16
    assert counts[1] > counts[0]
