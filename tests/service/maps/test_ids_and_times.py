"""Ids that keys may write and reserve, and times that segments may have."""

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, encode, encode_delta
from placecell_client.maps.edit import with_optional

from placecell.descriptors.manifest import Manifest
from service.maps.store import IDS, Ids
from service.maps.writes.id_rules import SLACK
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

ANY = {"If-Match": "*"}
LAST = IDS - 1


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "keys.toml"


def edited(service: Any, data: bytes, key: Any = None, query: str = "", **headers: str) -> Any:
    return service.post(
        f"/maps/yard/segments?create=true{query}", content=data, headers=(key or {}) | headers
    )


def reserved(service: Any, count: int, key: Any = None) -> Any:
    return service.post(f"/maps/yard/ids?count={count}", headers=key or {})


@pytest.mark.parametrize(
    ("taken", "free"),
    [
        ([], (0, IDS)),
        ([(0, 5)], (5, IDS)),
        ([(LAST, IDS)], (0, LAST)),
        ([(0, 5), (LAST, IDS)], (5, LAST)),
        ([(7, 9), (1000, 1001)], (1001, IDS)),
        ([(0, IDS)], (0, 0)),
    ],
)
def test_A8_largest_run_of_free_ids_remains(
    taken: list[tuple[int, int]], free: tuple[int, int]
) -> None:
    assert Ids(tuple(taken)).leave(0, IDS) == free


def test_A8_far_id_does_not_use_up_others(service: Any, manifest: Manifest) -> None:
    """Hold without keys, for whole maps, after a removal, and after a restart of the counter."""
    ends = map_of(random_codes(2), manifest.model_id)
    ends = replace(ends, ids=np.array([7, LAST], np.uint32))
    assert service.put("/maps/yard", content=encode(ends)).status_code == 201
    assert reserved(service, 1_000_000).json() == {"first": 8, "count": 1_000_000}
    for last in (LAST - 1, 3 << 30):
        assert edited(service, edit_of(random_codes(1), manifest.model_id, last)).is_success
    assert reserved(service, 1).json()["first"] == 1_000_008
    removal = edit_of(random_codes(0), manifest.model_id, removed=[LAST])
    assert edited(service, removal, query="&robot=ann").json()["removed"] == 1
    assert service.post("/maps/yard/versions/1/restore").status_code == 200
    assert reserved(service, 1).json()["first"] == 1_000_009


@pytest.mark.slow
def test_A8_reserve_uses_gaps_between_ids(service: Any, manifest: Manifest) -> None:
    """If the current run of free ids is too short, another is used; no id is given twice."""
    assert edited(service, edit_of(random_codes(1), manifest.model_id, 0)).is_success
    given = {0}
    for last in (10, 3_000_000_000, 3_000_000_020):
        edited(service, edit_of(random_codes(1), manifest.model_id, last))
        given.add(last)
    for _ in range(3):
        answer = reserved(service, 500_000).json()
        ids = range(answer["first"], answer["first"] + 500_000)
        assert not given & {*ids}
        given |= {*ids}


def test_A8_far_unreserved_id_is_refused(start: Any, file: Path, manifest: Manifest) -> None:
    ann, admin = (
        made(file, "ann", "--write", "--robot", "ann"),
        made(file, "ops", "--write", "--admin"),
    )
    far = edit_of(random_codes(1), manifest.model_id, LAST)
    with start(keys_file=file) as service:
        assert_problem(edited(service, far, ann), 409, "id-not-reserved", "Reserve ids")
        whole = encode(map_of(random_codes(1), manifest.model_id, LAST))
        refused = service.put("/maps/yard", content=whole, headers=ann)
        assert_problem(refused, 409, "id-not-reserved")
        # A robot that numbers from 0, with gaps, continues as before.
        for first in (0, 1_000, SLACK):
            data = edit_of(random_codes(5), manifest.model_id, first)
            assert edited(service, data, ann).is_success, first
        assert_problem(edited(service, far, ann, **ANY), 409, "id-not-reserved")
        first = reserved(service, 1_000_000, ann).json()["first"]
        assert first == SLACK + 5
        data = edit_of(random_codes(1), manifest.model_id, first + 999_999)
        assert edited(service, data, ann).is_success
        assert edited(service, far, admin).is_success
        assert reserved(service, 1, ann).json()["first"] == first + 1_000_000


