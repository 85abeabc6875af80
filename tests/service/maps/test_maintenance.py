"""Maintenance: background work changes no answer."""

import json
import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.api.state import State
from service.maps.cache import MapCache
from service.maps.writes.maintenance import Maintenance, MaintenanceThresholds
from tests.service.service_builders import edit_of, map_of, random_codes

pytestmark = pytest.mark.slow  # by their sum

EAGER = MaintenanceThresholds(recent=3, share=0.0, commits=1_000)


def keeper_of(state: State, data_dir: Path, bounds: MaintenanceThresholds) -> Maintenance:
    return Maintenance(state.engine.maps, state.engine.sync, MapCache(data_dir), bounds)


@contextmanager
def site(start: Any, manifest: Manifest, edits: int = 5) -> Iterator[tuple[Any, State]]:
    """Fill a service, whose maintenance sleeps, with a map of edits + 1 versions."""
    with start() as service:
        service.put("/maps/site", content=encode(map_of(random_codes(20), manifest.model_id)))
        for step in range(edits):
            data = edit_of(random_codes(2, step), manifest.model_id, 115 + 3 * step)
            assert service.post("/maps/site/segments", content=data).status_code == 200
        yield service, service.app.state.placecell


def told(service: Any, manifest: Manifest) -> list[Any]:
    """Return all that a client can see of the map."""
    query = {"model_id": manifest.model_id, "codes": random_codes(9, 3).tolist(), "k": 30}
    sequence = service.get("/maps").json()["maps"][0]["sequence"]
    versions = service.get("/maps/site/versions").json()
    kept = range(versions["oldest"], sequence + 1)
    return [
        service.get("/maps").json(),
        service.post("/match", json=query).json(),
        versions,
        [service.get(f"/maps/site?version={one}").content for one in kept],
        [service.get(f"/maps/site/changes?since={one}").content for one in (0, *kept)],
    ]


def test_flattened_layers_are_the_same_map(start: Any, manifest: Manifest, data_dir: Path) -> None:
    with site(start, manifest) as (service, state):
        before = told(service, manifest)
        assert len(state.engine.maps.get("site").layers.recent) > 3
        keeper_of(state, data_dir, EAGER).run_once()
        assert len(state.engine.maps.get("site").layers.recent) == 0
        assert state.engine.maps.get("site").base_sequence == 6
        assert told(service, manifest) == before
    with start() as service:
        assert told(service, manifest) == before
        # The start used the cache and replayed nothing.
        stored = service.app.state.placecell.engine.maps.get("site")
        assert (stored.base_sequence, len(stored.layers.recent)) == (6, 0)


