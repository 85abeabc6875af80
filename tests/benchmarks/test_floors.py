"""The bench of look-alike floors, in its short form (row B1)."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.localization.floors import CASES, FloorCase, load_models, measure_floors, run_trial
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from cli import app
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.inference.model_registry import Model
from tests.benchmarks.test_ladder import recorded_from_two_places

pytestmark = pytest.mark.slow

NAMES = (DEFAULT_MODEL, "group")


@pytest.fixture(scope="module")
def models() -> list[Model]:
    return load_models(MODELS_FOLDER, NAMES)


@pytest.fixture(scope="module")
def views(models: list[Model]) -> list[DescriptorSampler]:
    """Descriptors drawn at random, and views that differ by a third of their spread."""
    random = np.random.default_rng(0)
    drawn = []
    for model in models:
        manifest = model.manifest
        reach = manifest.quantizer.step * manifest.quantizer.highest
        found = random.normal(scale=0.5 * reach, size=(600, manifest.dimension))
        apart = random.normal(scale=0.15 * reach, size=(600, manifest.dimension))
        drawn.append(
            DescriptorSampler(manifest, found.astype(np.float32), apart.astype(np.float32))
        )
    return drawn


def test_B1_never_sure_of_the_wrong_floor_and_right_where_the_difference_decides(
    views: list[DescriptorSampler], models: list[Model]
) -> None:
    report = measure_floors(views, models, 4 * len(CASES), seed=100)
    assert report["trials"] == 4 * len(CASES)
    assert report["wrong_but_sure"] == 0
    assert sum(row["trials"] for row in report["by_case"].values()) == report["trials"]
    assert sum(row["trials"] for row in report["by_share"].values()) == report["trials"]
    decided = report["where_the_difference_decides"]
    assert decided["trials"] >= 5
    assert decided["right"] >= 0.95 * decided["trials"]
    # Where all floors show the robot the same, none is told.
    assert report["by_case"]["unchanged part only"]["right"] == 0
    assert report["by_case"]["unchanged part only"]["names_both"] == 4


def test_a_trial_is_the_same_each_time(views: list[DescriptorSampler], models: list[Model]) -> None:
    case = FloorCase("two floors", things=60, seen=20)
    assert run_trial(views, models, case, 3) == run_trial(views, models, case, 3)


def test_the_command_writes_its_report(tmp_path: Path) -> None:
    recorded_from_two_places().save(tmp_path / "boxes.safetensors")
    words = ["bench", "floors", "--segments", tmp_path / "boxes.safetensors", "--trials", 2,
             "--json", tmp_path / "floors.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "floors.json").read_text())
    assert report["trials"] == 2
    assert {"wrong_but_sure", "right", "ambiguous", "by_share", "machine", "seed"} <= {*report}
