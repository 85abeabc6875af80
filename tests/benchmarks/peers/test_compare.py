"""Comparison of peers, from drives to figures; Scan Context runs in our own environment."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import benchmarks
from benchmarks.peers.compare import run_peer
from benchmarks.peers.exchange import (
    MAP,
    POSES,
    QUERIES,
    Cloud,
    cloud_file,
    folder_of,
    read_answers,
)
from benchmarks.peers.runner import PACKAGES, PEERS, VARIANTS, System, systems_of
from benchmarks.peers.score import outcome_of
from cli import app
from tests.placecell.segment_builders import pose, write_odometry
from town import two_robots

pytestmark = pytest.mark.integration

ENVIRONMENT = Path(benchmarks.__file__).parents[1] / ".venv-peers" / "bin" / "python"
HERE = Path(sys.executable)
CHOSEN = dict(PEERS)

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return two_robots(tmp_path_factory.mktemp("town"), seed=3, scans=30, columns=200)


@pytest.fixture(autouse=True)
def scan_context_without_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Scan Context run without registration, which needs a package of the peers."""
    monkeypatch.setitem(PEERS, "scan-context", {"clouds": "near", "gates": []})


def run(*words: str | Path | int, status: int = 0) -> str:
    result = CliRunner().invoke(app, ["bench", "peers", *map(str, words)])
    assert result.exit_code == status, result.output
    return result.output


def test_report_of_two_drives(drives: tuple[Path, Path], tmp_path: Path) -> None:
    shown = run(
        *(*drives, "--peer", "scan-context", "--no-refine", "--queries", 4, "--seed", 5),
        *("--python", HERE, "--output", tmp_path, "--json", tmp_path / "figures.json"),
    )
    assert "4 queries of robot_b in a map of 30 captures of robot_a" in shown
    report = json.loads((tmp_path / "figures.json").read_text())
    assert (report["map_frames"], report["seed"], report["blocks"]) == (30, 5, False)
    assert (report["protocol"], report["local_map_radius"]) == ("v1", 40.0)
    assert {"processor", "cores"} <= set(report["machine"])
    (row,) = report["rows"]
    assert row["name"] == "scan-context"
    assert row["queries"] == 4
    assert row["settings"]["radius"] == 80
    assert row["versions"]["numpy"] == np.__version__
    assert row["p50_ms"] > 0
    # No file that the peer could read holds the true poses.
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "answers", "comparison.sha256", "figures.json", "map", "queries",
    ]  # fmt: skip
    assert sorted(file.suffix for file in (tmp_path / QUERIES).iterdir()) == [".npy"] * 4
    assert not (tmp_path / QUERIES / POSES).exists()


def test_stopped_run_continues(drives: tuple[Path, Path], tmp_path: Path) -> None:
    words = (
        *(*drives, "--no-refine", "--queries", 4, "--python", HERE, "--output", tmp_path),
        *("--json", tmp_path / "figures.json"),
    )
    assert "Run without --resume" in run(*words, "--peer", "scan-context", "--resume", status=1)
    # The packages of the second peer are not installed, so the run stops after the first peer.
    two = (*words, "--peer", "scan-context", "--peer", "kiss-matcher")
    run(*two, status=1)
    answers = tmp_path / "answers" / "scan-context.jsonl"
    kept = [each.stat().st_mtime_ns for each in (answers, cloud_file(tmp_path / MAP, 0))]
    assert "Peer 'kiss-matcher' failed" in run(*two, "--resume", status=1)
    run(*words, "--peer", "scan-context", "--resume")
    assert [each.stat().st_mtime_ns for each in (answers, cloud_file(tmp_path / MAP, 0))] == kept
    assert json.loads((tmp_path / "figures.json").read_text())["rows"][0]["queries"] == 4
    # A peer with an incomplete file of answers runs again.
    answers.write_text(answers.read_text()[:-5])
    run(*words, "--peer", "scan-context", "--resume")
    assert len(read_answers(answers, 4)[1]) == 4
    other = (*words, "--peer", "scan-context", "--resume", "--seed", 9)
    assert "Run without --resume" in run(*other, status=1)


def test_one_drive_is_split_into_blocks(drives: tuple[Path, Path], tmp_path: Path) -> None:
    shown = run(
        *(drives[0], "--peer", "scan-context", "--no-refine", "--radius", 60),
        *("--python", HERE, "--output", tmp_path),
    )
    assert "radius 60 m" in shown
    assert len(list((tmp_path / QUERIES).iterdir())) > 2


def test_error_without_the_environment_names_make_peers(
    drives: tuple[Path, Path], tmp_path: Path
) -> None:
    shown = run(*drives, "--python", tmp_path / "none", "--output", tmp_path / "x", status=1)
    assert "make peers" in shown
    assert not (tmp_path / "x").exists()


def test_error_names_the_peer_that_failed(drives: tuple[Path, Path], tmp_path: Path) -> None:
    shown = run(
        *(*drives, "--peer", "kiss-matcher", "--queries", 1),
        *("--python", HERE, "--output", tmp_path),
        status=1,
    )
    assert "Peer 'kiss-matcher' failed with exit status 1" in shown


