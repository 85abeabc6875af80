"""Anchors follow the captures around them when an optimization moves these."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, encode_delta
from placecell_client.maps.edit import take
from scipy.spatial.transform import Rotation

from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.core.types import Float64
from placecell.descriptors.manifest import Manifest
from placecell.pose_graph.frames import headings, rotated
from service.annotations.moving import CaptureMovement
from service.merging import merge as merging
from service.merging.bending import bend_content
from tests.service.annotations.test_anchors import GEO
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import merge, models_that_judge, put
from tests.service.service_builders import assert_problem

pytestmark = pytest.mark.slow  # by their sum

SIDE = 10


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture(scope="module")
def drifting(manifest: Manifest) -> CompactMap:
    return drifting_map(manifest.model_id, seed=1, side=SIDE)[0]


def content(service: Any, name: str = "block") -> CompactMap:
    return decode(service.get(f"/maps/{name}").content)


def yaws_of(given: CompactMap) -> Float64:
    return headings(Rotation.from_quat(given.frame_orientations).as_matrix())


def anchor_beside(service: Any, given: CompactMap, capture: int, name: str = "dock") -> np.ndarray:
    """Set an anchor one meter ahead of a capture; return its position."""
    ahead = np.array([[1.0, 0.5, 0.0]])
    position = given.frame_positions[capture] + rotated(ahead, yaws_of(given)[[capture]])[0]
    body = {"position": position.tolist(), "orientation": [0.0, 0.0, 0.0, 1.0]}
    assert service.put(f"/maps/block/anchors/{name}", json=body).is_success
    return np.asarray(position)


def position_of(service: Any, name: str = "dock", of: str = "block") -> np.ndarray:
    found = service.get(f"/maps/{of}/anchors/{name}")
    assert found.status_code == 200, found.text
    return np.array(found.json()["position"])


def test_anchor_moves_with_its_capture_and_back(service: Any, drifting: CompactMap) -> None:
    put(service, "block", drifting)
    last = int(np.argmax(drifting.frame_times))
    given = anchor_beside(service, drifting, last)
    at = {"position": given.tolist()}
    assert service.put("/maps/block/anchor", json=GEO | at).is_success
    assert service.post("/maps/block/optimize").is_success
    after = content(service)
    order = int(np.argmax(after.frame_times))
    ahead = rotated(np.array([[1.0, 0.5, 0.0]]), yaws_of(after)[[order]])[0]
    moved = position_of(service)
    assert np.linalg.norm(moved - given) > 0.1
    np.testing.assert_allclose(moved, after.frame_positions[order] + ahead, atol=1e-5)
    geo = service.get("/maps/block/anchor").json()
    np.testing.assert_allclose(geo["position"], moved, atol=1e-9)
    anchor = GeoAnchor(
        geo["lat"], geo["lon"], geo["height"], geo["yaw_deg"], 0.5, tuple(geo["position"])
    )
    before = GeoAnchor(**GEO | {"position": tuple(given)})
    there = to_geodetic(after.frame_positions[order], anchor)
    was = to_geodetic(drifting.frame_positions[last], before)
    np.testing.assert_allclose(there, was, atol=1e-8)  # the sensor stands at the same place

    assert service.post("/maps/block/versions/1/restore").is_success
    np.testing.assert_allclose(position_of(service), given, atol=1e-5)
    geo = service.get("/maps/block/anchor").json()
    np.testing.assert_allclose(geo["position"], given, atol=1e-5)
    assert geo["yaw_deg"] == pytest.approx(GEO["yaw_deg"], abs=1e-5)


def test_anchor_that_is_set_anew_follows_its_new_capture(
    service: Any, drifting: CompactMap
) -> None:
    put(service, "block", drifting)
    anchor_beside(service, drifting, 79)
    assert service.post("/maps/block/optimize").is_success
    first = content(service).frame_positions[0]
    body = {"position": first.tolist(), "orientation": [0.0, 0.0, 0.0, 1.0]}
    assert service.put("/maps/block/anchors/dock", json=body).is_success
    assert service.post("/maps/block/versions/1/restore").is_success
    np.testing.assert_allclose(position_of(service), drifting.frame_positions[0], atol=1e-5)


def test_dry_run_moves_no_anchor(service: Any, drifting: CompactMap) -> None:
    put(service, "block", drifting)
    given = anchor_beside(service, drifting, 79)
    assert service.post("/maps/block/optimize", params={"dry_run": True}).is_success
    assert position_of(service).tolist() == given.tolist()


def test_anchors_without_a_common_capture_stay(drifting: CompactMap) -> None:
    nothing = take(drifting, slice(0, 0))
    movement = CaptureMovement(drifting, nothing)
    assert movement.is_none
    assert movement.bound(np.zeros(3), None) is None
    np.testing.assert_array_equal(movement.at(np.zeros(3)).matrix, np.eye(4))
    itself = CaptureMovement(drifting, drifting)
    assert itself.is_none
    found = itself.bound(drifting.frame_positions[7], 4_000_000_000)
    assert found is not None
    assert drifting.frame_index[found[0]] == 7


@pytest.fixture
def two_robots(service: Any, manifest: Manifest) -> dict[str, CompactMap]:
    maps = {}
    for seed, name in ((1, "ann"), (2, "bob")):
        maps[name], _ = drifting_map(
            manifest.model_id, seed, laps=1, robot=name, odometry=True, side=SIDE
        )
        put(service, name, maps[name])
    return maps


def test_merge_that_bends_carries_anchors_to_the_moved_captures(
    service: Any, two_robots: dict[str, CompactMap]
) -> None:
    given = two_robots["bob"]
    position = given.frame_positions[-1]
    body = {"position": position.tolist(), "orientation": [0.0, 0.0, 0.0, 1.0]}
    assert service.put("/maps/bob/anchors/dock", json=body).is_success
    assert merge(service, "site", ["ann", "bob"], deduplicate=False, rigid=False).is_success
    merged = content(service, "site")
    assert merged.frame_tracks is not None
    places = merged.frame_positions[merged.frame_tracks == 3]
    times = merged.frame_times[merged.frame_tracks == 3]
    np.testing.assert_allclose(position_of(service, of="site"), places[times.argmax()], atol=1e-5)


def written_during(service: Any, monkeypatch: pytest.MonkeyPatch, edits: list[bytes]) -> list[int]:
    """Send an edit during each optimization of a merge; return the status of each."""
    statuses: list[int] = []

    def meanwhile(*args: Any) -> Any:
        found = bend_content(*args)
        if edits:
            response = service.post("/maps/site/segments", content=edits.pop())
            statuses.append(response.status_code)
        return found

    monkeypatch.setattr("service.merging.merge.bend_content", meanwhile)
    return statuses


def edit(given: CompactMap, rows: slice, number: int) -> bytes:
    ids = np.arange(500_000 + 10 * number, 500_000 + 10 * number + 2, dtype=np.uint32)
    part = take(given, rows)
    return encode_delta(Delta(replace(part, ids=ids), np.zeros(0, np.uint32)))


def test_write_during_a_merge_that_bends_is_not_lost_and_does_not_wait(
    service: Any, two_robots: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    put(service, "site", two_robots["ann"])
    edits = [edit(two_robots["ann"], slice(0, 2), 0)]
    statuses = written_during(service, monkeypatch, edits)
    answer = merge(service, "site", ["bob"], deduplicate=False, rigid=False)
    assert answer.status_code == 200, answer.text
    assert statuses == [200]
    merged = content(service, "site")
    assert {500_000, 500_001} <= {*merged.ids.tolist()}
    assert len(merged) == sum(map(len, two_robots.values())) + 2
    history = service.get("/maps/site/versions").json()["versions"]
    assert [each["operation"] for each in history] == ["bend", "edit", "put"]


def test_merge_that_is_always_overtaken_is_a_conflict(
    service: Any, two_robots: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    put(service, "site", two_robots["ann"])
    edits = [edit(two_robots["ann"], slice(0, 2), number) for number in range(merging.TRIES)]
    written_during(service, monkeypatch, edits)
    response = merge(service, "site", ["bob"], deduplicate=False, rigid=False)
    assert_problem(response, 409, "map-changed")
    assert len(content(service, "site")) == len(two_robots["ann"]) + 2 * merging.TRIES
