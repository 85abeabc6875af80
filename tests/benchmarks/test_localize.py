"""Benchmark of `/localize` on a small map."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.load import localize
from benchmarks.load.generator import Load, LoadResult
from benchmarks.load.localize import LocalizePlan, road_with_queries
from benchmarks.localization import hard_queries
from benchmarks.localization.hard_queries import HARD_QUERIES
from benchmarks.localization.steps import STEPS
from benchmarks.synthetic_maps.descriptor_sampler import VIEWS, DescriptorSampler
from cli import app
from evaluation.poses.queries import random_frame
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from tests.benchmarks.test_ladder import recorded_from_two_places

pytestmark = [pytest.mark.integration, pytest.mark.slow]


@pytest.mark.integration
def test_command_writes_a_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def small(sizes: tuple[int, ...], seconds: float) -> LocalizePlan:
        return LocalizePlan(sizes, requests=5, rate=5, seconds=seconds)

    monkeypatch.setattr(localize, "LocalizePlan", small)
    recorded_from_two_places().save(tmp_path / "boxes.safetensors")
    monkeypatch.setattr(hard_queries, "MAP_SEGMENTS", 2_500)
    words = ["bench", "localize", "--segments", tmp_path / "boxes.safetensors", "--seconds", 1,
             "--size", 2000, "--descriptors", 20, "--descriptors", 30, "--steps",
             "--json", tmp_path / "localize.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "localize.json").read_text())
    assert [row["descriptors"] for row in report["rows"]] == [20, 30]
    for row in report["rows"]:
        assert row["segments"] == 2000
        assert row["requests"] == 5
        assert 0 < row["rate"] <= 5
        assert row["milliseconds"]["p50"] > 0
        assert {"search", "verify"} <= set(row["stages"])
        assert 0 <= row["localised_right"] <= 1
    assert {row["query"] for row in report["steps"]} == set(HARD_QUERIES)
    assert {tuple(row["steps"]) for row in report["steps"]} == {STEPS}
    assert "verify" in result.output
    assert "fine-grid" in result.output


@pytest.mark.parametrize(
    ("refused", "rate"), [(0, 8.0), (2, 2.0), (5, None)], ids=["none", "twice", "always"]
)
def test_rate_is_halved_until_no_request_is_refused(
    refused: int, rate: float | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loads: list[Load] = []

    async def send(load: Load, folder: Path) -> LoadResult:
        del folder
        loads.append(load)
        return LoadResult([200] * 19 + [429 if len(loads) <= refused else 200], [1.0] * 20)

    monkeypatch.setattr(localize, "send_from_process", send)
    plan = LocalizePlan(rate=10.0, seconds=2.0)
    address = "http://127.0.0.1:8080"
    if rate is None:
        with pytest.raises(RuntimeError, match=r"429.* at 0\.5 requests per second"):
            localize._answered([b""], address, plan, 8.0, tmp_path)
    else:
        outcome, found = localize._answered([b""], address, plan, 8.0, tmp_path)
        assert found == rate
        assert localize._figures(outcome, found, 1.0)["rate"] == rate
    # As many requests at each rate.
    assert {load.rate * load.seconds for load in loads} == {20.0}


def test_queries_hold_objects_of_the_map() -> None:
    extractor = load_extractor(MODELS_FOLDER / DEFAULT_MODEL)
    views = DescriptorSampler.from_recording(extractor, recorded_from_two_places(), 0)
    frame = random_frame(1)
    road, asked = road_with_queries(
        views, 2000, LocalizePlan(requests=3, queries=20), frame, seed=0
    )
    road.check()
    assert len(road) == 2000
    assert len(asked) == 3
    back = frame.inverse()
    for each in asked:
        seen = back.apply(each.centroids)
        apart = np.linalg.norm(road.centroids[:, None] - seen, axis=2)
        assert ((apart < 2).sum(axis=0) >= VIEWS - 1).all()