@pytest.mark.slow
def test_write_during_flattening_stays(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with site(start, manifest) as (service, state):
        begun, written = threading.Event(), threading.Event()
        indexed = state.engine.maps._index

        def slowly(*arguments: Any) -> Any:
            # Block once in `flatten`: it has read everything and published nothing.
            monkeypatch.setattr(state.engine.maps, "_index", indexed)
            begun.set()
            assert written.wait(60)
            return indexed(*arguments)

        monkeypatch.setattr(state.engine.maps, "_index", slowly)
        keeper = keeper_of(state, data_dir, EAGER)
        thread = threading.Thread(target=keeper.run_once)
        thread.start()
        assert begun.wait(60)
        data = edit_of(random_codes(4, 8), manifest.model_id, 118, removed=[100, 116])
        assert service.post("/maps/site/segments", content=data).status_code == 200
        before = told(service, manifest)
        written.set()
        thread.join(60)
        assert state.engine.maps.get("site").base_sequence == 6
        assert told(service, manifest) == before
    with start() as service:
        assert told(service, manifest) == before


@pytest.mark.parametrize("what", ["removed", "removed and made anew"])
def test_map_deleted_during_flattening_stays_deleted(
    start: Any, manifest: Manifest, data_dir: Path, what: str
) -> None:
    with site(start, manifest) as (service, state):
        stored = state.engine.maps.get("site")
        service.delete("/maps/site")
        if "anew" in what:
            service.put("/maps/site", content=encode(map_of(random_codes(1), manifest.model_id)))
        before = service.get("/maps").json()
        assert state.engine.maps.flatten(stored) is None
        assert service.get("/maps").json() == before


def test_many_small_commits_trigger_flattening(
    start: Any, manifest: Manifest, data_dir: Path
) -> None:
    with site(start, manifest) as (_, state):
        keeper = keeper_of(state, data_dir, MaintenanceThresholds(commits=5))
        keeper.run_once()
        assert state.engine.maps.get("site").base_sequence == 1
        keeper_of(state, data_dir, MaintenanceThresholds(commits=4)).run_once()
        assert state.engine.maps.get("site").base_sequence == 6


@pytest.mark.slow
@pytest.mark.parametrize(
    "bounds",
    [MaintenanceThresholds(log_bytes=100, log_share=0), MaintenanceThresholds(log_commits=4)],
)
def test_long_history_is_compacted(
    start: Any, manifest: Manifest, data_dir: Path, bounds: MaintenanceThresholds
) -> None:
    with site(start, manifest) as (service, state):
        before = told(service, manifest)
        keeper_of(state, data_dir, MaintenanceThresholds()).run_once()
        assert told(service, manifest) == before
        keeper_of(state, data_dir, bounds).run_once()
        after = told(service, manifest)
        assert 1 < after[2]["oldest"] <= 6
        assert after[1] == before[1]
        assert after[3] == before[3][-len(after[3]) :]
        # Compaction drops enough that it is not due again at once.
        keeper_of(state, data_dir, bounds).run_once()
        assert told(service, manifest) == after
    with start() as service:
        assert told(service, manifest) == after


def damage(file: Path, how: str) -> None:
    data = file.read_bytes()
    line, _, rest = data.partition(b"\n")
    stated = json.loads(line)
    if how == "gone":
        file.unlink()
    elif how == "cut":
        file.write_bytes(data[:-1])
    elif how == "flipped":
        file.write_bytes(data[:-9] + bytes([data[-9] ^ 1]) + data[-8:])
    elif how == "empty":
        file.write_bytes(b"")
    elif how == "of another history":
        stated["mark"] = "0" * 64
        file.write_bytes(json.dumps(stated).encode() + b"\n" + rest)
    else:
        stated["sequence"] = {"of the future": 99, "of nonsense": "x"}[how]
        file.write_bytes(json.dumps(stated).encode() + b"\n" + rest)


@pytest.mark.parametrize(
    "how", ["gone", "cut", "flipped", "empty", "of another history", "of the future", "of nonsense"]
)
def test_invalid_cache_is_ignored(
    start: Any, manifest: Manifest, data_dir: Path, how: str, caplog: pytest.LogCaptureFixture
) -> None:
    with site(start, manifest) as (service, state):
        keeper_of(state, data_dir, EAGER).run_once()
        before = told(service, manifest)
    (file,) = (data_dir / "cache").iterdir()
    damage(file, how)
    with caplog.at_level(logging.WARNING), start() as service:
        assert told(service, manifest) == before
        assert service.app.state.placecell.engine.maps.get("site").base_sequence == 1
    assert ("is ignored" in caplog.text) == (how != "gone")


def test_outdated_cache_is_completed_from_the_store(
    start: Any, manifest: Manifest, data_dir: Path
) -> None:
    with site(start, manifest) as (service, state):
        keeper_of(state, data_dir, EAGER).run_once()
        data = edit_of(random_codes(4, 8), manifest.model_id, 118, removed=[100, 116])
        service.post("/maps/site/segments", content=data)
        before = told(service, manifest)
    with start() as service:
        assert service.app.state.placecell.engine.maps.get("site").base_sequence == 6
        assert told(service, manifest) == before


def test_caches_of_deleted_maps_are_removed(start: Any, manifest: Manifest, data_dir: Path) -> None:
    with site(start, manifest) as (service, state):
        keeper = keeper_of(state, data_dir, EAGER)
        keeper.run_once()
        (data_dir / "cache" / "half.unfinished").write_bytes(b"half")
        assert len(list((data_dir / "cache").iterdir())) == 2
        service.delete("/maps/site")
        keeper.run_once()
        assert list((data_dir / "cache").iterdir()) == []


def test_failed_maintenance_is_logged_and_retried(
    start: Any,
    manifest: Manifest,
    data_dir: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    with site(start, manifest) as (service, state):
        keeper = keeper_of(state, data_dir, EAGER)
        with monkeypatch.context() as patched, caplog.at_level(logging.ERROR):
            patched.setattr("os.fsync", lambda _: (_ for _ in ()).throw(OSError(28, "full")))
            keeper.run_once()
            assert "maintenance failed at map 'site'" in caplog.text
            patched.setattr(state.engine.maps.store, "release_space", lambda: 1 / 0)
            keeper.run_once()
            assert "maintenance failed at the data directory" in caplog.text
        assert service.get("/maps/site").status_code == 200
        keeper.run_once()


def test_maintenance_runs_and_stops_by_itself(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with site(start, manifest) as (_, state):
        before = threading.active_count()
        looked = threading.Event()
        monkeypatch.setattr(state.engine.sync, "expire", looked.set)
        bounds = MaintenanceThresholds(recent=3, share=0.0, seconds=0.01)
        with keeper_of(state, data_dir, bounds).running():
            assert threading.active_count() == before + 1
            assert looked.wait(60)
        assert threading.active_count() == before
        assert state.engine.maps.get("site").base_sequence == 6


def test_A2_maintenance_visits_only_written_maps(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Maintenance, "_work", lambda _: None)
    with start() as service:
        file = encode(map_of(random_codes(3), manifest.model_id))
        for number in range(5):
            assert service.put(f"/maps/m{number}", content=file).status_code == 201
        keeper = keeper_of(service.app.state.placecell, data_dir, MaintenanceThresholds())
        cared: list[str] = []
        care = keeper._maintain

        def noted(name: str) -> None:
            cared.append(name)
            if name == "m3" and cared.count(name) == 1:
                raise RuntimeError("fails once")
            care(name)

        monkeypatch.setattr(keeper, "_maintain", noted)
        for _ in range(3):
            keeper.run_once()
        # A failed run is retried.
        assert cared == ["m0", "m1", "m2", "m3", "m4", "m3"]
        edit = edit_of(random_codes(1), manifest.model_id, 900)
        assert service.post("/maps/m1/segments", content=edit).status_code == 200
        for _ in range(2):
            keeper.run_once()
        assert cared[6:] == ["m1"]
