"""Several services with one database: each follows the writes of the others."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import psycopg
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.maps.following import advance
from service.maps.following import follower as following
from service.maps.postgres import database
from service.maps.postgres.store import PostgresStore
from service.maps.postgres.tables import SCHEMA
from service.maps.store import SharedMap
from tests.service.postgres_server import PostgresServer
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

Start = Callable[..., Any]

CODES = random_codes(40)


@pytest.fixture
def replica(start: Start, tmp_path: Path, postgres_database: str) -> Iterator[Start]:
    """Starts services on one database."""
    with ExitStack() as running:

        def started(name: str = "a", **settings: object) -> Any:
            values = {"database": postgres_database, "data_dir": tmp_path / name} | settings
            return running.enter_context(start(**values))

        yield started


@pytest.fixture
def pair(replica: Start) -> tuple[Any, Any]:
    return replica("a"), replica("b")


def put(
    service: Any,
    manifest: Manifest,
    name: str = "yard",
    rows: int = 10,
    headers: dict[str, str] | None = None,
) -> Any:
    file = encode(map_of(CODES[:rows], manifest.model_id))
    return service.put(f"/maps/{name}", content=file, headers=headers)


def edit(
    service: Any, manifest: Manifest, first: int, headers: dict[str, str] | None = None
) -> Any:
    content = edit_of(CODES[first : first + 5], manifest.model_id, 100 + first)
    return service.post("/maps/yard/segments", content=content, headers=headers)


def tag(response: Any) -> str:
    assert response.is_success, response.text
    return str(response.headers["ETag"]).strip('"')


def eventually(check: Callable[[], bool], seconds: float = 10.0) -> None:
    until = time.monotonic() + seconds
    while not check():
        assert time.monotonic() < until, "it did not happen in time"
        time.sleep(0.01)


def etag_at(service: Any, name: str = "yard") -> str | None:
    found = service.get(f"/maps/{name}", headers={"Accept": "application/json"})
    return None if found.status_code == 404 else str(found.json()["etag"])


def matched(service: Any, row: int, headers: dict[str, str] | None = None) -> list[int]:
    """Return the ids of the nearest segments of a row of the codes."""
    body = {
        "model_id": service.app.state.placecell.model_id,
        "codes": CODES[row : row + 1].tolist(),
        "k": 1,
        "maps": ["yard"],
    }
    response = service.post("/match", json=body, headers=headers)
    assert response.status_code == 200, response.text
    return [each["id"] for each in response.json()["queries"][0]["candidates"]]


def test_write_at_one_service_is_matched_at_the_other(
    pair: tuple[Any, Any], manifest: Manifest
) -> None:
    one, other = pair
    version = tag(put(one, manifest))
    eventually(lambda: etag_at(other) == version)
    assert matched(other, 3) == [103]
    version = tag(edit(other, manifest, 10))
    eventually(lambda: etag_at(one) == version)
    assert matched(one, 12) == [112]
    files = [service.get("/maps/yard").content for service in pair]
    assert files[0] == files[1]


def test_client_sees_its_own_writes_at_every_service(
    pair: tuple[Any, Any], manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = pair
    seen = tag(put(one, manifest))
    for number in range(10, 40, 5):
        assert matched(other, number - 1, {"Placecell-Seen": f"yard {seen}"}) == [99 + number]
        one, other = other, one
        written = edit(one, manifest, number, {"Placecell-Seen": f'yard "{seen}"'})
        seen = tag(written)
    assert one.delete("/maps/yard").status_code == 204
    gone = other.get("/maps/yard", headers={"Placecell-Seen": "yard -"})
    assert_problem(gone, 404, "unknown-map")


def test_wrong_token_is_refused(pair: tuple[Any, Any]) -> None:
    for wrong in ("yard", "yard 12", "../x 0123456789abcdef-1", "a -, b"):
        response = pair[0].get("/maps", headers={"Placecell-Seen": wrong})
        assert_problem(response, 422, "invalid-request", "Placecell-Seen")


def test_all_lines_of_the_token_count(pair: tuple[Any, Any]) -> None:
    for lines in (("yard -", "yard 12"), ("yard 12", "yard -")):
        response = pair[0].get("/maps", headers=[("Placecell-Seen", each) for each in lines])
        assert_problem(response, 422, "invalid-request", "Placecell-Seen")


def test_map_that_was_deleted_and_created_again_is_loaded_whole(
    pair: tuple[Any, Any], manifest: Manifest
) -> None:
    one, other = pair
    version = tag(put(one, manifest, rows=20))
    eventually(lambda: etag_at(other) == version)
    assert one.put("/maps/yard/tags", json={"tags": ["old"]}).is_success
    assert one.delete("/maps/yard").status_code == 204
    again = tag(put(one, manifest, rows=5))
    assert again != version
    eventually(lambda: etag_at(other) == again)
    assert other.get("/maps").json()["maps"][0]["segments"] == 5
    assert other.get("/maps").json()["maps"][0]["tags"] == []


def test_service_follows_a_map_beyond_a_compaction(
    pair: tuple[Any, Any], manifest: Manifest
) -> None:
    one, other = pair
    put(one, manifest)
    version = tag(edit(one, manifest, 10))
    eventually(lambda: etag_at(other) == version)
    assert other.post("/maps/yard/compact").json()["oldest"] == 2
    eventually(lambda: one.get("/maps/yard/versions").json()["oldest"] == 2)
    version = tag(edit(one, manifest, 15))
    eventually(lambda: etag_at(other) == version)


def test_service_that_missed_compacted_versions_loads_the_whole_map(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)  # follows on request only
    one, other = replica("a"), replica("b")
    seen = tag(put(one, manifest))
    assert matched(other, 3, {"Placecell-Seen": f"yard {seen}"}) == [103]
    edit(one, manifest, 10)
    seen = tag(edit(one, manifest, 15))
    one.post("/maps/yard/compact")
    assert matched(other, 17, {"Placecell-Seen": f"yard {seen}"}) == [117]
    assert matched(other, 3) == [103]


def test_lost_notification_is_made_up_for_by_polling(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.maps.postgres.store.CHANNEL", "elsewhere")
    one, other = replica("a"), replica("b")
    monkeypatch.setattr("service.maps.postgres.store.CHANNEL", "nowhere")
    version = tag(put(one, manifest))
    eventually(lambda: etag_at(other) == version)
    one.delete("/maps/yard")
    eventually(lambda: etag_at(other) is None)


def test_lost_connection_of_the_follower_is_made_up_for(
    pair: tuple[Any, Any], manifest: Manifest, postgres_database: str
) -> None:
    one, other = pair
    version = tag(put(one, manifest))
    eventually(lambda: etag_at(other) == version)
    with psycopg.connect(postgres_database, autocommit=True) as connection:
        connection.execute(
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
            "WHERE application_name = 'placecell'"
        )
    version = tag(edit(one, manifest, 10))
    eventually(lambda: etag_at(other) == version)


def test_tags_and_anchors_are_followed(pair: tuple[Any, Any], manifest: Manifest) -> None:
    one, other = pair
    put(one, manifest)
    one.put("/maps/yard/tags", json={"tags": ["wet"]})
    anchor = {"position": [1.0, 2.0, 0.0], "orientation": [0.0, 0.0, 0.0, 1.0]}
    assert one.put("/maps/yard/anchors/dock", json=anchor).is_success, anchor

    def tags() -> Any:
        return [each["tags"] for each in other.get("/maps").json()["maps"]]

    eventually(lambda: tags() == [["wet"]])
    eventually(lambda: len(other.get("/maps/yard/anchors").json()["anchors"]) == 1)
    other.put("/maps/yard/tags", json={"tags": ["dry"]})
    eventually(lambda: one.get("/maps").json()["maps"][0]["tags"] == ["dry"])


@pytest.mark.parametrize("times", [1, 9])
def test_writes_that_overtake_each_other_are_repeated(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch, times: int
) -> None:
    """The service did not hear of the other's write: its own does not follow the newest version."""
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other = replica("a"), replica("b")
    first = tag(put(one, manifest))
    with monkeypatch.context() as late:
        other.get("/maps", headers={"Placecell-Seen": f"yard {first}"})
        edit(one, manifest, 10)
        overtaken = iter(["overtaken"] * times)
        catch_up = following.Follower.catch_up
        late.setattr(
            following.Follower,
            "catch_up",
            lambda self, *given: next(overtaken, None) or catch_up(self, *given),
        )
        written = edit(other, manifest, 20)
    assert tag(written).endswith("-3")
    refused = edit(other, manifest, 30, {"If-Match": f'"{first}"'})
    assert_problem(refused, 412, "precondition-failed")
    assert_problem(put(one, manifest, headers={"If-None-Match": "*"}), 412, "precondition-failed")


