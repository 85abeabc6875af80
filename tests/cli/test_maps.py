"""Tests of `placecell maps` against a running service."""

import hashlib
import json
import socket
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import httpx
import numpy as np
import pytest
from placecell_client import Client, CompactMap, Delta, decode, encode, encode_delta, originated
from placecell_client.maps.edit import apply, take
from typer.testing import CliRunner

from cli import app
from service.child_process import running_service
from tests.cli.maps_command import bad, good


def test_map_is_pushed_pulled_compared_restored_pruned_compacted_and_deleted(
    address: str, tmp_path: Path, yard: CompactMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_URL", address)
    file, copy = tmp_path / "yard.map", tmp_path / "copy.map"
    file.write_bytes(encode(yard))
    assert "Map yard has 300 segments, version 1" in good("push", file)
    assert "300 segments, updated from version 0 to 1" in good("pull", "yard", copy)
    assert copy.read_bytes() == file.read_bytes()
    assert "ann 300" in good("list")
    with Client(address) as client:
        gone = Delta(take(yard, np.arange(0)), np.arange(5, dtype=np.uint32))
        client.edit_map("yard", gone, robot="ann")
    assert "0 added, 0 changed, 5 removed, 295 unchanged" in good("diff", copy, "yard")
    assert "5 added" in good("diff", "yard", "yard@1")
    # The copy is at version 1: the push must not overwrite version 2.
    copy.write_bytes(encode(take(yard, np.arange(10))))
    assert "412" in bad("push", copy, "yard")
    copy.write_bytes(file.read_bytes())
    assert "295 segments, updated from version 1 to 2" in good("pull", "yard", copy)
    assert decode(copy.read_bytes()).ids[0] == 5
    copy.write_bytes(encode(take(yard, np.arange(10))))
    assert "10 segments, version 3" in good("push", copy, "yard")
    assert "version 3" in good("push", copy, "yard")
    assert "428" in bad("push", file, "yard")
    assert "version 4" in good("push", file, "yard", "--replace")
    shown = good("show", "yard", "--plot", tmp_path / "yard.png")
    assert [word in shown for word in ("put", "edit", "anyone")] == [True, True, True]
    assert (tmp_path / "yard.png").read_bytes().startswith(b"\x89PNG")
    assert "295 segments as in version 2; this is now version 5" in good("restore", "yard", 2)
    assert "295 segments would be removed" in good(
        "prune", "yard", "--unseen-since", "2030-01-01", "--dry-run"
    )
    assert "0 segments were removed" in good("prune", "yard", "--unseen-since", "1990-01-01")
    assert "Version 4 is now the oldest" in good("compact", "yard", "--keep", 2)
    assert "410" in bad("diff", "yard", "yard@1")
    assert CliRunner().invoke(app, ["maps", "delete", "yard"], input="n\n").exit_code == 1
    assert "is deleted" in good("delete", "yard", "--yes")
    assert "404" in bad("show", "yard")
    assert "number" in bad("diff", "yard@x", "yard")


def test_push_applies_a_delta_file(address: str, tmp_path: Path, yard: CompactMap) -> None:
    file, name = tmp_path / "site.delta", "with-delta"
    bobs = Delta(replace(take(yard, np.arange(10)), robots=("bob",)), np.array([20, 21], np.uint32))
    file.write_bytes(encode_delta(bobs))
    assert "404" in bad("push", file, name, "--url", address)
    with Client(address) as client:
        client.put_map(name, yard)
        # The segments belong to ann.
        assert "409" in bad("push", file, name, "--url", address)
        told = good("push", file, name, "--replace", "--url", address)
        assert "10 changed, 2 removed" in told
        assert "298 segments, version 2" in told
        assert client.get_map(name).robots == ("ann", "bob")
    file.write_bytes(file.read_bytes()[:-1])
    assert "cut" in bad("push", file, name, "--url", address)


def test_pull_of_an_earlier_version_writes_no_etag(
    address: str, tmp_path: Path, yard: CompactMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PLACECELL_URL", address)
    with Client(address) as client:
        first = client.put_map("earlier", yard)
        client.put_map("earlier", take(yard, np.arange(9)), if_match=first.etag)
    assert "earlier@1.map holds version 1" in good("pull", "earlier", "--version", 1)
    assert (tmp_path / "earlier@1.map").read_bytes() == encode(yard)
    assert not (tmp_path / "earlier@1.map.etag").exists()
    good("pull", "earlier")
    assert (tmp_path / "earlier.map.etag").exists()
    good("pull", "earlier", "earlier.map", "--version", 1)
    # The file is not the newest version, so it must not replace the map.
    assert "428" in bad("push", "earlier.map")
    assert "9 segments, updated from version 0 to 2" in good("pull", "earlier")
    assert "404" in bad("pull", "earlier", "--version", 3)
    assert not (tmp_path / "earlier@3.map").exists()


def test_show_prints_the_sources_of_a_merged_map(address: str, yard: CompactMap) -> None:
    some = take(yard, np.arange(120))
    rest = take(yard, np.arange(120, 300))
    site = apply(rest, Delta(originated(some, "east"), np.zeros(0, np.uint32)))
    with Client(address) as client:
        stored = client.put_map("site", site)
        assert stored.sources == {"east": 120}
        client.put_map("plain", yard)
        assert "300 segments, merged from other maps: 120 from east" in good(
            "show", "site", "--url", address
        )
        assert "merged" not in good("show", "plain", "--url", address)
        client.delete_map("site")
        client.delete_map("plain")


def test_unreachable_service_is_an_error() -> None:
    assert "placecell serve" in bad("list", "--url", "http://127.0.0.1:9")


def test_lost_answer_says_that_the_request_may_be_done() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def hang_up() -> None:
            connection, _ = server.accept()
            connection.recv(65536)
            connection.close()

        with ThreadPoolExecutor(1) as pool:
            pool.submit(hang_up)
            port = server.getsockname()[1]
            told = bad("delete", "yard", "--yes", "--url", f"http://127.0.0.1:{port}")
    assert "may still have been carried out" in told


def test_verify_checks_files_and_data_folders(
    address: str, data_dir: Path, tmp_path: Path, yard: CompactMap
) -> None:
    whole, delta, cut = tmp_path / "a.map", tmp_path / "a.delta", tmp_path / "cut.map"
    whole.write_bytes(encode(yard))
    delta.write_bytes(encode_delta(Delta(yard, np.zeros(0, np.uint32))))
    assert good("verify", whole, delta).count("intact") == 2
    cut.write_bytes(whole.read_bytes()[:-1])
    assert "cut" in bad("verify", whole, cut)
    assert "holds no maps.sqlite" in bad("verify", tmp_path)
    assert "Stop the service first" in bad("verify", data_dir)


def test_verify_finds_a_damaged_map_in_a_stopped_services_folder(
    tmp_path: Path, yard: CompactMap
) -> None:
    with running_service(tmp_path) as address, Client(address) as client:
        client.put_map("yard", yard)
        client.put_map("other", replace(yard, frame="elsewhere"))
    assert "intact" in good("verify", tmp_path)
    database = tmp_path / "maps.sqlite"
    data = bytearray(database.read_bytes())
    place = data.index(yard.codes[100].tobytes())
    data[place] ^= 1
    database.write_bytes(data)
    assert "altered" in bad("verify", tmp_path)
    with running_service(tmp_path) as address, Client(address) as client:
        stored = client.maps()
        assert [one.name for one in stored] == ["other"]
        assert stored.damaged == ("yard",)
        listed = good("list", "--url", address)
    assert "other" in listed
    assert "Map yard is damaged" in listed


def test_B12_commands_print_json(
    address: str, tmp_path: Path, yard: CompactMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_URL", address)
    file = tmp_path / "told.map"
    file.write_bytes(encode(yard))
    assert json.loads(good("push", file, "--json"))["segments"] == 300
    assert json.loads(good("pull", "told", file, "--json"))["version"] == 1
    file.write_bytes(encode(take(yard, np.arange(10))))
    assert json.loads(good("push", file, "--json"))["version"] == 2
    counts = json.loads(good("diff", "told@1", "told", "--json"))
    assert counts == {"added": 0, "changed": 0, "removed": 290, "same": 10}
    shown = json.loads(good("show", "told", "--json"))
    assert [one["sequence"] for one in shown["versions"]] == [2, 1]
    assert json.loads(good("restore", "told", 1, "--json"))["version"] == 3
    pruned = json.loads(good("prune", "told", "--unseen-since", "1990-01-01", "--json"))
    assert pruned == {"map": "told", "removed": 0, "dry_run": False}
    assert json.loads(good("compact", "told", "--json"))["oldest"] == 3
    assert json.loads(good("delete", "told", "--yes", "--json"))["deleted"] is True


def test_B9_push_sends_a_large_map_file_in_parts(tmp_path: Path, yard: CompactMap) -> None:
    file, copy = tmp_path / "yard.map", tmp_path / "copy.map"
    data = encode(yard)
    file.write_bytes(data)
    limit = {"PLACECELL_LIMITS__MAP_BYTES": "4000"}
    with running_service(tmp_path / "data", environment=limit) as address:
        at = ("--url", address)
        # Simulate a push that was interrupted after two parts.
        digest = hashlib.sha256(data).hexdigest()
        for offset in (0, 4_000):
            part = data[offset : offset + 4_000]
            path = f"{address}/maps/yard/uploads/{digest}?offset={offset}"
            assert httpx.put(path, content=part).is_success
        assert f"{digest}: 8,000 bytes" in good("uploads", "yard", *at)
        assert "300 segments, version 1" in good("push", file, *at)
        assert "no unfinished uploads" in good("uploads", "yard", *at)
        assert "version 0 to 1" in good("pull", "yard", copy, *at)
        assert copy.read_bytes() == data
        less = encode(take(yard, np.arange(250)))
        copy.write_bytes(less)
        assert "250 segments, version 2" in good("push", copy, "yard", *at)
        assert "428" in bad("push", file, "yard", *at)
        told = json.loads(good("uploads", "yard", "--remove", "--json", *at))
        assert told["removed"]
        assert [each["bytes"] for each in told["uploads"]] == [len(data)]
        assert "no unfinished uploads" in good("uploads", "yard", *at)
        told = json.loads(good("reset-ids", "yard", "--json", *at))
        assert told["map"] == "yard"
        assert told["first"] + told["count"] == 1 << 32
        assert "ids from" in good("reset-ids", "yard", *at)


def test_pull_with_a_filter_writes_a_part_that_cannot_be_pushed_by_mistake(
    address: str, tmp_path: Path, yard: CompactMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_URL", address)
    classes = np.where(np.arange(300) < 40, 94, 1).astype(np.uint8)  # 94: a vehicle
    file, part = tmp_path / "parked.map", tmp_path / "part.map"
    file.write_bytes(encode(replace(yard, classes=classes)))
    good("push", file)
    assert "holds 260 segments" in good("pull", "parked", part, "--ignore", "movable")
    assert len(decode(part.read_bytes())) == 260
    assert not part.with_name("part.map.etag").exists()
    assert "428" in bad("push", part, "parked")
    assert "holds 40 segments" in good("pull", "parked", part, "--classes", "vehicle")
    copy = tmp_path / "copy.map"
    good("pull", "parked", copy)
    assert "Name another file" in bad("pull", "parked", copy, "--ignore", "movable")
    assert copy.read_bytes() == file.read_bytes()
    assert "Invalid class 'car'" in bad("pull", "parked", part, "--classes", "car")
    good("delete", "parked", "--yes")
