"""Maps that leave the memory when others are used, and come back with their first request."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.maps.snapshot import ColdMap
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

CODES = random_codes(60)
NAMES = ("barn", "hall", "yard")


@pytest.fixture
def service(start: Callable[..., Any]) -> Iterator[Any]:
    """A service that keeps 45 segments in memory: two maps of 20."""
    with start(loaded_segments=45) as client:
        yield client


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    for number, name in enumerate(NAMES):
        codes = CODES[20 * number : 20 * number + 20]
        file = encode(map_of(codes, manifest.model_id, 100 * (number + 1), robot=name))
        assert service.put(f"/maps/{name}", content=file).status_code == 201
    return service


def maps(service: Any) -> Any:
    return service.app.state.placecell.engine.maps


def cold(service: Any) -> list[str]:
    return [each.name for each in maps(service).entries() if isinstance(each, ColdMap)]


def match(service: Any, row: int, names: list[str] | None) -> Any:
    body = {
        "model_id": service.app.state.placecell.model_id,
        "codes": CODES[row : row + 1].tolist(),
        "k": 1,
    }
    return service.post("/match", json=body if names is None else body | {"maps": names})


def test_least_recently_used_map_leaves_and_comes_back(stocked: Any) -> None:
    assert cold(stocked) == ["barn"]
    found = match(stocked, 3, ["barn"]).json()["queries"][0]["candidates"]
    assert [(each["map"], each["id"]) for each in found] == [("barn", 103)]
    assert cold(stocked) == ["hall"]
    # A read keeps a map, too.
    assert stocked.get("/maps/yard").is_success
    assert match(stocked, 23, ["hall"]).is_success
    assert cold(stocked) == ["barn"]
    assert "placecell_loaded_maps 2.0" in stocked.get("/metrics").text
    assert "placecell_maps 3.0" in stocked.get("/metrics").text
    assert "placecell_map_segments 60.0" in stocked.get("/metrics").text


def test_list_of_maps_loads_none(stocked: Any, start: Callable[..., Any]) -> None:
    before = stocked.get("/maps").json()
    assert [each["segments"] for each in before["maps"]] == [20, 20, 20]
    assert [each["robots"] for each in before["maps"]] == [{name: 20} for name in NAMES]
    assert cold(stocked) == ["barn"]
    for name in NAMES:
        assert stocked.get(f"/maps/{name}").is_success
    assert stocked.get("/maps").json() == before


def test_restart_keeps_the_limit(
    start: Callable[..., Any], data_dir: Path, manifest: Manifest
) -> None:
    with start() as service:
        for number, name in enumerate(NAMES):
            codes = CODES[20 * number : 20 * number + 20]
            service.put(f"/maps/{name}", content=encode(map_of(codes, manifest.model_id)))
        before = service.get("/maps").json()
    with start(loaded_segments=45) as service:
        assert cold(service) == ["yard"]
        assert service.get("/maps").json() == before
        assert match(service, 43, ["yard"]).is_success
        maps(service).index_all()
        assert len(cold(service)) == 1


def test_search_in_more_maps_than_fit_is_refused(stocked: Any) -> None:
    refused = match(stocked, 3, None)
    assert_problem(refused, 413, "too-much-work", "keeps 45 segments in memory")
    assert match(stocked, 3, ["barn", "yard"]).is_success
    assert stocked.put("/maps/barn/tags", json={"tags": ["north"]}).is_success
    body = {
        "model_id": stocked.app.state.placecell.model_id,
        "codes": CODES[3:4].tolist(),
        "tags": ["north"],
    }
    answer = stocked.post("/match", json=body)
    assert {each["map"] for each in answer.json()["queries"][0]["candidates"]} == {"barn"}


def test_map_that_is_larger_than_the_limit_is_served(service: Any, manifest: Manifest) -> None:
    file = encode(map_of(CODES, manifest.model_id))
    assert service.put("/maps/site", content=file).status_code == 201
    assert match(service, 50, ["site"]).json()["queries"][0]["candidates"][0]["id"] == 150
    assert match(service, 50, None).is_success


def test_cold_map_is_written_and_deleted(stocked: Any, manifest: Manifest) -> None:
    assert cold(stocked) == ["barn"]
    edit = edit_of(CODES[:5], manifest.model_id, 150, robot="barn")
    assert stocked.post("/maps/barn/segments", content=edit).json()["segments"] == 25
    assert stocked.get("/maps").json()["maps"][0]["robots"] == {"barn": 25}
    assert len(cold(stocked)) == 1
    (name,) = cold(stocked)
    assert stocked.delete(f"/maps/{name}").status_code == 204
    assert_problem(stocked.get(f"/maps/{name}"), 404, "unknown-map")
    assert len(maps(stocked)) == 2
    assert maps(stocked).stored_bytes == sum(each.head.bytes for each in maps(stocked).entries())


def test_cold_map_that_is_damaged_is_told(stocked: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from service.maps.store import StoreError

    def damaged(*_: object) -> Any:
        raise StoreError("damaged", "altered bytes")

    monkeypatch.setattr("service.maps.repository.load_newest", damaged)
    assert_problem(match(stocked, 3, ["barn"]), 500, "map-damaged")
    assert stocked.get("/maps").json()["damaged"] == ["barn"]
    assert stocked.delete("/maps/barn").status_code == 204


def test_cold_map_is_not_read_while_the_store_fails(
    stocked: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from service.maps.store import StoreError

    def unreachable(*_: object) -> Any:
        raise StoreError("unreachable", "no answer")

    with monkeypatch.context() as away:
        away.setattr("service.maps.repository.load_newest", unreachable)
        assert_problem(match(stocked, 3, ["barn"]), 503, "store-unavailable")
        assert match(stocked, 23, ["hall"]).is_success
    assert match(stocked, 3, ["barn"]).is_success


def test_maintenance_keeps_the_cache_of_cold_maps(stocked: Any) -> None:
    repository = maps(stocked)
    snapshot = repository.find("hall")
    cache = repository._cache
    cache.save(snapshot.head, snapshot.layers.content())
    assert match(stocked, 3, ["barn", "yard"]).is_success
    assert cold(stocked) == ["hall"]
    cache.keep_only({each.head.uid for each in repository.entries()})
    with repository.store.read(snapshot.head.uid) as history:
        assert cache.load(history) is not None
