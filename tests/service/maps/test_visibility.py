"""Visibility: a key of some maps learns nothing about other maps and keys."""

import hashlib
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, decode_delta, encode, encode_delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply

from placecell.descriptors.manifest import Manifest
from tests.service.clouds.scan_files import scan_file
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem, cloud, map_of, random_codes, request_of

FOREIGN = ("secret", "boss")
"""Parts of map and key names that the key under test may not learn."""


def merged(manifest: Manifest, count: int, first_id: int, robot: str = "ann") -> CompactMap:
    """Return segments from three maps: two outside the scope of the key, and one inside."""
    content = map_of(random_codes(count, first_id), manifest.model_id, first_id, robot)
    return canonical(
        replace(
            content,
            sources=("secret-yard", "hall-a", "secret-lab"),
            source=(np.arange(count) % 4).astype(np.uint16),
            source_ids=np.where(np.arange(count) % 4, 7_000 + np.arange(count), content.ids).astype(
                np.uint32
            ),
        )
    )


def edit(content: CompactMap) -> bytes:
    return encode_delta(Delta(content, np.zeros(0, np.uint32)))


@pytest.fixture
def hall(start: Any, tmp_path: Path, manifest: Manifest) -> Iterator[Any]:
    """Start a service full of another key's maps; yield it and the headers of both keys."""
    keys = tmp_path / "keys.toml"
    boss = made(keys, "boss of all", "--write", "--admin")
    ann = made(keys, "ann", "--write", "--map", "hall-*")
    limits = {"robot_segments": 100}
    with start(keys_file=keys, limits=limits) as service:

        def put(name: str, content: CompactMap, headers: dict[str, str]) -> None:
            answer = service.put(f"/maps/{name}", content=encode(content), headers=headers)
            assert answer.status_code == 201, answer.text

        put("secret-yard", map_of(random_codes(30), manifest.model_id, robot="ann"), boss)
        put("secret-lab", map_of(random_codes(9), manifest.model_id, robot="cat"), boss)
        put("hall-a", map_of(random_codes(8), manifest.model_id, robot="bob"), ann)
        put("hall-site", merged(manifest, 20, 0), boss)
        for step, headers in enumerate((boss, ann, boss)):
            data = edit(merged(manifest, 4, 100 + 10 * step, "bob"))
            address = "/maps/hall-site/segments"
            if headers is ann:
                data = edit(map_of(random_codes(4), manifest.model_id, 110, "bob"))
            assert service.post(address, content=data, headers=headers).status_code == 200
        yield service, boss, ann


PLACE = {"lat": 49.0, "lon": 8.0}
DIGEST = hashlib.sha256(b"part").hexdigest()


