"""Edits of a shared map: all or nothing, and no robot loses its segments."""

import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Delta, decode, encode, encode_delta

from placecell.descriptors.manifest import Manifest
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

Edit = Callable[..., bytes]


@pytest.fixture
def edit(manifest: Manifest) -> Edit:
    """Return a maker of delta files from rows, first id, robot, and ids to remove."""

    def edited(
        rows: int, first: int = 100, robot: str = "ann", removed: Any = (), seed: int = 0
    ) -> bytes:
        return edit_of(random_codes(rows, seed), manifest.model_id, first, robot, removed)

    return edited


@pytest.fixture
def yard(service: Any, manifest: Manifest) -> str:
    """Store a map of robot ann, ids 100 to 109; return its path."""
    service.put("/maps/yard", content=encode(map_of(random_codes(10), manifest.model_id)))
    return "/maps/yard"


def ids_of(service: Any, path: str) -> list[int]:
    return [int(id_) for id_ in decode(service.get(path).content).ids]


def test_edit_adds_replaces_and_removes_at_once(
    service: Any, yard: str, edit: Edit, manifest: Manifest
) -> None:
    before = service.get(yard).headers["etag"]
    response = service.post(f"{yard}/segments", content=edit(4, 108, removed=[100, 103], seed=7))
    assert response.status_code == 200
    told = response.json()
    assert response.headers["etag"] == f'"{told.pop("etag")}"' == service.get(yard).headers["etag"]
    assert response.headers["etag"] != before
    assert told == {
        "map": "yard",
        "sequence": 2,
        "segments": 10,
        "changed": 4,
        "removed": 2,
        "repeats": 0,
    }
    assert ids_of(service, yard) == [101, 102, 104, 105, 106, 107, 108, 109, 110, 111]
    codes = decode(service.get(yard).content).codes
    np.testing.assert_array_equal(codes[-4:], random_codes(4, 7))
    body = {"model_id": manifest.model_id, "codes": random_codes(4, 7).tolist(), "k": 1}
    found = service.post("/match", json=body).json()["queries"]
    assert [one["candidates"][0]["id"] for one in found] == [108, 109, 110, 111]
    assert [one["candidates"][0]["distance"] for one in found] == [0, 0, 0, 0]
    (summary,) = service.get("/maps").json()["maps"]
    assert (summary["segments"], summary["sequence"]) == (10, 2)


def test_repeated_edit_changes_nothing(service: Any, yard: str, edit: Edit) -> None:
    data = edit(4, 108, removed=[100], seed=7)
    first = service.post(f"{yard}/segments", content=data)
    for headers in ({}, {"If-Match": '"x"'}):
        again = service.post(f"{yard}/segments", content=data, headers=headers)
        assert again.status_code == 200
        assert again.headers["etag"] == first.headers["etag"]
        assert again.json() == first.json() | {"changed": 0, "removed": 0}
    # Only segments that differ count.
    more = service.post(f"{yard}/segments", content=edit(5, 108, seed=7)).json()
    assert (more["changed"], more["sequence"]) == (1, 3)


def test_edits_survive_a_restart(start: Any, edit: Edit, manifest: Manifest) -> None:
    query = {"model_id": manifest.model_id, "codes": random_codes(5, 8).tolist()}
    with start() as service:
        service.put("/maps/yard", content=encode(map_of(random_codes(10), manifest.model_id)))
        for step in range(5):
            service.post("/maps/yard/segments", content=edit(3, 108 + step, seed=step))
        before = [service.get("/maps").json(), service.get("/maps/yard").content]
        found = service.post("/match", json=query).json()
    with start() as service:
        assert [service.get("/maps").json(), service.get("/maps/yard").content] == before
        assert service.post("/match", json=query).json() == found