def test_unknown_peers_are_refused(drives: tuple[Path, Path], tmp_path: Path) -> None:
    shown = run(*drives, "--peer", "nobody", "--output", tmp_path / "x", status=1)
    assert "unknown peer 'nobody'; expected one of scan-context" in shown


def test_drives_without_a_common_frame_are_refused(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in ("a", "b")]
    for folder in folders:
        write_odometry(folder, [np.ones((5, 3))], [pose()])
    assert "origin.txt" in run(*folders, "--python", HERE, "--output", tmp_path / "x", status=1)


LOAD = """
import sys
from benchmarks.peers import exchange, runner
from benchmarks.peers.systems import registered_context
names = {name.partition(".")[0] for name in sys.modules}
print(*names)
"""


def test_runner_loads_none_of_our_packages() -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOAD],
        cwd=Path(benchmarks.__file__).parents[1], capture_output=True, text=True, check=True,
    )  # fmt: skip
    loaded = set(done.stdout.split())
    assert not loaded & {"placecell", "training", "service", "numba", "onnxruntime", "faiss"}


def blocks(seed: int, reach: float) -> Cloud:
    """Return points of ground and boxes in a square that reaches `reach` meters to each side."""
    random = np.random.default_rng(seed)
    floor = int(240 * reach**2)
    parts = [
        np.column_stack(
            [random.uniform(-reach, reach, (floor, 2)), random.normal(-1.8, 0.01, floor)]
        )
    ]
    for _ in range(int(reach**2 / 40)):
        at, size = random.uniform(5 - reach, reach - 5, 2), random.uniform(1, 6, 2)
        height, turn = random.uniform(1, 7), random.uniform(0, np.pi)
        along = random.uniform(-0.5, 0.5, (2_000, 2))
        along[np.arange(2_000), random.integers(0, 2, 2_000)] = random.choice([-0.5, 0.5], 2_000)
        box = (along * size) @ pose(yaw=turn)[:2, :2].T + at
        parts.append(np.column_stack([box, random.uniform(-1.8, height, 2_000)]))
    return np.concatenate(parts).astype(np.float32)


@pytest.mark.parametrize("name", sorted(PEERS))
def test_each_peer_localizes_a_query_of_the_map(name: str, tmp_path: Path) -> None:
    if not ENVIRONMENT.is_file():
        pytest.skip("no environment of the peers: make peers")
    # MapClosures detects features only 16 m from the edge of its image.
    reach = 60.0 if name in {"map-closures", "kiss-slam"} else 25.0
    frames = [pose(200.0 * index, 30.0, 1.0, yaw=0.5 * index) for index in range(3)]
    query = pose(2.0, -1.0, 0.0, yaw=2.0)
    system = System(name, name, CHOSEN[name])
    mapped, asked = (folder_of(tmp_path, part, system.clouds) for part in (MAP, QUERIES))
    mapped.mkdir()
    asked.mkdir()
    for index in range(3):
        np.save(cloud_file(mapped, index), blocks(index, reach))
    np.save(mapped / POSES, frames)
    inverse = np.linalg.inv(query)
    seen = blocks(1, reach) @ inverse[:3, :3].T + inverse[:3, 3]
    np.save(cloud_file(asked, 0), seen.astype(np.float32))
    run_peer(system, tmp_path, ENVIRONMENT, refine=True)
    peer, answers = read_answers(tmp_path / "answers" / f"{name}+gicp.jsonl", 1)
    assert set(PACKAGES) <= set(peer.versions)
    outcome = outcome_of(answers[0], frames[1] @ query, mapped=True)
    assert outcome.meters < 0.2
    assert outcome.degrees < 1


def test_choose_measures_each_variant(
    drives: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    variants: list[dict[str, object]] = [
        {"clouds": kind, "gates": []} for kind in ("near", "submap", "long")
    ]
    monkeypatch.setitem(VARIANTS, "scan-context", variants)
    words = (
        *(*drives, "--peer", "scan-context", "--no-refine", "--queries", 2, "--choose"),
        *("--python", HERE, "--output", tmp_path, "--json", tmp_path / "figures.json"),
    )
    run(*words)
    rows = json.loads((tmp_path / "figures.json").read_text())["rows"]
    assert [row["name"] for row in rows] == [
        f"scan-context clouds={kind}, gates=[]" for kind in ("near", "submap", "long")
    ]
    assert [row["settings"]["clouds"] for row in rows] == ["near", "submap", "long"]
    assert len(list((tmp_path / "queries-long").iterdir())) == 2
    run(*words, "--resume")


def test_chosen_settings_run_unless_variants_are_asked_for() -> None:
    (one,) = systems_of(["kiss-matcher"], choose=False)
    assert (one.row, one.settings) == ("kiss-matcher", PEERS["kiss-matcher"])
    several = systems_of(["kiss-matcher", "fpfh-fgr"], choose=True)
    assert {system.peer for system in several} == {"kiss-matcher", "fpfh-fgr"}
    assert len({system.row for system in several}) == len(several)