@pytest.mark.slow
def test_A19_answers_name_no_hidden_maps_or_keys(hall: Any, manifest: Manifest) -> None:
    service, boss, ann = hall
    document = service.get("/openapi.json").json()
    for address, body in (("anchor", PLACE), ("anchors/gate", {"position": [0, 0, 0]})):
        stored = service.put(f"/maps/hall-site/{address}", json=body, headers=boss)
        assert stored.is_success, stored.text
    queries = {"model_id": manifest.model_id, "codes": random_codes(3).tolist()}
    bodies: dict[str, list[dict[str, Any]]] = {
        "/describe": [{"json": request_of([cloud(0)])}],
        "/match": [{"json": queries}],
        "/localize": [
            {"json": queries | {"centroids": [[0, 0, 0], [5, 0, 0], [0, 5, 0]]} | more}
            for more in ({}, {"maps": ["hall-site"]}, {"session": "s"})
        ],
        "/maps/{map}/merge": [
            {"json": {"maps": maps, "dry_run": dry}}
            for maps in (["hall-a", "hall-site"], ["hall-a"], ["hall-a", "hall-none"])
            for dry in (True, False)
        ],
        "/maps/{map}/segments": [
            {"content": edit(map_of(random_codes(2), manifest.model_id, 4, "zoe"))},
            # This exceeds the robot's quota over all maps, mostly by segments in hidden maps.
            {"content": edit(map_of(random_codes(71), manifest.model_id, 300, "ann"))},
            {"content": b"rubbish"},
        ],
        "/robots/{robot}": [{"json": {"state": "lost"}}],
        "/coverage": [{"json": queries | {"centroids": [[0, 0, 0], [5, 0, 0], [0, 5, 0]]}}],
        "/maps/{map}/tags": [{"json": {"tags": ["indoor"]}}],
        "/maps/{map}/anchor": [{"json": PLACE}],
        "/maps/{map}/anchor/fit": [
            {
                "json": {
                    "fixes": [
                        {
                            "position": [10.0 * x, 5.0 * y, 0.0],
                            "lat": 49 + 4.5e-5 * y,
                            "lon": 8 + 1.37e-4 * x,
                            "accuracy": 1.0,
                        }
                        for x in range(4)
                        for y in range(4)
                    ]
                }
            }
        ],
        "/maps/{map}/anchors/{anchor}": [{"json": {"position": [1, 2, 3]}}],
        "/scans": [{"content": scan_file("pcd")[2]}],
        "/maps/{map}/scans": [{"content": scan_file("pcd")[2]}],
        "/maps/{map}/uploads/{digest}": [{"content": b"part"}],
        "/maps/{map}": [
            {"content": encode(map_of(random_codes(71), manifest.model_id, 300, "ann"))},
            {"content": b"rubbish"},
        ],
    }
    known = service.get("/events?seconds=0", headers=ann).text
    first = re.search(r"^id: ?(\w+)-\d+$", known, re.MULTILINE)
    assert first is not None, known
    ann = ann | {"Last-Event-ID": f"{first[1]}-0"}  # `/events` tells all that was before.
    assert "hall-site" in service.get("/events?seconds=0", headers=ann).text
    options: dict[str, list[str]] = {
        "/events": ["seconds=0"],
        "/maps/{map}/ids": ["count=3"],
        "/maps/{map}/shapes": ["id=1&id=2"],
        "/maps/{map}/export": ["to=ply", "to=pcd&color=robot", "to=geojson&anchor=49,8"],
        "/maps/{map}/scans": ["robot=zoe", "robot=ann"],
        "/maps/{map}/versions/{version}/restore": ["dry_run=true", ""],
        "/maps/{map}/uploads/{digest}": ["offset=0"],
        "/maps/{map}/age": ["unseen_since=0&dry_run=true", "unseen_since=0"],
        "/maps/{map}/changes": ["since=0", "since=1", "since=2", "since=0&limit=3"],
        "/maps/{map}": [*(f"version={one}" for one in range(1, 6)), ""],
    }
    asked = set()
    for path, operations in document["paths"].items():
        # Removing requests come last.
        for method in sorted(operations, key=["post", "put", "get", "delete"].index):
            names = ["hall-site", "hall-none"] if method != "delete" else ["hall-none"]
            for name in names:
                for query in options.get(path, [""]):
                    for body in bodies.get(path, [{}]) if method in {"post", "put"} else [{}]:
                        filled = path.replace("{map}", name).replace("{other}", "hall-a")
                        filled = filled.replace("{version}", "2").replace("{digest}", DIGEST)
                        filled = filled.replace("{robot}", "ann").replace("{anchor}", "dock")
                        filled = filled.replace("{id}", "1")
                        address = f"{filled}?{query}"
                        headers = ann | {"If-Match": "*"} if "hall-site" in filled else ann
                        answer = service.request(method, address, headers=headers, **body)
                        assert answer.status_code < 500 or answer.status_code == 507, answer.text
                        told = str(answer.headers).encode() + answer.content
                        for word in FOREIGN:
                            assert word.encode() not in told, (method, address, answer.content)
                        asked.add((path, method, answer.is_success))
    succeeded = {(path, method) for path, method, good in asked if good}
    every = {(path, method) for path, each in document["paths"].items() for method in each}
    assert {(path, method) for path, method, _ in asked} == every
    # Each request that the key may send succeeded at least once, except replacements and merges.
    assert every - succeeded <= {
        ("/models/reload", "post"), ("/maps/{map}/ids/reset", "post"), ("/maps/{map}", "delete"),
        ("/maps/{map}/merge", "post"), ("/maps/{map}/align/{other}", "post"),
        ("/maps/{map}", "put"), ("/maps/{map}/uploads/{digest}", "post"),
        ("/maps/{map}/uploads/{digest}", "delete"), ("/maps/{map}/anchor", "delete"),
        ("/maps/{map}/anchors/{anchor}", "delete"), ("/maps/{map}/mirror", "put"),
        ("/maps/{map}/mirror", "delete"),  # it would refuse all later writes
        # The model of the test has no decoder.
        ("/maps/{map}/segments/{id}/shape", "get"), ("/maps/{map}/shapes", "get"),
    }  # fmt: skip
    # A key of all maps sees all names.
    assert service.get("/maps", headers=boss).json()["maps"][1]["sources"]
    authors = [
        each["author"]
        for each in service.get("/maps/hall-a/versions", headers=boss).json()["versions"]
    ]
    assert set(authors) == {"ann"}