def test_edit_of_another_robots_segment_is_refused(service: Any, yard: str, edit: Edit) -> None:
    before = service.get(yard)
    for data, ids in (
        (edit(4, 108, "zoe", seed=3), [108, 109]),
        (edit(1, 300, "zoe", removed=[101, 105]), [101, 105]),
    ):
        refused = service.post(f"{yard}/segments", content=data)
        assert_problem(
            refused, 409, "id-taken", f"{len(ids)} ids belong to segments of other robots: ann"
        )
        assert refused.json()["ids"] == ids
        # Naming the other robot does not help: an id keeps its robot.
    refused = service.post(f"{yard}/segments?robot=ann", content=edit(4, 108, "zoe", seed=3))
    assert_problem(refused, 409, "id-taken")
    assert service.get(yard).content == before.content
    # With the current ETag it is allowed.
    seen = {"If-Match": before.headers["etag"]}
    done = service.post(f"{yard}/segments", content=edit(4, 108, "zoe", seed=3), headers=seen)
    assert done.json()["changed"] == 4
    stale = service.post(f"{yard}/segments", content=edit(4, 100, "zoe"), headers=seen)
    assert_problem(stale, 412, "precondition-failed")


def test_removal_needs_the_robot_of_the_segments(service: Any, yard: str, edit: Edit) -> None:
    nothing_else = edit(0, removed=[101])
    refused = service.post(f"{yard}/segments", content=nothing_else)
    assert_problem(refused, 409, "id-taken")
    wrong = service.post(f"{yard}/segments?robot=zoe", content=nothing_else)
    assert_problem(wrong, 409, "id-taken")
    done = service.post(f"{yard}/segments?robot=ann", content=nothing_else)
    assert done.json()["removed"] == 1
    # Ids without a segment are ignored.
    gone = service.post(f"{yard}/segments?robot=zoe", content=edit(0, removed=[101, 999]))
    assert (gone.status_code, gone.json()["sequence"]) == (200, 2)


def test_edit_creates_a_map_only_with_create(service: Any, edit: Edit) -> None:
    assert_problem(service.post("/maps/new/segments", content=edit(3)), 404, "unknown-map")
    seen = {"If-Match": "*"}
    refused = service.post("/maps/new/segments?create=true", content=edit(3), headers=seen)
    assert_problem(refused, 412, "precondition-failed")
    made_ = service.post("/maps/new/segments?create=true", content=edit(3))
    assert (made_.status_code, made_.json()["sequence"]) == (201, 1)
    again = service.post("/maps/new/segments?create=true", content=edit(3))
    assert (again.status_code, again.json()["sequence"]) == (200, 1)


def test_invalid_edit_is_refused_and_changes_nothing(
    service: Any, yard: str, edit: Edit, manifest: Manifest, other_manifest: Manifest
) -> None:
    before = service.get(yard).content
    good = edit(4, 108, removed=[100])
    changed = map_of(random_codes(2), manifest.model_id, 500)
    none = np.zeros(0, np.uint32)
    for data, status, kind in (
        (b"", 422, "invalid-delta-file"),
        (b"{}", 422, "invalid-delta-file"),
        (good[:-1], 422, "invalid-delta-file"),
        (good[:50] + b"\xff" + good[51:], 422, "invalid-delta-file"),
        (encode(changed), 422, "invalid-delta-file"),
        (encode_delta(Delta(changed, none, 1, 2)), 422, "invalid-delta-file"),
        (encode_delta(Delta(changed, none, 0, 2)), 422, "invalid-delta-file"),
        (encode_delta(Delta(replace(changed, frame="other"), none)), 409, "other-frame"),
        (encode_delta(Delta(replace(changed, preprocessing="9"), none)), 422, "invalid-delta-file"),
        (edit_of(random_codes(2), other_manifest.model_id), 409, "other-model"),
        (edit_of(random_codes(2, 0, 6), manifest.model_id), 422, "invalid-delta-file"),
    ):
        assert_problem(service.post(f"{yard}/segments", content=data), status, kind)
    assert service.get(yard).content == before
    wrong_type = {"Content-Type": "application/json"}
    refused = service.post(f"{yard}/segments", content=good, headers=wrong_type)
    assert_problem(refused, 415, "unsupported-media-type", "placecell.delta")
    for query in ("create=perhaps", "robot=" + "x" * 201):
        assert_problem(
            service.post(f"{yard}/segments?{query}", content=good), 422, "invalid-request"
        )


