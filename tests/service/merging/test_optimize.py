"""`/maps/{map}/optimize` over HTTP, with maps of robots that drift around a block."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import (
    ChangesPage,
    CompactMap,
    Delta,
    MapCopy,
    decode,
    decode_delta,
    encode,
    encode_delta,
)
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply, take

from placecell.descriptors.manifest import Manifest
from placecell.pose_graph import PoseGraphUnavailableError
from service.core.problems import Problem
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import StoreError
from service.merging import bending
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import merge, models_that_judge, put
from tests.service.service_builders import assert_problem

pytestmark = pytest.mark.slow  # by their sum


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture(scope="module")
def drifting(manifest: Manifest) -> tuple[CompactMap, np.ndarray]:
    return drifting_map(manifest.model_id, seed=1)


def content(service: Any, name: str = "block") -> CompactMap:
    response = service.get(f"/maps/{name}")
    assert response.status_code == 200, response.text
    return decode(response.content)


def put_two_drifting(service: Any, manifest: Manifest) -> None:
    """Store a drifting map of each of two robots, `ann` and `bob`, with its odometry."""
    for seed, name in ((1, "ann"), (2, "bob")):
        given, _ = drifting_map(manifest.model_id, seed, laps=1, robot=name, odometry=True)
        put(service, name, given)


def optimize(service: Any, name: str = "block", **asked: Any) -> dict[str, Any]:
    response = service.post(f"/maps/{name}/optimize", params=asked)
    assert response.status_code == 200, response.text
    return dict(response.json())


def apart(content: CompactMap) -> float:
    """Return the mean distance between the captures of the first and the second lap, meters."""
    order = np.argsort(content.frame_times)
    first, second = np.split(content.frame_positions[order], 2)
    return float(np.linalg.norm(first - second, axis=1).mean())


def test_optimization_moves_laps_onto_each_other_and_can_be_undone(
    service: Any, drifting: tuple[CompactMap, np.ndarray]
) -> None:
    given, _ = drifting
    put(service, "block", given)
    before = apart(content(service))
    told = optimize(service, dry_run=True, frames=True)
    assert told["dry_run"]
    assert told["sequence"] is None
    assert told["loops_accepted"] > 10
    assert told["residual_after_m"] < 0.2 < told["residual_before_m"]
    assert len(told["frames"]) == told["captures"] == len(given.frame_times)
    assert [part["robots"] for part in told["parts"]] == [["ann"]]
    assert apart(content(service)) == before

    done = optimize(service)
    assert done["sequence"] == done["previous"] + 1
    after = content(service)
    assert apart(after) < 0.25 * before
    assert after.frame_tracks is not None
    assert len(after) == len(given)
    again = optimize(service)
    assert again["sequence"] == done["sequence"]

    undo = service.post(f"/maps/block/versions/{done['previous']}/restore")
    assert undo.status_code == 200
    np.testing.assert_array_equal(content(service).centroids, given.centroids)
    assert content(service).frame_tracks is None


def test_dry_run_in_the_body_changes_nothing(
    service: Any, drifting: tuple[CompactMap, np.ndarray]
) -> None:
    put(service, "block", drifting[0])
    response = service.post("/maps/block/optimize", json={"dry_run": True, "frames": True})
    assert response.json()["dry_run"], response.text
    assert len(response.json()["frames"]) == response.json()["captures"]
    assert content(service).frame_tracks is None
    for body in ({"dryrun": True}, {"dry_run": "yes"}, [True]):
        assert_problem(service.post("/maps/block/optimize", json=body), 422, "invalid-request")
    assert content(service).frame_tracks is None


@pytest.mark.parametrize("path", ["versions/1/restore", "compact"])
def test_options_in_the_body_of_a_route_without_one_are_refused(
    service: Any, drifting: tuple[CompactMap, np.ndarray], path: str
) -> None:
    put(service, "block", drifting[0])
    response = service.post(f"/maps/block/{path}", json={"dry_run": True})
    assert_problem(response, 422, "invalid-request", "in the query")
    assert service.post(f"/maps/block/{path}", json={}).status_code == 200


def test_segments_keep_their_place_relative_to_the_sensor(
    service: Any, drifting: tuple[CompactMap, np.ndarray]
) -> None:
    given, _ = drifting
    put(service, "block", given)
    optimize(service)
    after = content(service)
    for one in (given, after):
        assert (one.ids == given.ids).all()
    reach = [
        np.linalg.norm(one.centroids - one.frame_positions[one.frame_index], axis=1)
        for one in (given, after)
    ]
    np.testing.assert_allclose(reach[0], reach[1], atol=0.02)


def test_service_without_solver_names_the_extra(
    service: Any, drifting: tuple[CompactMap, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    put(service, "block", drifting[0])

    def missing() -> None:
        raise PoseGraphUnavailableError('pip install "placecell[pose-graph]"')

    monkeypatch.setattr(bending, "solver", missing)
    response = service.post("/maps/block/optimize")
    assert_problem(response, 501, "pose-graph-missing")
    assert "placecell[pose-graph]" in response.json()["detail"]


def test_write_during_the_optimization_is_a_conflict(
    service: Any,
    drifting: tuple[CompactMap, np.ndarray],
    manifest: Manifest,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    put(service, "block", drifting[0])
    other, _ = drifting_map(manifest.model_id, seed=2, laps=1)
    bend = bending.bend_content

    def meanwhile(*args: Any) -> Any:
        found = bend(*args)
        put(service, "block", other, **{"If-Match": "*"})
        return found

    monkeypatch.setattr(bending, "bend_content", meanwhile)
    response = service.post("/maps/block/optimize")
    assert_problem(response, 409, "map-changed")
    assert len(content(service)) == len(other)


def test_missing_map_and_wrong_version_are_refused(
    service: Any, drifting: tuple[CompactMap, np.ndarray]
) -> None:
    assert_problem(service.post("/maps/none/optimize"), 404, "unknown-map")
    put(service, "block", drifting[0])
    response = service.post("/maps/block/optimize", headers={"If-Match": '"0000000000000000-9"'})
    assert response.status_code == 412


def test_map_without_loops_stays_as_it_is(service: Any, manifest: Manifest) -> None:
    single, _ = drifting_map(manifest.model_id, seed=3, laps=1, odometry=True)
    put(service, "block", single)
    told = optimize(service)
    assert told["loops_accepted"] in range(20)
    if not told["loops_accepted"]:
        assert told["sequence"] == told["previous"]
        assert told["moved_max_m"] < 1e-6


def test_work_above_the_limit_is_refused(
    service: Any, drifting: tuple[CompactMap, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    from service import engine

    put(service, "block", drifting[0])
    refused = Problem(413, "too-much-work", "too much")

    def refuse(*_: Any) -> None:
        raise refused

    monkeypatch.setattr(engine, "check_cost", refuse)
    assert_problem(service.post("/maps/block/optimize"), 413, "too-much-work")


def test_robot_that_writes_on_after_the_optimization_follows_its_moved_captures(
    service: Any, manifest: Manifest
) -> None:
    whole, _ = drifting_map(manifest.model_id, seed=1, odometry=True)
    stop = np.sort(whole.frame_times)[-20]
    early = whole.frame_times[whole.frame_index] < stop
    put(service, "block", canonical(take(whole, early)))
    optimize(service)
    late = Delta(canonical(take(whole, ~early)), np.zeros(0, np.uint32))
    for _ in range(2):  # a repeated edit changes nothing
        edited = service.post("/maps/block/segments", content=encode_delta(late))
        assert edited.is_success, edited.text
    after = content(service)
    assert len(after) == len(whole)
    order = np.argsort(after.frame_times)
    steps = np.linalg.norm(np.diff(after.frame_positions[order], axis=0), axis=1)
    assert steps.max() < 6.5  # captures are 5 m apart, also where the edit joins
    raw = whole.frame_positions[np.argsort(whole.frame_times)]
    assert np.linalg.norm(after.frame_positions[order][-1] - raw[-1]) > 0.2


@pytest.mark.sqlite
def test_failed_write_leaves_the_whole_old_version(
    service: Any, drifting: tuple[CompactMap, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    put(service, "block", drifting[0])
    before = service.get("/maps/block").content

    def full(*_: Any, **__: Any) -> Any:
        raise StoreError("full", "the disk is full")

    monkeypatch.setattr(SqliteMapStore, "append", full)
    assert service.post("/maps/block/optimize").status_code >= 500
    monkeypatch.undo()
    assert service.get("/maps/block").content == before
    assert optimize(service)["sequence"] == 2


def test_merge_that_bends_lays_drifting_maps_on_each_other(
    service: Any, manifest: Manifest
) -> None:
    put_two_drifting(service, manifest)
    share = {}
    for rigid in (True, False):
        answer = merge(service, f"rigid-{rigid}", ["ann", "bob"], deduplicate=False, rigid=rigid)
        assert answer.status_code == 201, answer.text
        share[rigid] = doubles(content(service, f"rigid-{rigid}"))
    assert share[False] < 0.5 * share[True]
    again = merge(service, "rigid-False", ["ann", "bob"], deduplicate=False, rigid=False)
    assert again.status_code == 200, again.text
    assert doubles(content(service, "rigid-False")) < 0.5 * share[True]


def test_merge_that_bends_and_deduplicates_again_changes_nothing(
    service: Any, manifest: Manifest
) -> None:
    put_two_drifting(service, manifest)
    first = merge(service, "site", ["ann", "bob"], rigid=False)
    assert first.status_code == 201, first.text
    assert sum(part["repeats"] for part in first.json()["parts"]) > 100
    for names in (["ann", "bob"], ["bob"]):
        again = merge(service, "site", names, rigid=False)
        assert again.status_code == 200, again.text
        told = again.json()
        assert [part["added"] for part in told["parts"]] == [0] * len(names)
        assert (told["changed"], told["removed"]) == (0, 0)
        assert told["sequence"] == told["previous"]


def doubles(merged: CompactMap) -> float:
    """Return the mean distance between the captures of two robots at the same place, meters."""
    first, second = (
        merged.frame_positions[merged.frame_tracks == track]
        for track in np.unique(merged.frame_tracks)  # type: ignore[arg-type]
    )
    return float(np.linalg.norm(first - second, axis=1).mean())


def test_cancelled_optimization_stops_and_writes_nothing(
    service: Any, drifting: tuple[CompactMap, np.ndarray]
) -> None:
    put(service, "block", drifting[0])
    response = service.post("/maps/block/optimize", headers={"Placecell-Timeout": "0.3"})
    assert response.status_code == 504
    assert decode(service.get("/maps/block").content).frame_tracks is None


def pulled(service: Any, old: CompactMap, **asked: Any) -> tuple[CompactMap, int, list[Delta]]:
    """Update a copy of version 1; return it, the bytes that it took, and the pages."""
    copy = MapCopy("block", old, service.get("/maps/block/versions").json()["versions"][-1]["etag"])
    size, pages = 0, []
    while True:
        since, cursor = copy.request
        more = {} if cursor is None else {"cursor": cursor}
        answer = service.get("/maps/block/changes", params={"since": since} | more | asked)
        assert answer.status_code == 200, answer.text
        size += len(answer.content)
        pages.append(decode_delta(answer.content))
        etag, following = answer.headers["ETag"].strip('"'), answer.headers.get("Placecell-Next")
        if copy.take(ChangesPage(pages[-1], etag, following)):
            assert copy.content is not None
            return copy.content, size, pages


def test_pull_after_an_optimization_carries_captures_and_not_segments(
    service: Any, manifest: Manifest
) -> None:
    given, _ = drifting_map(manifest.model_id, seed=1, side=10, odometry=True)
    put(service, "block", given)
    optimize(service)
    edited = take(canonical(given), slice(0, 3))
    edited = replace(edited, codes=np.ones_like(edited.codes))
    edit = encode_delta(Delta(edited, given.ids[10:12]))
    assert service.post("/maps/block/segments", content=edit).is_success
    whole = service.get("/maps/block").content
    plain, many, pages = pulled(service, given)
    assert encode(plain) == whole
    assert {page.moved for page in pages} == {None}
    for limit in (20_000, 7):  # in one part and in many
        content, few, pages = pulled(service, given, moved=True, limit=limit)
        assert encode(content) == whole
        assert sum(len(page) for page in pages) == 5
        assert sum(0 if page.moved is None else len(page.moved) for page in pages) > 70
    assert len(pages) > 10
    _, few, _ = pulled(service, given, moved=True)
    assert few < 0.3 * many


def test_pull_after_the_undo_of_an_optimization(service: Any, manifest: Manifest) -> None:
    given, _ = drifting_map(manifest.model_id, seed=1, side=10, odometry=True)
    put(service, "block", given)
    told = optimize(service)
    moved = service.get("/maps/block").content
    service.post(f"/maps/block/versions/{told['previous']}/restore")
    answer = service.get("/maps/block/changes", params={"since": told["etag"], "moved": True})
    back = apply(decode(moved), decode_delta(answer.content))
    assert encode(back) == service.get("/maps/block").content == encode(given)
