"""A merge carries anchors of the maps into the merged map, by its transforms."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.descriptors.manifest import Manifest
from tests.service.merging.merged_map_builders import (
    driven,
    merge,
    models_that_judge,
    put,
    relative,
)

pytestmark = pytest.mark.slow  # by their sum

GEO: dict[str, Any] = {"lat": 49.0, "lon": 8.4, "height": 110.0, "yaw_deg": 20.0, "accuracy": 0.5}


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    for number, (name, ends) in enumerate({"east": (0, 150), "west": (60, 210)}.items()):
        put(service, name, driven(manifest.model_id, name, *ends, time=1e9 + 1e6 * number))
    return service


def set_pose(service: Any, name: str, anchor: str, position: Any, yaw: float = 0.0) -> None:
    turned = [0.0, 0.0, float(np.sin(yaw / 2)), float(np.cos(yaw / 2))]
    body = {"position": list(position), "orientation": turned}
    assert service.put(f"/maps/{name}/anchors/{anchor}", json=body).is_success


def poses(service: Any, name: str) -> dict[str, list[float]]:
    listed = service.get(f"/maps/{name}/anchors").json()["anchors"]
    return {each["name"]: each["position"] for each in listed}


def test_merge_carries_anchors_and_tells_conflicts(stocked: Any) -> None:
    dock = np.array([10.0, 20.0, 1.0])
    in_west = relative("west", "east").apply(dock)
    set_pose(stocked, "east", "dock", dock)
    turn = relative("west", "east").yaw
    set_pose(stocked, "west", "dock", in_west, turn)  # the same place
    set_pose(stocked, "west", "gate", in_west + [5.0, 0.0, 0.0])
    set_pose(stocked, "east", "shelf", dock)
    set_pose(stocked, "west", "shelf", in_west + [30.0, 0.0, 0.0])  # another place
    assert stocked.put("/maps/west/anchor", json=GEO).is_success
    dry = merge(stocked, "site", ["east", "west"], dry_run=True).json()
    told = merge(stocked, "site", ["east", "west"])
    assert told.status_code == 201, told.text
    outcomes = {(each["map"], each["anchor"]): each["outcome"] for each in told.json()["anchors"]}
    assert outcomes == {
        ("east", "dock"): "carried",
        ("east", "shelf"): "carried",
        ("west", None): "carried",
        ("west", "dock"): "kept",
        ("west", "gate"): "carried",
        ("west", "shelf"): "conflict",
    }
    assert dry["anchors"] == told.json()["anchors"]
    (apart,) = [each["meters"] for each in told.json()["anchors"] if each["outcome"] == "conflict"]
    assert apart == pytest.approx(30.0, abs=0.5)
    found = poses(stocked, "site")
    np.testing.assert_allclose(found["dock"], dock, atol=0.3)
    np.testing.assert_allclose(found["shelf"], dock, atol=0.3)
    gate = relative("east", "west").apply(in_west + [5.0, 0.0, 0.0])
    np.testing.assert_allclose(found["gate"], gate, atol=0.3)
    # A point is at the same place on the Earth by both maps.
    site = stocked.get("/maps/site/anchor").json()
    anchor = GeoAnchor(**{key: site[key] for key in (*GEO, "position")})
    one = to_geodetic(np.array([dock]), anchor)[0]
    other = to_geodetic(np.array([in_west]), GeoAnchor(**GEO))[0]
    np.testing.assert_allclose(one[:2], other[:2], atol=1e-5)


def test_merging_again_and_undoing_keep_the_anchors(stocked: Any) -> None:
    set_pose(stocked, "east", "dock", (10.0, 20.0, 1.0))
    stocked.put("/maps/east/anchor", json=GEO)
    assert merge(stocked, "site", ["east", "west"]).status_code == 201
    before = poses(stocked, "site"), stocked.get("/maps/site/anchor").json()
    set_pose(stocked, "west", "gate", (1.0, 2.0, 3.0))
    again = merge(stocked, "site", ["east", "west"])
    assert again.status_code == 200, again.text
    outcomes = {(each["map"], each["anchor"]): each["outcome"] for each in again.json()["anchors"]}
    assert outcomes == {
        ("east", None): "kept",
        ("east", "dock"): "kept",
        ("west", "gate"): "carried",
    }
    previous = again.json()["previous"]
    assert stocked.post(f"/maps/site/versions/{previous}/restore").is_success
    assert poses(stocked, "site").items() >= before[0].items()
    assert stocked.get("/maps/site/anchor").json() == before[1]


def test_another_place_on_the_earth_is_a_conflict(stocked: Any) -> None:
    stocked.put("/maps/east/anchor", json=GEO)
    stocked.put("/maps/west/anchor", json=GEO | {"lat": 49.1})
    told = merge(stocked, "site", ["east", "west"]).json()["anchors"]
    assert [each["outcome"] for each in told] == ["carried", "conflict"]
    assert told[1]["meters"] > 10_000