def test_write_looks_once_for_what_others_wrote_before_it(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The mark of a mirror and the version are those of one look: each costs a round trip."""
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other = replica("a"), replica("b")
    put(one, manifest)
    find, looks = PostgresStore.find, list[str]()

    def looked(store: PostgresStore, name: str) -> SharedMap | None:
        looks.append(name)
        return find(store, name)

    monkeypatch.setattr(PostgresStore, "find", looked)
    for first, service in enumerate([other, one, other, other, one], 2):
        looks.clear()
        assert tag(edit(service, manifest, 5 * first)).endswith(f"-{first}")
        assert looks == ["yard"]


def test_look_that_an_own_write_overtook_reads_no_whole_map(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A long history takes seconds to read, and all writes of the map would wait."""
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    service = replica("a")
    put(service, manifest)
    find, found = PostgresStore.find, list[SharedMap | None]()

    def late(store: PostgresStore, name: str) -> SharedMap | None:
        found.append(find(store, name))
        return found[max(len(found) - 2, 0)]

    monkeypatch.setattr(PostgresStore, "find", late)
    monkeypatch.setattr(advance, "replay", None)
    for number in range(2, 6):
        assert tag(edit(service, manifest, 5 * number)).endswith(f"-{number}")


def test_map_created_at_two_services_has_one_content(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other = replica("a"), replica("b")
    assert put(one, manifest, rows=5).status_code == 201
    assert_problem(put(other, manifest, rows=6), 428, "precondition-required")
    assert put(other, manifest, rows=5).status_code == 200
    assert one.delete("/maps/yard").status_code == 204
    assert_problem(edit(other, manifest, 10), 404, "unknown-map")


def test_map_of_another_service_becomes_a_mirror(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other = replica("a"), replica("b")
    put(one, manifest, rows=0)
    source = {"source": "https://hq.example/maps/yard"}
    assert other.put("/maps/yard/mirror", json=source).is_success
    seen = {"Placecell-Seen": f"yard {tag(one.get('/maps/yard'))}"}
    # The mark of the other service is loaded before the write is checked.
    assert one.delete("/maps/yard/mirror", headers=seen).status_code == 204
    assert_problem(other.delete("/maps/yard/mirror"), 404, "not-a-mirror")


def test_mark_that_another_service_has_just_set_refuses_writes(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other = replica("a"), replica("b")
    put(one, manifest, rows=0)
    assert etag_at(other) is None
    source = {"source": "https://hq.example/maps/yard"}
    assert one.put("/maps/yard/mirror", json=source).is_success
    # No token, and no notification: each write looks at the database itself.
    elsewhere = other.put("/maps/yard/mirror", json={"source": "https://else.example/maps/yard"})
    assert_problem(elsewhere, 409, "mirrored-map", "mirror of https://hq.example")
    assert_problem(edit(other, manifest, 10), 409, "mirrored-map")
    own = {"Placecell-Mirror": source["source"]}
    assert edit(other, manifest, 10, headers=own).is_success
    marked = {**source, "etag": "0123456789abcdef-7"}
    assert one.put("/maps/yard/mirror", json=marked, headers=own).is_success
    assert one.delete("/maps/yard/mirror").status_code == 204
    # The map has segments by now, which the other service has never been told of.
    again = replica("c").put("/maps/yard/mirror", json=source)
    assert_problem(again, 409, "not-a-mirror", "5 segments")


def test_latest_reads_need_no_token(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following.Follower, "_work", lambda self: None)
    one, other, latest = replica("a"), replica("b"), replica("c", reads="latest")
    put(one, manifest)
    assert etag_at(other) is None
    assert matched(latest, 3) == [103]


def test_service_loads_the_maps_of_its_patterns_only(replica: Start, manifest: Manifest) -> None:
    one, other = replica("a"), replica("b", maps=["site-*", "yard"])
    put(one, manifest, "hall")
    version = tag(put(one, manifest))
    eventually(lambda: etag_at(other) == version)
    assert [each["name"] for each in other.get("/maps").json()["maps"]] == ["yard"]
    refused = other.get("/maps/hall", headers={"Placecell-Seen": f"hall {version}"})
    assert_problem(refused, 404, "unknown-map", "loads only maps named site-*, yard")
    assert_problem(put(other, manifest, "barn"), 404, "unknown-map", "PLACECELL_MAPS")
    third = replica("d", maps=["hall"])
    assert [each["name"] for each in third.get("/maps").json()["maps"]] == ["hall"]


def test_cold_map_is_followed_and_stays_cold(replica: Start, manifest: Manifest) -> None:
    one, other = replica("a"), replica("b", loaded_segments=15)
    put(one, manifest, "hall")
    put(one, manifest)
    entries = other.app.state.placecell.engine.maps.entries
    eventually(lambda: len(entries()) == 2)
    assert other.get("/maps/hall").is_success
    version = tag(edit(one, manifest, 10))
    one.post("/maps/yard/ids", params={"count": 7})
    eventually(lambda: [each["etag"] for each in other.get("/maps").json()["maps"]][1] == version)
    assert [type(each).__name__ for each in entries()] == ["MapSnapshot", "ColdMap"]
    assert matched(other, 12, {"Placecell-Seen": f"yard {version}"}) == [112]
    assert other.get("/maps/hall").is_success
    assert one.delete("/maps/yard").status_code == 204
    eventually(lambda: etag_at(other) is None)


def test_maps_are_served_while_the_database_is_away(
    replica: Start,
    manifest: Manifest,
    postgres_server: PostgresServer,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(database, "POOL_SECONDS", 0.3)
    monkeypatch.setattr(database, "RETRY_SECONDS", 0.3)
    one = replica("a")
    seen = tag(put(one, manifest))
    postgres_server.kill()
    try:
        eventually(lambda: "warnings" in one.get("/readyz").json())
        assert "cannot be written" in one.get("/readyz").json()["warnings"][0]
        assert matched(one, 3) == [103]
        assert matched(one, 3, {"Placecell-Seen": f"yard {seen}"}) == [103]
        later = {"Placecell-Seen": f"yard {seen[:-1]}9"}
        refused = one.get("/maps/yard", headers=later)
        assert_problem(refused, 503, "replica-behind", "does not have version")
        assert refused.headers["Retry-After"] == "1"
        refused = edit(one, manifest, 10)
        assert_problem(refused, 503, "store-unavailable", "database cannot be reached")
        assert refused.headers["Retry-After"] == "1"
    finally:
        postgres_server.start()
    eventually(lambda: "warnings" not in one.get("/readyz").json())
    eventually(lambda: edit(one, manifest, 10).is_success)


def test_service_that_stays_behind_is_not_ready(
    replica: Start, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = replica("a"), replica("b")
    assert other.get("/readyz").json() == {"status": "ready"}
    monkeypatch.setattr(following, "LATE_SECONDS", 0.0)
    monkeypatch.setattr(following, "WAIT_SECONDS", 0.01)
    follower = other.app.state.placecell.engine.follower
    with follower._alone("yard"):  # as if another thread loaded it for long
        put(one, manifest)
        eventually(lambda: other.get("/readyz").status_code == 503)
        assert_problem(other.get("/readyz"), 503, "not-ready", "behind the database")
        assert one.get("/readyz").is_success
    eventually(lambda: other.get("/readyz").is_success)
    assert "placecell_store_lag_seconds" in other.get("/metrics").text


def test_damaged_map_is_not_served_until_it_is_replaced(
    pair: tuple[Any, Any], manifest: Manifest, postgres_database: str
) -> None:
    one, other = pair
    version = tag(put(one, manifest))
    eventually(lambda: etag_at(other) == version)
    with psycopg.connect(postgres_database, autocommit=True) as connection:
        connection.execute(f"UPDATE {SCHEMA}.bases SET sha256 = ''")
        connection.execute(f"UPDATE {SCHEMA}.maps SET uid = 'another', annotated = 1")
        connection.execute(f"NOTIFY {SCHEMA}, 'yard'")
    eventually(lambda: other.get("/maps").json()["damaged"] == ["yard"])
    assert_problem(other.get("/maps/yard"), 500, "map-damaged")
    assert one.delete("/maps/yard").status_code == 204
    eventually(lambda: other.get("/maps").json()["damaged"] == [])
    version = tag(put(other, manifest))
    eventually(lambda: etag_at(one) == version)


def test_one_service_at_a_time_does_maintenance(postgres_database: str) -> None:
    with (
        PostgresStore.opened(postgres_database) as one,
        PostgresStore.opened(postgres_database) as other,
    ):
        with one.alone() as first, other.alone() as second:
            assert (first, second) == (True, False)
        with other.alone() as second:
            assert second


def test_ids_that_are_reserved_at_two_services_differ(
    pair: tuple[Any, Any], manifest: Manifest
) -> None:
    put(pair[0], manifest)
    found = [
        service.post("/maps/yard/ids", params={"count": 10}).json()["first"]
        for service in (*pair, *pair)
    ]
    assert len(set(found)) == 4
    assert np.diff(sorted(found)).min() >= 10