def test_edit_with_segments_of_another_model_is_refused(
    start: Any, edit: Edit, manifest: Manifest, other_manifest: Manifest
) -> None:
    with start(also=["other"]) as service:
        service.put("/maps/yard", content=encode(map_of(random_codes(3), manifest.model_id)))
        other = edit_of(random_codes(2), other_manifest.model_id, 500)
        refused = service.post("/maps/yard/segments", content=other)
        assert_problem(refused, 409, "other-model", manifest.model_id)


def test_too_large_edit_is_refused(start: Any, edit: Edit) -> None:
    with start(limits={"body_bytes": 1000}) as service:
        refused = service.post("/maps/yard/segments?create=true", content=edit(300))
        assert_problem(refused, 413, "body-too-large", "1000")


@pytest.mark.slow
def test_reserved_ids_are_given_out_once(start: Any, edit: Edit) -> None:
    with start() as service:
        service.post("/maps/yard/segments?create=true", content=edit(10))
        assert service.post("/maps/yard/ids?count=5").json() == {"first": 110, "count": 5}
        assert service.post("/maps/yard/ids?count=1").json() == {"first": 115, "count": 1}
        service.post("/maps/yard/segments", content=edit(1, 200))
        service.post("/maps/yard/segments?robot=ann", content=edit(0, removed=[200]))
    with start() as service:
        # A used id is never given out again.
        assert service.post("/maps/yard/ids?count=1").json() == {"first": 201, "count": 1}
        for count in ("0", "-1", "1000001", "x", ""):
            refused = service.post(f"/maps/yard/ids?count={count}")
            assert_problem(refused, 422, "invalid-request")
        assert_problem(service.post("/maps/other/ids?count=1"), 404, "unknown-map")
        last = (1 << 32) - 1
        assert service.post("/maps/yard/segments", content=edit(1, last)).status_code == 200
        # A far id does not use up the ids in between.
        assert service.post("/maps/yard/ids?count=3").json() == {"first": 202, "count": 3}


@pytest.mark.slow
def test_concurrent_edits_lose_nothing(service: Any, edit: Edit) -> None:
    robots = [f"robot-{number}" for number in range(6)]

    def drive(robot: str) -> None:
        for step in range(8):
            first = service.post("/maps/site/ids?count=3").json()["first"]
            data = edit(3, first, robot, seed=step)
            assert service.post("/maps/site/segments", content=data).status_code == 200

    service.post("/maps/site/segments?create=true", content=edit(1, 0))
    with ThreadPoolExecutor(len(robots)) as pool:
        list(pool.map(drive, robots))
    (summary,) = service.get("/maps").json()["maps"]
    assert summary["robots"] == {"ann": 1} | dict.fromkeys(robots, 24)
    assert summary["sequence"] == 1 + 6 * 8
    assert ids_of(service, "/maps/site") == list(range(1 + 6 * 8 * 3))


def test_concurrent_creation_keeps_both_edits(service: Any, edit: Edit) -> None:
    with ThreadPoolExecutor(2) as pool:
        both = pool.map(
            lambda first: service.post(
                "/maps/new/segments?create=true", content=edit(2, first, f"r{first}")
            ),
            (0, 10),
        )
    assert sorted(response.status_code for response in both) == [200, 201]
    assert ids_of(service, "/maps/new") == [0, 1, 10, 11]


