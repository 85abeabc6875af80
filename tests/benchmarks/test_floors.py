"""Benchmark of similar floors in its short form (row B1)."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.localization.floors import CASES, FloorCase, measure_floors, run_trial
from benchmarks.localization.similar_places import PRESENT
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from cli import app
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.core.settings import Settings
from service.engine import Engine
from tests.benchmarks.test_ladder import recorded_from_two_places

pytestmark = pytest.mark.slow

NAMES = (DEFAULT_MODEL, "group")


@pytest.fixture(scope="module")
def samplers() -> list[DescriptorSampler]:
    """Random descriptors, and views that differ by a third of their spread."""
    random = np.random.default_rng(0)
    drawn = []
    for name in NAMES:
        manifest = Manifest.load(MODELS_FOLDER / name)
        reach = manifest.quantizer.step * manifest.quantizer.highest
        descriptors = random.normal(scale=0.5 * reach, size=(600, manifest.dimension))
        differences = random.normal(scale=0.15 * reach, size=(600, manifest.dimension))
        drawn.append(
            DescriptorSampler(
                manifest, descriptors.astype(np.float32), differences.astype(np.float32)
            )
        )
    return drawn


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[Engine]:
    settings = Settings(data_dir=tmp_path, models_dir=MODELS_FOLDER, model=NAMES[0], also=NAMES[1:])
    with Engine.open(settings) as opened:
        yield opened


def test_B1_pose_is_never_sure_on_the_wrong_floor_and_right_where_the_difference_decides(
    samplers: list[DescriptorSampler],
) -> None:
    report = measure_floors(samplers, MODELS_FOLDER, NAMES, 4 * len(CASES), seed=100)
    assert report["trials"] == 4 * len(CASES)
    assert report["wrong_but_sure"] == 0
    assert sum(row["trials"] for row in report["by_case"].values()) == report["trials"]
    assert sum(row["trials"] for row in report["by_share"].values()) == report["trials"]
    decided = report["where_the_difference_decides"]
    assert decided["trials"] >= 5
    assert decided["right"] >= 0.95 * decided["trials"]
    # If the robot sees only what all floors have, it is never localized.
    assert report["by_case"]["unchanged part only"]["right"] == 0
    assert report["by_case"]["unchanged part only"]["names_both"] == 4


def test_trial_with_the_same_seed_has_the_same_result(
    samplers: list[DescriptorSampler], engine: Engine
) -> None:
    case = FloorCase("two floors", objects=60, seen=20)
    first = run_trial(engine, samplers, NAMES, case, 3)
    assert run_trial(engine, samplers, NAMES, case, 3) == first
    assert not engine.maps.all()


def test_command_writes_a_report(tmp_path: Path) -> None:
    recorded_from_two_places().save(tmp_path / "boxes.safetensors")
    words = ["bench", "floors", "--segments", tmp_path / "boxes.safetensors", "--trials", 2,
             "--json", tmp_path / "floors.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "floors.json").read_text())
    assert report["trials"] == 2
    assert {"wrong_but_sure", "right", "ambiguous", "by_share", "machine", "seed"} <= {*report}


@pytest.mark.parametrize("kind", ["indoor", "streets"])
def test_simulated_places_are_asked_with_and_without_the_right_one(
    tmp_path: Path, kind: str
) -> None:
    words = ["bench", "floors", "--simulate", kind, "--trials", 6, "--scans", 24, "--seed", 3,
             "--output", tmp_path, "--json", tmp_path / "floors.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "floors.json").read_text())
    assert (report["trials"], report["kind"], report["sensor"]) == (6, kind, "vlp-16")
    cases = report["by_case"]
    assert len(cases) == (3 if kind == "indoor" else 2)
    assert {row["trials"] for row in cases.values()} <= {2, 3}
    assert sum(row["right"] for name, row in cases.items() if name != PRESENT) == 0
    assert len(report["groups"]) == 1
    assert report["wrong_but_sure"] == 0
    assert [*report["by_share"]] == (["0.0"] if kind == "indoor" else [])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--simulate", "moon"], "Invalid --simulate 'moon'"),
        (["--simulate", "indoor", "--sensor", "eye"], "eye"),
        (["--model", "group"], "--model needs --simulate"),
    ],
)
def test_wrong_option_of_simulated_places_is_refused(words: list[str], said: str) -> None:
    result = CliRunner().invoke(app, ["bench", "floors", *words])
    assert result.exit_code != 0
    assert said in result.output
