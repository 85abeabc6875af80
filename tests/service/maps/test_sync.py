"""Sync: a robot receives the changes since its version, in parts, over a bad link."""

from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, decode_delta, encode
from placecell_client.maps.delta_file import MEDIA_TYPE
from placecell_client.maps.edit import apply, empty, join

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes


@pytest.fixture
def site(service: Any, manifest: Manifest) -> str:
    """Store a map with five versions; return its path."""
    path = "/maps/site"
    service.put(path, content=encode(map_of(random_codes(40), manifest.model_id)))
    model = manifest.model_id
    for data in (
        edit_of(random_codes(5, 1), model, 200, "zoe"),
        edit_of(random_codes(3, 2), model, 110),
        edit_of(random_codes(2, 3), model, 200, "zoe", removed=[203]),
        edit_of(random_codes(0), model, removed=[100, 101, 110]),
    ):
        assert service.post(f"{path}/segments?robot=ann", content=data).status_code == 200
    return path


def nothing(manifest: Manifest) -> CompactMap:
    return empty(manifest.model_id, "1", "town", 7)


def pull(service: Any, path: str, since: str, limit: int = 20_000) -> tuple[Delta, str, int]:
    """Return all parts as one delta, the tag that it leads to, and the number of parts."""
    parts, tags = [], set()
    query = f"since={since}"
    while query:
        response = service.get(f"{path}/changes?{query}&limit={limit}")
        assert response.status_code == 200, response.text
        assert response.headers["content-type"] == MEDIA_TYPE
        part = decode_delta(response.content)
        assert len(part) <= limit
        assert response.headers["placecell-since"] == str(part.since)
        assert response.headers["placecell-until"] == str(part.until)
        parts.append(part)
        tags.add(response.headers["etag"].strip('"'))
        cursor = response.headers.get("placecell-next")
        query = f"cursor={cursor}" if cursor else ""
    (tag,) = tags
    return join(parts), tag, len(parts)


