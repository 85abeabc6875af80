"""Provenance of segments: stored, returned, and kept by all operations."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import (
    CompactMap,
    Delta,
    decode,
    decode_delta,
    encode,
    encode_delta,
    originated,
)
from placecell_client.maps.edit import apply, join, take

from placecell.descriptors.manifest import Manifest
from tests.client.file_surgery import with_inner_header
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

NONE = np.zeros(0, np.uint32)


def from_map(manifest: Manifest, source: str, first_id: int, count: int = 4) -> CompactMap:
    """Return segments of another map, with ids from 100 on there, under other ids."""
    there = map_of(random_codes(count, first_id), manifest.model_id)
    ids = np.arange(first_id, first_id + count, dtype=np.uint32)
    return replace(originated(there, source), ids=ids)


@pytest.fixture
def site(manifest: Manifest) -> bytes:
    """Return four segments of `east`, three of `west`, and two of the map itself."""
    own = map_of(random_codes(2), manifest.model_id, 1)
    merged = apply(own, Delta(from_map(manifest, "west", 20, 3), NONE))
    return encode(apply(merged, Delta(from_map(manifest, "east", 10), NONE)))


@pytest.fixture
def stored(service: Any, site: bytes) -> str:
    """Store the map; return its path."""
    assert service.put("/maps/site", content=site).status_code == 201
    return "/maps/site"


def sources_of(service: Any) -> dict[str, int]:
    (summary,) = service.get("/maps").json()["maps"]
    sources: dict[str, int] = summary["sources"]
    return sources


def whence(content: CompactMap) -> dict[int, tuple[str, int]]:
    """Return source and id there, by id."""
    assert content.source is not None
    assert content.source_ids is not None
    names = [("", *content.sources)[place] for place in content.source]
    pairs = zip(names, content.source_ids.tolist(), strict=True)
    return dict(zip(content.ids.tolist(), pairs, strict=True))


def test_provenance_of_a_put_is_returned(service: Any, stored: str, site: bytes) -> None:
    assert service.get(stored).content == site
    (summary,) = service.get("/maps").json()["maps"]
    assert summary["sources"] == {"east": 4, "west": 3}
    assert summary["optional"] == ["source", "source_ids"]
    assert whence(decode(site))[20] == ("west", 100)


@pytest.mark.slow
def test_provenance_survives_a_restart(start: Any, site: bytes, manifest: Manifest) -> None:
    with start() as service:
        service.put("/maps/site", content=site)
        edit = encode_delta(Delta(from_map(manifest, "north", 40), np.array([20], np.uint32)))
        told = service.post("/maps/site/segments?robot=ann", content=edit)
        assert told.status_code == 200, told.text
        before = [service.get("/maps").json(), service.get("/maps/site").content]
    with start() as service:
        assert [service.get("/maps").json(), service.get("/maps/site").content] == before
        assert sources_of(service) == {"east": 4, "north": 4, "west": 2}


def test_edit_adds_and_removes_sources(service: Any, stored: str, manifest: Manifest) -> None:
    # A robot that replaces a segment writes it to this map; other segments keep their provenance.
    edit = edit_of(random_codes(1, 9), manifest.model_id, 10, removed=[20, 21, 22])
    assert service.post(f"{stored}/segments?robot=ann", content=edit).status_code == 200
    assert sources_of(service) == {"east": 3}
    now = whence(decode(service.get(stored).content))
    assert [now[10], now[11]] == [("", 10), ("east", 101)]
    # New provenance alone is a change, once.
    content = take(decode(service.get(stored).content), np.array([2]))
    renamed = encode_delta(
        Delta(
            replace(content, sources=("dock",), source=np.array([1], np.uint16)),
            NONE,
        )
    )
    for changed in (1, 0):
        answer = service.post(f"{stored}/segments", content=renamed).json()
        assert (answer["changed"], answer["sequence"]) == (changed, 3)
    assert sources_of(service) == {"dock": 1, "east": 3}


def test_map_without_provenance_accepts_it(service: Any, manifest: Manifest) -> None:
    service.put("/maps/site", content=encode(map_of(random_codes(3), manifest.model_id, 1)))
    assert sources_of(service) == {}
    edit = encode_delta(Delta(from_map(manifest, "east", 10, 2), NONE))
    assert service.post("/maps/site/segments", content=edit).status_code == 200
    assert sources_of(service) == {"east": 2}
    now = whence(decode(service.get("/maps/site").content))
    assert now == {1: ("", 1), 2: ("", 2), 3: ("", 3), 10: ("east", 100), 11: ("east", 101)}


def test_merge_is_undone_and_repeated(
    service: Any, stored: str, site: bytes, manifest: Manifest
) -> None:
    edit = encode_delta(Delta(from_map(manifest, "north", 40), NONE))
    service.post(f"{stored}/segments", content=edit)
    merged = service.get(stored).content
    assert service.post(f"{stored}/versions/1/restore").status_code == 200
    assert service.get(stored).content == site
    assert sources_of(service) == {"east": 4, "west": 3}
    assert service.post(f"{stored}/versions/2/restore").status_code == 200
    assert service.get(stored).content == merged
    assert sources_of(service) == {"east": 4, "north": 4, "west": 3}


def test_first_source_can_be_removed_again(service: Any, manifest: Manifest) -> None:
    plain = encode(map_of(random_codes(3), manifest.model_id, 1))
    service.put("/maps/site", content=plain)
    edit = encode_delta(Delta(from_map(manifest, "east", 10, 2), NONE))
    service.post("/maps/site/segments", content=edit)
    service.post("/maps/site/versions/1/restore")
    assert service.get("/maps/site").content == plain
    assert sources_of(service) == {}


@pytest.mark.parametrize("since", [0, 1, 2])
def test_changes_contain_provenance(
    service: Any, stored: str, manifest: Manifest, since: int
) -> None:
    edits = [
        encode_delta(Delta(from_map(manifest, "north", 40), NONE)),
        edit_of(random_codes(1, 9), manifest.model_id, 10, removed=[20]),
    ]
    for edit in edits:
        service.post(f"{stored}/segments?robot=ann", content=edit)
    had = decode(service.get(f"{stored}?version={since or 1}").content)
    parts, query = [], f"since={since}"
    while query:
        response = service.get(f"{stored}/changes?{query}&limit=2")
        parts.append(decode_delta(response.content))
        cursor = response.headers.get("placecell-next")
        query = f"cursor={cursor}" if cursor else ""
    assert encode(apply(had, join(parts))) == service.get(stored).content


def test_refreshed_segment_keeps_provenance(service: Any, stored: str, site: bytes) -> None:
    there = decode(site)
    again = replace(
        take(there, np.array([8])),
        ids=np.array([99], np.uint32),
        frame_times=there.frame_times + 60,
        source=None,
        source_ids=None,
        sources=(),
    )
    told = service.post(
        f"{stored}/segments?deduplicate=true", content=encode_delta(Delta(again, NONE))
    ).json()
    assert (told["repeats"], told["segments"]) == (1, 9)
    now = decode(service.get(stored).content)
    assert now.seen is not None
    assert whence(now) == whence(there)
    assert sources_of(service) == {"east": 4, "west": 3}


@pytest.mark.parametrize(
    ("sources", "detail"),
    [
        (["east"], "source: 2, but there are 1 names"),
        (["east", 7], "sources is not a string"),
        (["east", "a\n"], "printable"),
        (["west", "east"], "canonical"),
    ],
)
def test_invalid_provenance_is_refused(
    service: Any, stored: str, site: bytes, sources: list[object], detail: str
) -> None:
    bad = with_inner_header(site, sources=sources)
    assert_problem(service.put("/maps/other", content=bad), 422, "invalid-map-file", detail)
    delta = encode_delta(Delta(decode(site), NONE))
    bad = with_inner_header(delta, sources=sources)
    answer = service.post(f"{stored}/segments", content=bad)
    assert_problem(answer, 422, "invalid-delta-file", detail)
    assert service.get(stored).content == site
