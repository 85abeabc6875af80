"""Quotas of maps, robots and bytes, and the memory of a map."""

import gc
import time
import tracemalloc
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Delta, encode
from typer.testing import CliRunner

from cli import app
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from service.core.settings import Limits
from service.maps.cache import MapCache
from service.maps.following.follower import Follower
from service.maps.index import FlatIndex, MapIndex, NibbleIndex, Nibbles
from service.maps.layers import MapLayers
from service.maps.writes import maintenance
from service.maps.writes.maintenance import Maintenance, MaintenanceThresholds
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes


def key_of(file: Path, name: str, *options: str) -> dict[str, str]:
    made = CliRunner().invoke(app, ["keys", name, "--file", str(file), "--write", *options])
    return {"Authorization": "Bearer " + made.output.splitlines()[0]}


def keeper_of(service: Any, data_dir: Path, bounds: MaintenanceThresholds) -> Maintenance:
    state = service.app.state.placecell
    return Maintenance(state.engine.maps, state.engine.sync, MapCache(data_dir), bounds)


def traced(make: Any) -> tuple[Any, int, int]:
    """Return the result of `make`, the bytes that it holds, and the peak bytes during the call."""
    gc.collect()
    tracemalloc.start()
    try:
        made = make()
        gc.collect()
        held, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return made, held, most


# A2: a map costs what it holds


@pytest.mark.slow
@pytest.mark.parametrize("per_byte", [1, 2, 4])
def test_A2_empty_index_takes_no_memory(per_byte: int) -> None:
    codes, quantizer = np.zeros((0, 32), np.int8), Quantizer(0.01, per_byte)
    kind = FlatIndex if per_byte == 1 else NibbleIndex
    kind(codes, quantizer)  # what all of a kind share
    indexes, held, _ = traced(lambda: [kind(codes, quantizer) for _ in range(1_000)])
    assert len(indexes) == 1_000
    assert held < 1_000 * 1_000


def test_A2_indexes_of_one_code_share_tables() -> None:
    one, other = (NibbleIndex(random_codes(9, n), Quantizer(0.1 + n, 4)) for n in range(2))
    assert one._tables is other._tables is Nibbles.of(4)
    assert Nibbles.of(2) is not Nibbles.of(4)


@pytest.mark.slow
def test_A2_empty_map_takes_little_memory(start: Any, manifest: Manifest) -> None:
    empty = encode(map_of(random_codes(0), manifest.model_id))
    with start() as service:
        maps = service.app.state.placecell.engine.maps

        def put(number: int) -> int:
            return int(service.put(f"/maps/m{number}", content=empty).status_code)

        assert put(0) == 201
        _, held, _ = traced(lambda: [put(n) for n in range(1, 41)])
        assert len(maps) == 41
        # 10,000 empty maps must take less than 200 MB; the docs have measurements.
        assert held < 40 * 20_000


def test_A2_default_limits_allow_ten_thousand_maps() -> None:
    limits = Limits()
    assert limits.maps >= limits.key_maps >= 10_000


def test_A2_number_of_maps_is_limited(start: Any, manifest: Manifest) -> None:
    file = encode(map_of(random_codes(0), manifest.model_id))
    with start(limits={"maps": 3}) as service:
        for name in "abc":
            assert service.put(f"/maps/{name}", content=file).status_code == 201
        edit = edit_of(random_codes(1), manifest.model_id)
        for response in (
            service.put("/maps/d", content=file),
            service.post("/maps/d/segments?create=true", content=edit),
        ):
            assert_problem(response, 507, "quota-exceeded", "3 maps; the limit is 3")
        # Existing maps accept writes, and a deletion allows a new map.
        assert service.post("/maps/a/segments", content=edit).status_code == 200
        assert service.delete("/maps/b").status_code == 204
        assert service.put("/maps/d", content=file).status_code == 201
        assert service.get("/info").json()["limits"]["maps"] == 3
    with start(limits={"maps": 3}) as service:
        assert_problem(service.put("/maps/e", content=file), 507, "quota-exceeded")
    with start(limits={"maps": 2}) as service:
        # Under a lower limit existing maps stay.
        assert len(service.get("/maps").json()["maps"]) == 3
        assert service.post("/maps/a/segments", content=edit).status_code == 200