def test_A19_versions_name_only_the_keys_own_writes(hall: Any) -> None:
    service, boss, ann = hall
    told = {
        who: [
            each["author"]
            for each in service.get("/maps/hall-site/versions", headers=headers).json()["versions"]
        ]
        for who, headers in (("boss", boss), ("ann", ann))
    }
    assert told["boss"] == ["boss of all", "ann", "boss of all", "boss of all"]
    assert told["ann"] == ["another key", "ann", "another key", "another key"]


def test_A19_quota_error_reveals_no_totals_of_hidden_maps(hall: Any, manifest: Manifest) -> None:
    service, boss, ann = hall
    data = encode(map_of(random_codes(60), manifest.model_id, robot="ann"))
    refused = service.put("/maps/hall-b", content=data, headers=ann)
    assert_problem(refused, 507, "quota-exceeded", "'ann' would have too many segments")
    refused = service.put("/maps/hall-b", content=data, headers=boss)
    assert_problem(refused, 507, "quota-exceeded", "'ann' would have 110 segments")


def test_A19_copy_with_pseudonyms_can_be_written_back(hall: Any, manifest: Manifest) -> None:
    service, boss, ann = hall
    true = decode(service.get("/maps/hall-site", headers=boss).content)
    answer = service.get("/maps/hall-site", headers=ann)
    seen, tag = decode(answer.content), answer.headers["etag"]
    assert "hall-a" in seen.sources
    assert len(seen.sources) == len(true.sources) == 3
    assert sum(name.startswith("hidden:") for name in seen.sources) == 2
    np.testing.assert_array_equal(seen.ids, true.ids)
    np.testing.assert_array_equal(seen.source_ids, true.source_ids)
    # The file, the deltas from any version and the pages lead to the same copy.
    for since in range(1, 5):
        old = decode(service.get(f"/maps/hall-site?version={since}", headers=ann).content)
        changes = service.get(f"/maps/hall-site/changes?since={since}", headers=ann)
        assert encode(apply(old, decode_delta(changes.content))) == answer.content
    # Writing the copy back changes nothing and keeps hidden names.
    back = service.put("/maps/hall-site", content=answer.content, headers=ann | {"If-Match": tag})
    assert back.headers["etag"] == tag
    some = edit(canonical(replace(seen, codes=random_codes(len(seen), 77))))
    headers = ann | {"If-Match": tag}
    assert service.post("/maps/hall-site/segments", content=some, headers=headers).is_success
    assert decode(service.get("/maps/hall-site", headers=boss).content).sources == true.sources
    # Keys that see the same content share a file; others get their own.
    assert service.get("/maps/hall-site", headers=boss).content != answer.content


def test_A19_guessed_source_names_are_refused(hall: Any, manifest: Manifest) -> None:
    service, boss, ann = hall
    tried = merged(manifest, 4, 500)
    for answer in (
        service.put("/maps/hall-b", content=encode(tried), headers=ann),
        service.post("/maps/hall-site/segments", content=edit(tried), headers=ann),
    ):
        assert_problem(answer, 403, "forbidden", "source")
    own = canonical(replace(tried, sources=("hall-a", "hall-b", "hall-c")))
    assert service.put("/maps/hall-b", content=encode(own), headers=ann).status_code == 201
    # Pseudonyms of another map differ and are not restored.
    copy = service.get("/maps/hall-site", headers=ann).content
    put = service.put("/maps/hall-copy", content=copy, headers=ann)
    assert put.status_code == 201
    true = decode(service.get("/maps/hall-copy", headers=boss).content)
    assert not [name for name in true.sources if "secret" in name]
    assert (
        decode(copy).sources != decode(service.get("/maps/hall-copy", headers=ann).content).sources
    )