def test_A8_number_of_reserved_ids_is_limited(
    start: Any, file: Path, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    ann, zoe = (made(file, name, "--write", "--robot", name) for name in ("ann", "zoe"))
    now = [1.8e9]
    monkeypatch.setattr("service.maps.sqlite.store.time.time", lambda: now[0])
    with start(keys_file=file, limits={"reserved_ids": 100}) as service:
        assert edited(service, edit_of(random_codes(1), manifest.model_id, 0), ann).is_success
        assert reserved(service, 60, ann).json()["first"] == 1
        assert_problem(reserved(service, 41, ann), 409, "too-many-ids", "60 reserved ids")
        assert reserved(service, 40, ann).json()["first"] == 61
        assert_problem(reserved(service, 1, ann), 409, "too-many-ids", "Write segments")
        # Another key has its own limit, and written ids do not count.
        assert reserved(service, 100, zoe).json()["first"] == 101
        assert edited(service, edit_of(random_codes(10), manifest.model_id, 50), ann).is_success
        assert reserved(service, 10, ann).status_code == 200
        assert_problem(reserved(service, 1, ann), 409, "too-many-ids")


def test_A8_old_reservations_do_not_count(start: Any, manifest: Manifest) -> None:
    with start(limits={"reserved_ids": 100}) as service:
        store = service.app.state.placecell.engine.maps.store
        assert edited(service, edit_of(random_codes(1), manifest.model_id, 0)).is_success
        assert reserved(service, 100).is_success
        assert_problem(reserved(service, 1), 409, "too-many-ids")
        store._clock = lambda: time.time() + 8 * 24 * 3600
        assert reserved(service, 100).json()["first"] == 101


def test_A8_admin_frees_ids_of_no_version(start: Any, file: Path, manifest: Manifest) -> None:
    ann, ops = (
        made(file, "ann", "--write", "--robot", "ann"),
        made(file, "ops", "--write", "--admin"),
    )
    with start(keys_file=file) as service:
        assert edited(service, edit_of(random_codes(5), manifest.model_id, 0), ops).is_success
        assert edited(service, edit_of(random_codes(1), manifest.model_id, 900), ops).is_success
        removal = edit_of(random_codes(0), manifest.model_id, removed=[900])
        assert edited(service, removal, ops, "&robot=ann").is_success
        assert reserved(service, 50, ops).json()["first"] == 901
        reset = "/maps/yard/ids/reset"
        assert_problem(service.post(reset, headers=ann), 403, "forbidden")
        assert service.post(reset, headers=ops).json() == {"first": 901, "count": IDS - 901}
        assert service.post("/maps/yard/compact", headers=ops).status_code == 200
        assert service.post(reset, headers=ops).json() == {"first": 5, "count": IDS - 5}
        assert reserved(service, 1, ops).json()["first"] == 5
        assert_problem(service.post("/maps/other/ids/reset", headers=ops), 404, "unknown-map")
    with start(keys_file=file) as service:
        assert reserved(service, 1, ops).json()["first"] == 6


def test_B17_robot_of_same_name_with_other_key_overwrites_nothing(
    start: Any, file: Path, manifest: Manifest
) -> None:
    one, two = (made(file, name, "--write", "--robot", "robot") for name in ("one", "two"))
    first = edit_of(random_codes(5), manifest.model_id, 0, "robot")
    second = edit_of(random_codes(5, 1), manifest.model_id, 0, "robot")
    removal = edit_of(random_codes(0), manifest.model_id, robot="robot", removed=[1, 2])
    with start(keys_file=file) as service:
        assert edited(service, first, one).status_code == 201
        before = service.get("/maps/yard", headers=one).content
        refused = edited(service, second, two)
        assert_problem(refused, 409, "id-taken", "If-Match")
        assert refused.json()["ids"] == [0, 1, 2, 3, 4]
        assert_problem(edited(service, removal, two), 409, "id-taken")
        assert service.get("/maps/yard", headers=one).content == before
        # The repeated edit changes nothing, whichever key sends it.
        assert edited(service, first, two).json()["changed"] == 0
        # New ids belong to the key that writes them; ids that another key reserved are refused.
        own = edit_of(random_codes(3), manifest.model_id, 20, "robot")
        assert edited(service, own, two).is_success
        changed = edit_of(random_codes(3, 5), manifest.model_id, 20, "robot")
        assert edited(service, changed, two).json()["changed"] == 3
        ids = reserved(service, 10, one).json()["first"]
        taken = edit_of(random_codes(1), manifest.model_id, ids + 3, "robot")
        assert_problem(edited(service, taken, two), 409, "id-taken")
        assert edited(service, taken, one).is_success
        # If-Match confirms the replacement.
        assert edited(service, second, two, **ANY).json()["changed"] == 5
        assert_problem(edited(service, first, one), 409, "id-taken")
    with start(keys_file=file) as service:
        assert_problem(edited(service, first, one), 409, "id-taken")
        assert edited(service, second, two).json()["changed"] == 0


def test_B17_only_new_edit_refuses_to_replace(service: Any, manifest: Manifest) -> None:
    first = edit_of(random_codes(5), manifest.model_id, 0, "robot")
    second = edit_of(random_codes(5, 1), manifest.model_id, 3, "robot")
    assert edited(service, first, query="&only_new=true").status_code == 201
    assert edited(service, first, query="&only_new=true").json()["changed"] == 0
    refused = edited(service, second, query="&only_new=true")
    assert_problem(refused, 409, "id-taken", "only_new")
    assert refused.json()["ids"] == [3, 4]
    assert edited(service, second).json()["changed"] == 5


def test_A24_robot_key_cannot_delete_history_of_others(
    start: Any, file: Path, manifest: Manifest
) -> None:
    ann, ops = made(file, "ann", "--write", "--robot", "ann"), made(file, "ops", "--write")
    with start(keys_file=file) as service:
        zoe = edit_of(random_codes(3), manifest.model_id, 0, "zoe")
        assert edited(service, zoe, ops).is_success
        assert edited(service, edit_of(random_codes(3), manifest.model_id, 10), ann).is_success
        removal = edit_of(random_codes(0), manifest.model_id, removed=[0, 1, 2])
        assert edited(service, removal, ops, "&robot=zoe").is_success
        (summary,) = service.get("/maps", headers=ann).json()["maps"]
        assert summary["robots"] == {"ann": 3}
        assert_problem(
            service.delete("/maps/yard", headers=ann),
            403,
            "forbidden",
            "only segments of the robot 'ann'",
        )
        assert service.post("/maps/yard/versions/1/restore", headers=ops).status_code == 200
        assert edited(service, removal, ops, "&robot=zoe").is_success
        assert service.post("/maps/yard/compact", headers=ops).status_code == 200
        assert service.delete("/maps/yard", headers=ann).status_code == 204


def seen_at(content: CompactMap, frames: float, seen: int | None = None) -> CompactMap:
    content = replace(content, frame_times=np.full(len(content.frame_times), frames))
    if seen is None:
        return content
    filled = with_optional(content, ["seen"])
    return replace(filled, seen=np.full(len(filled), seen, np.uint32))


@pytest.mark.parametrize("seen", [None, LAST])
def test_A16_segment_from_the_future_is_refused(
    service: Any, manifest: Manifest, seen: int | None
) -> None:
    now = time.time()
    content = map_of(random_codes(4), manifest.model_id)
    future = seen_at(content, now + 3_600 if seen is None else now, seen)
    whole, edit = encode(future), encode_delta(Delta(future, np.zeros(0, np.uint32)))
    assert_problem(service.put("/maps/yard", content=whole), 422, "time-in-future", "clock")
    assert_problem(edited(service, edit), 422, "time-in-future", "Correct the robot's clock")
    assert service.put("/maps/yard", content=encode(seen_at(content, now + 30))).is_success
    for query in ("", "&deduplicate=true"):
        assert_problem(edited(service, edit, query=query), 422, "time-in-future")
    refused = service.put("/maps/yard", content=whole, headers=ANY)
    assert_problem(refused, 422, "time-in-future")


def test_A16_past_times_and_unset_clock_are_accepted(
    service: Any, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = map_of(random_codes(4), manifest.model_id)
    for number, moment in enumerate((0.0, -1.5, 1.3e9)):
        path = f"/maps/drive-{number}"
        assert service.put(path, content=encode(seen_at(content, moment))).is_success
    monkeypatch.setattr("service.maps.writes.clock_check.time.time", lambda: 12.0)
    assert service.put("/maps/new", content=encode(content)).is_success


def test_A16_other_robots_segment_is_refreshed_to_capture_time_at_most(
    start: Any, file: Path, manifest: Manifest
) -> None:
    ann, zoe = (made(file, name, "--write", "--robot", name) for name in ("ann", "zoe"))
    now = int(time.time())
    codes = random_codes(4)
    stored = seen_at(map_of(codes, manifest.model_id), now - 9_000.0)
    later = seen_at(map_of(codes, manifest.model_id, 200, "zoe"), now - 5_000.0, now - 60)
    edits = [encode_delta(Delta(each, np.zeros(0, np.uint32))) for each in (stored, later)]
    with start(keys_file=file) as service:
        assert edited(service, edits[0], ann).is_success
        told = edited(service, edits[1], zoe, "&deduplicate=true").json()
        assert told["repeats"] == 4
        content = decode(service.get("/maps/yard", headers=ann).content)
        assert content.seen is not None
        assert content.seen.tolist() == [now - 5_000] * 4
        # A robot key sends only segments of its robot, even if all are repeats.
        other = replace(later, robots=("ann",))
        data = encode_delta(Delta(other, np.zeros(0, np.uint32)))
        assert_problem(edited(service, data, zoe, "&deduplicate=true"), 403, "forbidden")