def test_robot_key_edits_only_its_own_segments(
    start: Any, edit: Edit, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = tmp_path / "keys.toml"
    ann = made(file, "ann", "--write", "--robot", "ann")
    anyone, reader = made(file, "all", "--write"), made(file, "reader")
    path = "/maps/yard/segments"
    with start(keys_file=file) as service:
        service.post(f"{path}?create=true", content=edit(3, 0, "zoe"), headers=anyone)
        assert service.post(path, content=edit(3, 10), headers=ann).status_code == 200
        before = service.get("/maps/yard", headers=ann)
        seen = {"If-Match": before.headers["etag"]}
        for data in (edit(1, 20, "zoe"), edit(1, 1), edit(0, removed=[1])):
            for headers in (ann | seen, ann | {"If-Match": "*"}):
                assert_problem(service.post(path, content=data, headers=headers), 403, "forbidden")
        refused = service.post(f"{path}?robot=zoe", content=edit(0, removed=[1]), headers=ann)
        assert_problem(refused, 403, "forbidden", "only segments of the robot 'ann'")
        assert service.get("/maps/yard", headers=ann).content == before.content
        for way in ("segments", "ids?count=1", "age?unseen_since=0", "versions/1/restore"):
            refused = service.post(f"/maps/yard/{way}", content=edit(1, 20), headers=reader)
            assert_problem(refused, 403, "forbidden", "may read maps")
        refused = service.post("/maps/yard/compact", headers=ann)
        assert_problem(refused, 403, "forbidden", "only segments of the robot 'ann'")
        # A restore would remove segments of other robots.
        caplog.clear()
        with caplog.at_level(logging.INFO, "placecell.audit"):
            service.post(path, content=edit(1, 50, "zoe"), headers=anyone)
            refused = service.post("/maps/yard/versions/2/restore", headers=ann)
            assert_problem(refused, 403, "forbidden")
            removal = edit(0, removed=[10])
            assert service.post(path, content=removal, headers=ann).json()["removed"] == 1
            service.post("/maps/yard/ids?count=7", headers=ann)
    lines = [one.getMessage() for one in caplog.records if one.name == "placecell.audit"]
    assert lines == [
        "all edit map yard, 1 segments changed, 0 removed",
        "ann edit map yard, 0 segments changed, 1 removed",
        "ann ids map yard, 7 ids from 51 on",
    ]


def test_key_of_other_maps_neither_edits_nor_reads(start: Any, edit: Edit, tmp_path: Path) -> None:
    file = tmp_path / "keys.toml"
    anyone, halls = made(file, "all", "--write"), made(file, "halls", "--write", "--map", "hall-*")
    with start(keys_file=file) as service:
        service.post("/maps/yard/segments?create=true", content=edit(3), headers=anyone)
        for method, way in (
            ("POST", "segments"),
            ("POST", "ids?count=1"),
            ("POST", "age?unseen_since=0"),
            ("GET", "changes"),
            ("GET", "versions"),
            ("POST", "versions/1/restore"),
            ("POST", "compact"),
        ):
            for name in ("yard", "unknown"):
                answer = service.request(method, f"/maps/{name}/{way}", headers=halls)
                assert_problem(answer, 403, "forbidden")


def test_prune_removes_segments_not_seen_again(service: Any, manifest: Manifest) -> None:
    content = replace(
        map_of(random_codes(4), manifest.model_id, 0),
        seen=np.array([10, 20, 30, 40], np.uint32),
    )
    service.put("/maps/yard", content=encode(content))
    dry = service.post("/maps/yard/age?unseen_since=30&dry_run=true").json()
    assert (dry["removed"], dry["sequence"], dry["segments"]) == (2, 1, 4)
    done = service.post("/maps/yard/age?unseen_since=30").json()
    assert (done["removed"], done["sequence"], done["segments"]) == (2, 2, 2)
    assert ids_of(service, "/maps/yard") == [2, 3]
    assert service.post("/maps/yard/age?unseen_since=30").json()["sequence"] == 2
    service.post("/maps/yard/versions/1/restore")
    assert service.get("/maps/yard").content == encode(content)
    for wrong in ("", "?unseen_since=x", "?unseen_since=nan", "?unseen_since=inf"):
        assert_problem(service.post(f"/maps/yard/age{wrong}"), 422, "invalid-request")


def test_prune_without_seen_column_uses_frame_times(service: Any, manifest: Manifest) -> None:
    service.put("/maps/yard", content=encode(map_of(random_codes(4), manifest.model_id)))
    assert service.post("/maps/yard/age?unseen_since=1700000000").json()["removed"] == 0
    assert service.post("/maps/yard/age?unseen_since=1700000000.5").json()["removed"] == 4
