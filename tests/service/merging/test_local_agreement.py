"""Merges of maps that drift too much to align as a whole, over HTTP."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, decode, moved

from placecell.core.types import Float64
from placecell.descriptors.manifest import Manifest
from placecell.localization import Pose
from placecell.localization.registration import register_yaw
from service.merging.bending import robots_of_captures
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import merge, models_that_judge, put
from tests.service.service_builders import assert_problem

pytestmark = pytest.mark.slow  # by their sum

DRIFT: dict[str, Any] = {"laps": 1, "meters": 0.1, "degrees": 0.5, "odometry": True}


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def model_id(models_dir: Path) -> str:
    return Manifest.load(models_dir / "tiny").model_id


def put_drifting(service: Any, model_id: str, name: str, seed: int, block: int = 0) -> Float64:
    """Store a map in a frame of its own; return the true positions of its captures."""
    given, true = drifting_map(model_id, seed, robot=name, block=block, **DRIFT)
    pose = Pose.of_yaw(0.9 * seed, np.array([700.0 * seed, -300.0, 4.0]))
    put(service, name, moved(given, pose.rotation, pose.translation, f"{name}'s odometry"))
    return true


def content(service: Any, name: str) -> CompactMap:
    response = service.get(f"/maps/{name}")
    assert response.status_code == 200, response.text
    return decode(response.content)


def error(merged: CompactMap, true: Float64) -> float:
    """Return the root mean square distance of two robots at the same places, meters."""
    robots = np.array(robots_of_captures(merged))
    parts = [
        merged.frame_positions[rows[np.argsort(merged.frame_times[rows])]]
        for rows in (np.flatnonzero(robots == name) for name in dict.fromkeys(robots.tolist()))
    ]
    assert [len(each) for each in parts] == [len(true)] * 2
    return float(np.sqrt(((parts[0] - parts[1]) ** 2).sum(axis=1).mean()))


def test_merge_that_bends_joins_maps_that_fit_only_locally(
    service: Any, model_id: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    localized: list[int] = []
    for name in ("between_maps", "bend"):
        module = import_module(f"placecell.pose_graph.{name}")

        def counted(*args: Any, find: Any = module.find_loops) -> Any:
            localized.append(len(args[4]))
            return find(*args)

        monkeypatch.setattr(module, "find_loops", counted)
    true = put_drifting(service, model_id, "ann", 1)
    put_drifting(service, model_id, "bob", 2)
    rigid = merge(service, "both", ["ann", "bob"], deduplicate=False)
    assert_problem(rigid, 409, "not-aligned", "nothing was changed")
    told = merge(service, "both", ["ann", "bob"], deduplicate=False, rigid=False)
    assert told.status_code == 201, told.text
    (pair,) = told.json()["alignments"]
    assert pair["reason"] is None
    # The loops between the maps are those of the optimization of the merged map.
    assert localized[0] > 60
    assert sum(localized[1:]) < 0.1 * localized[0]
    merged = content(service, "both")
    assert error(merged, true) < 0.5
    # The frame is still the first map's, apart from its drift.
    first = content(service, "ann").frame_positions
    rows = np.array(robots_of_captures(merged)) == "ann"
    lies = register_yaw(merged.frame_positions[rows], first, np.ones(len(first)))
    meters, angle = lies.difference(Pose.of_matrix(np.eye(4)), first.mean(axis=0))
    assert meters < 5.0
    assert np.degrees(angle) < 8.0

    again = merge(service, "both", ["ann", "bob"], deduplicate=False, rigid=False)
    assert again.status_code == 200, again.text
    assert error(content(service, "both"), true) < 0.5
    assert len(content(service, "both")) == len(merged)


def test_merge_that_bends_refuses_drifting_maps_of_different_places(
    service: Any, model_id: str
) -> None:
    put_drifting(service, model_id, "ann", 1)
    put_drifting(service, model_id, "far", 2, block=5)
    refused = merge(service, "both", ["ann", "far"], rigid=False)
    assert_problem(refused, 409, "not-aligned", "nothing was changed")


def test_map_of_another_place_is_left_out_of_a_merge_that_bends(
    service: Any, model_id: str
) -> None:
    true = put_drifting(service, model_id, "ann", 1)
    put_drifting(service, model_id, "far", 3, block=5)
    put_drifting(service, model_id, "bob", 2)
    told = merge(service, "both", ["ann", "far", "bob"], deduplicate=False, rigid=False).json()
    assert [part["merged"] for part in told["parts"]] == [True, False, True]
    reasons = [each["reason"] for each in told["alignments"]]
    assert reasons == ["inconsistent", None, "inconsistent"]
    assert error(content(service, "both"), true) < 0.5