def test_A2_number_of_maps_of_a_key_is_limited(
    start: Any, manifest: Manifest, tmp_path: Path
) -> None:
    keys = tmp_path / "keys.toml"
    ann, bob = key_of(keys, "ann"), key_of(keys, "bob")
    file = encode(map_of(random_codes(2), manifest.model_id))

    def refused(name: str) -> None:
        response = service.put(f"/maps/{name}", content=file, headers=ann)
        assert_problem(response, 507, "quota-exceeded", "2 maps")

    with start(keys_file=keys, limits={"key_maps": 2}) as service:
        for name in "ab":
            assert service.put(f"/maps/{name}", content=file, headers=ann).is_success
        refused("c")
        # A write to another key's map does not count for the writer.
        edit = edit_of(random_codes(1), manifest.model_id, 900)
        assert service.post("/maps/a/segments", content=edit, headers=bob).is_success
        for name in "de":
            assert service.put(f"/maps/{name}", content=file, headers=bob).is_success
    with start(keys_file=keys, limits={"key_maps": 2}) as service:
        refused("c")
        assert service.delete("/maps/a", headers=bob).status_code == 204
        assert service.put("/maps/c", content=file, headers=ann).status_code == 201


def test_A2_number_of_robots_of_a_map_is_limited(start: Any, manifest: Manifest) -> None:
    with start(limits={"map_robots": 3}) as service:
        for number in range(3):
            edit = edit_of(random_codes(1), manifest.model_id, number, f"robot {number}")
            assert service.post("/maps/a/segments?create=1", content=edit).is_success
        more = edit_of(random_codes(1), manifest.model_id, 9, "robot 9")
        refused = service.post("/maps/a/segments", content=more)
        assert_problem(refused, 507, "quota-exceeded", "4 robots; the limit is 3")
        again = edit_of(random_codes(1, 5), manifest.model_id, 10, "robot 0")
        assert service.post("/maps/a/segments", content=again).status_code == 200


# A17: history counts


def grow(service: Any, manifest: Manifest, step: int, name: str = "yard") -> Any:
    """Replace the same segments again and again: the map keeps its size, its history grows."""
    edit = edit_of(random_codes(200, step), manifest.model_id)
    return service.post(f"/maps/{name}/segments", content=edit)


def test_A17_history_counts_and_deletion_is_always_possible(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Maintenance, "_work", lambda _: None)
    with start(limits={"map_stored_bytes": 50_000}) as service:
        file = encode(map_of(random_codes(200), manifest.model_id))
        assert service.put("/maps/yard", content=file).status_code == 201
        steps = 0
        while (response := grow(service, manifest, steps + 1)).status_code == 200:
            steps += 1
            assert steps < 100
        assert 2 < steps < 20
        assert_problem(response, 507, "quota-exceeded", "compact")
        assert "50000" in response.json()["detail"]
        (told,) = service.get("/maps").json()["maps"]
        assert 40_000 < told["bytes"] <= 50_000
        # Removals are stored nevertheless.
        less = edit_of(random_codes(0), manifest.model_id, removed=[100])
        assert service.post("/maps/yard/segments?robot=ann", content=less).status_code == 200
        assert service.post("/maps/yard/age?unseen_since=0").status_code == 200
        # Maintenance compacts a map whose write was refused.
        keeper_of(service, data_dir, MaintenanceThresholds(map_bytes=50_000)).run_once()
        assert grow(service, manifest, 999).status_code == 200
        assert service.get("/maps/yard/versions").json()["oldest"] > 1
        # Manual compaction makes space at once.
        while grow(service, manifest, steps + 1).status_code == 200:
            steps += 1
        assert service.post("/maps/yard/compact").status_code == 200
        assert grow(service, manifest, 1_000).status_code == 200
        assert service.delete("/maps/yard").status_code == 204
        assert service.put("/maps/yard", content=file).status_code == 201


def test_A17_quota_covers_all_maps_together(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Maintenance, "_work", lambda _: None)
    with start(limits={"stored_bytes": 60_000}) as service:
        file = encode(map_of(random_codes(200), manifest.model_id))
        for name in ("yard", "hall"):
            assert service.put(f"/maps/{name}", content=file).status_code == 201
        step = 0
        while (response := grow(service, manifest, step := step + 1)).status_code == 200:
            assert step < 100
        assert_problem(response, 507, "quota-exceeded", "the limit is 60000 bytes")
        assert_problem(service.put("/maps/new", content=file), 507, "quota-exceeded")
        keeper_of(service, data_dir, MaintenanceThresholds(all_bytes=60_000)).run_once()
        assert sum(each["bytes"] for each in service.get("/maps").json()["maps"]) < 45_000
        assert service.put("/maps/new", content=file).status_code == 201
        for name in ("yard", "hall", "new"):
            assert service.delete(f"/maps/{name}").status_code == 204
        assert service.app.state.placecell.engine.maps.stored_bytes == 0