@pytest.mark.parametrize("limit", [1, 7, 1000])
@pytest.mark.parametrize("version", [0, 1, 2, 3, 4, 5])
def test_changes_from_every_version_lead_to_the_newest(
    service: Any, site: str, manifest: Manifest, version: int, limit: int
) -> None:
    had = service.get(f"{site}?version={version}") if version else None
    known = decode(had.content) if had else nothing(manifest)
    names = [str(version)] + ([had.headers["etag"].strip('"')] if had else [])
    for since in names:
        delta, tag, parts = pull(service, site, since, limit)
        assert (delta.since, delta.until) == (version, 5)
        assert encode(apply(known, delta)) == service.get(site).content
        assert f'"{tag}"' == service.get(site).headers["etag"]
        assert parts == max(1, -(-len(delta) // limit))
    if version == 5:
        assert len(delta) == 0
    if version == 4:
        assert (len(delta.changed), delta.removed.tolist()) == (0, [100, 101, 110])


def test_parts_lead_to_one_version_despite_writes(start: Any, manifest: Manifest) -> None:
    def more(service: Any, step: int) -> None:
        data = edit_of(random_codes(3, step), manifest.model_id, 90 + 7 * step)
        assert service.post("/maps/site/segments", content=data).status_code == 200

    parts = []
    with start() as service:
        service.put("/maps/site", content=encode(map_of(random_codes(9), manifest.model_id)))
        for step in range(3):
            more(service, step)
        expected, known = (service.get(f"/maps/site?version={one}").content for one in (4, 2))
        response = service.get("/maps/site/changes?since=2&limit=2")
        for step in range(3, 6):
            parts.append(decode_delta(response.content))
            cursor = response.headers["placecell-next"]
            more(service, step)
            if step < 5:
                response = service.get(f"/maps/site/changes?cursor={cursor}&limit=1")
    # A restart of the service changes nothing.
    with start() as service:
        while cursor:
            response = service.get(f"/maps/site/changes?cursor={cursor}&limit=1")
            parts.append(decode_delta(response.content))
            cursor = response.headers.get("placecell-next")
    assert {part.until for part in parts} == {4}
    assert encode(apply(decode(known), join(parts))) == expected


def test_changes_since_a_dropped_version_are_gone(
    service: Any, site: str, manifest: Manifest
) -> None:
    second = service.get(f"{site}?version=2").headers["etag"].strip('"')
    cursor = service.get(f"{site}/changes?since=2&limit=1").headers["placecell-next"]
    service.post(f"{site}/compact?keep=2")
    for query in (f"since={second}", "since=3"):
        assert_problem(service.get(f"{site}/changes?{query}"), 410, "version-gone", "since=0")
    # A running sync continues.
    assert service.get(f"{site}/changes?cursor={cursor}").status_code == 200
    for ahead in ("6", "0123456789abcdef-3", "0123456789abcdef-9"):
        refused = service.get(f"{site}/changes?since={ahead}")
        assert_problem(refused, 410, "version-gone")
    delta, _, _ = pull(service, site, "4")
    assert len(delta) == 3
    # A new map of the same name is another map, although its sequences are equal.
    content = service.get(site).content
    service.delete(site)
    service.put(site, content=content)
    service.post(f"{site}/segments", content=edit_of(random_codes(1), manifest.model_id, 999))
    assert_problem(service.get(f"{site}/changes?since={second}"), 410, "version-gone")
    assert_problem(service.get(f"{site}/changes?cursor={cursor}"), 410, "version-gone")


def test_changes_across_a_change_of_model_are_gone(
    start: Any, manifest: Manifest, other_manifest: Manifest
) -> None:
    with start(also=["other"]) as service:
        for each in (manifest, other_manifest):
            data = encode(map_of(random_codes(3), each.model_id))
            service.put(
                "/maps/yard",
                content=data,
                headers={"If-Match": "*"} if each is other_manifest else {},
            )
        assert_problem(service.get("/maps/yard/changes?since=1"), 410, "version-gone")
        delta, _, _ = pull(service, "/maps/yard", "0")
        assert encode(delta.changed) == data


@pytest.mark.parametrize(
    "query",
    [
        "since=-1", "since=x", "since=1.5", "since=" + "9" * 41, "since=abc-1", "limit=0",
        "limit=100001", "limit=x", "cursor=x", "cursor=", "cursor=1.0123456789abcdef-2.-1",
        "cursor=1.0123456789abcdef-2.99999999999", "cursor=" + "x" * 101,
    ],
)  # fmt: skip
def test_invalid_since_or_cursor_is_refused(service: Any, site: str, query: str) -> None:
    assert_problem(service.get(f"{site}/changes?{query}"), 422, "invalid-request")


@pytest.mark.slow
@pytest.mark.parametrize(
    "cursor", ["1.0123456789abcdef-2.0", "9.{}.0", "1.{}.4294967296", "9999999999999999.{}.1"]
)
def test_forged_cursor_does_no_harm(service: Any, site: str, cursor: str) -> None:
    tag = service.get(site).headers["etag"].strip('"')
    response = service.get(f"{site}/changes?cursor={cursor.format(tag)}")
    if response.status_code == 200:
        assert len(decode_delta(response.content)) == 0
    else:
        assert_problem(response, 410, "version-gone")


@pytest.mark.slow
def test_only_recent_syncs_stay_in_memory(
    service: Any, site: str, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    sync = service.app.state.placecell.engine.sync
    for step in range(20):
        data = edit_of(random_codes(1, step), manifest.model_id, 900)
        service.post(f"{site}/segments", content=data)
        service.get(f"{site}/changes?since=1&limit=1")
    assert len(sync._pinned) == 8
    sync.expire()
    assert len(sync._pinned) == 8
    monkeypatch.setattr("service.maps.sync.PIN_SECONDS", -1.0)
    sync.expire()
    assert not sync._pinned


def test_full_sync_comes_in_parts(service: Any, site: str, manifest: Manifest) -> None:
    delta, _, parts = pull(service, site, "0", 10)
    assert delta.is_whole
    assert parts == 5
    assert encode(delta.changed) == service.get(site).content
    other = map_of(random_codes(2), manifest.model_id, 5000)
    # A full sync replaces the robot's copy.
    assert encode(apply(other, delta)) == service.get(site).content
    assert np.all(np.diff(delta.changed.ids.astype(np.int64)) > 0)