def test_A17_usage_equals_a_recount(start: Any, manifest: Manifest, data_dir: Path) -> None:
    with start() as service:
        for name in "ab":
            file = encode(map_of(random_codes(200), manifest.model_id))
            assert service.put(f"/maps/{name}", content=file).status_code == 201
            for step in range(4):
                assert grow(service, manifest, step, name).status_code == 200
        other = edit_of(random_codes(5), manifest.model_id, 900, "bob")
        assert service.post("/maps/a/segments", content=other).status_code == 200
        assert service.post("/maps/a/versions/1/restore").status_code == 200
        assert service.post("/maps/b/compact?keep=2").status_code == 200
        keeper_of(service, data_dir, MaintenanceThresholds(recent=3, share=0.0)).run_once()
        assert service.delete("/maps/b").status_code == 204
        counted = service.app.state.placecell.engine.maps._usage
        told = service.get("/maps").json()["maps"]
        assert (counted.maps, counted.bytes) == (1, told[0]["bytes"])
        assert counted.robots == told[0]["robots"]
    with start() as service:
        assert service.app.state.placecell.engine.maps._usage == counted


# B19: a rebuild leaves nothing behind


@pytest.mark.slow
def test_B19_flattening_leaves_one_copy_in_memory(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Maintenance, "_work", lambda _: None)
    monkeypatch.setattr(Follower, "_work", lambda _: None)
    released: list[float] = []
    monkeypatch.setattr(maintenance, "release", lambda: released.append(time.monotonic()))
    layers: weakref.WeakSet[MapLayers] = weakref.WeakSet()
    indexes: weakref.WeakSet[MapIndex] = weakref.WeakSet()
    made_layers, made_index = MapLayers.__init__, MapIndex.__init__

    def noted_layers(self: MapLayers, *values: Any, **named: Any) -> None:
        made_layers(self, *values, **named)
        layers.add(self)

    def noted_index(self: MapIndex, *values: Any) -> None:
        made_index(self, *values)
        indexes.add(self)

    monkeypatch.setattr(MapLayers, "__init__", noted_layers)
    monkeypatch.setattr(MapIndex, "__init__", noted_index)
    while_saved: list[int] = []
    save = MapCache.save

    def noted_save(self: MapCache, *values: Any) -> None:
        while_saved.append(len({id(each.base) for each in layers}))
        save(self, *values)

    monkeypatch.setattr(MapCache, "save", noted_save)
    with start() as service:
        file = encode(map_of(random_codes(300), manifest.model_id))
        assert service.put("/maps/yard", content=file).status_code == 201
        keeper = keeper_of(service, data_dir, MaintenanceThresholds(recent=10, share=0.0))
        maps = service.app.state.placecell.engine.maps
        for step in range(1, 9):
            # Not over HTTP, because a thread keeps the snapshot for a moment after its answer.
            changed = map_of(random_codes(200, step), manifest.model_id)
            delta = maps.get("yard").layers.effect_of(Delta(changed, np.zeros(0, np.uint32))).delta
            maps.commit(maps.get("yard"), delta, "ann", "edit")
            keeper.run_once()
        assert len(while_saved) == 8
        # The old copy is freed before the new one's file is made.
        assert while_saved == [1] * 8
        gc.collect()
        assert len({id(each.base) for each in layers}) == 1
        assert len(indexes) == 2  # of both layers
        assert len(released) == 8


def test_B19_free_memory_is_released_after_many_writes(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Maintenance, "_work", lambda _: None)
    released: list[int] = []
    monkeypatch.setattr(maintenance, "release", lambda: released.append(1))
    with start() as service:
        keeper = keeper_of(service, data_dir, MaintenanceThresholds(handled=1_000))
        file = encode(map_of(random_codes(900), manifest.model_id))
        assert service.put("/maps/yard", content=file).status_code == 201
        keeper.run_once()
        assert not released
        assert grow(service, manifest, 1).status_code == 200
        for _ in range(3):
            keeper.run_once()
        assert len(released) == 1
        assert service.delete("/maps/yard").status_code == 204
        assert service.put("/maps/yard", content=file).status_code == 201
        keeper.run_once()
        assert len(released) == 2


@pytest.mark.slow
def test_B19_index_is_built_in_steps() -> None:
    codes = random_codes(100_000, dimension=8)
    for kind, quantizer in ((NibbleIndex, Quantizer(1.0, 4)), (FlatIndex, Quantizer(1.0))):
        _, _, most = traced(lambda kind=kind, quantizer=quantizer: kind(codes, quantizer))
        # NumPy indices of all codes would take eight times their bytes.
        assert most < 4 * codes.nbytes
