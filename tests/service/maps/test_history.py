"""Versions of a map: listed, served, restored and compacted."""

from pathlib import Path
from typing import Any

import pytest
from placecell_client import decode_delta, encode
from placecell_client.maps.delta_file import MEDIA_TYPE as DELTA
from placecell_client.maps.edit import apply

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes


@pytest.fixture
def files(service: Any, manifest: Manifest) -> list[bytes]:
    """Store a map `yard` with four versions; return the file of each."""
    service.put("/maps/yard", content=encode(map_of(random_codes(9), manifest.model_id)))
    files = [service.get("/maps/yard").content]
    for step in range(3):
        data = edit_of(random_codes(2, step), manifest.model_id, 106 + step)
        service.post("/maps/yard/segments", content=data)
        files.append(service.get("/maps/yard").content)
    return files


def test_every_version_is_listed_and_served(service: Any, files: list[bytes]) -> None:
    listed = service.get("/maps/yard/versions").json()
    assert (listed["map"], listed["oldest"]) == ("yard", 1)
    told = [
        [one[key] for key in ("sequence", "author", "operation", "changed", "removed")]
        for one in listed["versions"]
    ]
    assert told == [
        [4, "anyone", "edit", 2, 0],
        [3, "anyone", "edit", 2, 0],
        [2, "anyone", "edit", 2, 0],
        [1, "anyone", "put", 9, 0],
    ]
    assert all(one["time"] > 1.7e9 for one in listed["versions"])
    for sequence, file in enumerate(files, 1):
        response = service.get(f"/maps/yard?version={sequence}")
        assert response.content == file
        assert response.headers["etag"].strip('"') == listed["versions"][-sequence]["etag"]
    few = service.get("/maps/yard/versions?limit=2").json()["versions"]
    assert few == listed["versions"][:2]


@pytest.mark.slow
def test_restore_makes_a_version_that_can_be_undone(service: Any, files: list[bytes]) -> None:
    response = service.post("/maps/yard/versions/2/restore")
    assert response.status_code == 200
    assert response.json()["sequence"] == 5
    assert response.headers["etag"] == service.get("/maps/yard").headers["etag"]
    assert service.get("/maps/yard").content == files[1]
    # The repeated request changes nothing, so a client may repeat it after a lost answer.
    assert service.post("/maps/yard/versions/2/restore").json()["sequence"] == 5
    assert service.post("/maps/yard/versions/4/restore").json()["sequence"] == 6
    assert service.get("/maps/yard").content == files[3]
    for sequence, file in enumerate([*files, files[1], files[3]], 1):
        assert service.get(f"/maps/yard?version={sequence}").content == file
    assert service.get("/maps/yard/versions").json()["versions"][0]["operation"] == "restore"


def test_restore_under_an_outdated_etag_fails(service: Any, files: list[bytes]) -> None:
    stale = service.get("/maps/yard?version=3").headers["etag"]
    refused = service.post("/maps/yard/versions/1/restore", headers={"If-Match": stale})
    assert_problem(refused, 412, "precondition-failed")
    now = {"If-Match": service.get("/maps/yard").headers["etag"]}
    assert service.post("/maps/yard/versions/1/restore", headers=now).status_code == 200


@pytest.mark.parametrize("keep", [1, 2, 3, 4, 9])
def test_compaction_keeps_the_newest_versions(start: Any, manifest: Manifest, keep: int) -> None:
    with start() as service:
        service.put("/maps/yard", content=encode(map_of(random_codes(9), manifest.model_id)))
        for step in range(3):
            data = edit_of(random_codes(2, step), manifest.model_id, 106 + step)
            service.post("/maps/yard/segments", content=data)
        files = [service.get(f"/maps/yard?version={one}").content for one in range(1, 5)]
        tag = service.get("/maps/yard").headers["etag"]
        oldest = max(1, 5 - keep)
        done = service.post(f"/maps/yard/compact?keep={keep}").json()
        assert (done["oldest"], done["sequence"]) == (oldest, 4)
        assert service.get("/maps").json()["maps"][0]["bytes"] == done["bytes"]
        assert service.get("/maps/yard").headers["etag"] == tag
    with start() as service:
        for sequence, file in enumerate(files, 1):
            response = service.get(f"/maps/yard?version={sequence}")
            if sequence < oldest:
                assert_problem(
                    response, 410, "version-gone", f"The oldest available version is {oldest}"
                )
                refused = service.post(f"/maps/yard/versions/{sequence}/restore")
                assert_problem(refused, 410, "version-gone")
            else:
                assert response.content == file
        listed = service.get("/maps/yard/versions").json()
        assert listed["oldest"] == oldest
        assert [one["sequence"] for one in listed["versions"]] == list(range(4, oldest - 1, -1))
        assert service.get("/maps/yard").headers["etag"] == tag
        # Later writes continue from there.
        data = edit_of(random_codes(2, 9), manifest.model_id, 500)
        assert service.post("/maps/yard/segments", content=data).json()["sequence"] == 5
        again = service.post(f"/maps/yard/compact?keep={keep + 1}").json()
        assert again["oldest"] == oldest


@pytest.mark.parametrize(
    ("method", "path", "status", "kind"),
    [
        ("GET", "/maps/yard?version=5", 404, "unknown-version"),
        ("GET", "/maps/yard?version=0", 422, "invalid-request"),
        ("GET", "/maps/yard?version=x", 422, "invalid-request"),
        ("GET", "/maps/yard?version=99999999999999999999", 422, "invalid-request"),
        ("GET", "/maps/other?version=1", 404, "unknown-map"),
        ("GET", "/maps/other/versions", 404, "unknown-map"),
        ("GET", "/maps/yard/versions?limit=0", 422, "invalid-request"),
        ("POST", "/maps/yard/versions/5/restore", 404, "unknown-version"),
        ("POST", "/maps/yard/versions/0/restore", 422, "invalid-request"),
        ("POST", "/maps/yard/versions/x/restore", 422, "invalid-request"),
        ("POST", "/maps/other/versions/1/restore", 404, "unknown-map"),
        ("POST", "/maps/other/compact", 404, "unknown-map"),
        ("POST", "/maps/yard/compact?keep=0", 422, "invalid-request"),
        ("PUT", "/maps/yard/versions", 405, "method-not-allowed"),
    ],
)
def test_invalid_version_requests_are_refused(
    service: Any, files: list[bytes], method: str, path: str, status: int, kind: str
) -> None:
    assert_problem(service.request(method, path), status, kind)
    assert service.get("/maps/yard").content == files[-1]


@pytest.mark.slow
def test_clock_jump_changes_only_displayed_times(
    start: Any, manifest: Manifest, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    times = iter([5e9, 1.0, 2e9])
    with start() as service:
        monkeypatch.setattr(service.app.state.placecell.engine.maps, "_clock", lambda: next(times))
        service.put("/maps/yard", content=encode(map_of(random_codes(2), manifest.model_id)))
        for step in range(2):
            data = edit_of(random_codes(1, step), manifest.model_id, 500)
            service.post("/maps/yard/segments", content=data)
    with start() as service:
        listed = service.get("/maps/yard/versions").json()["versions"]
        assert [(one["sequence"], one["time"]) for one in listed] == [(3, 2e9), (2, 1.0), (1, 5e9)]


def test_changes_of_each_version_lead_from_the_one_before(service: Any, files: list[bytes]) -> None:
    content = None
    for sequence, file in enumerate(files, 1):
        answer = service.get(f"/maps/yard/versions/{sequence}/changes")
        assert answer.status_code == 200
        assert answer.headers["content-type"] == DELTA
        version = service.get(f"/maps/yard?version={sequence}")
        assert answer.headers["etag"] == version.headers["etag"]
        delta = decode_delta(answer.content)
        assert (delta.since, delta.until) == (sequence - 1, sequence)
        content = delta.changed if content is None else apply(content, delta)
        assert encode(content) == file
        known = {"If-None-Match": answer.headers["etag"]}
        again = service.get(f"/maps/yard/versions/{sequence}/changes", headers=known)
        assert (again.status_code, again.content) == (304, b"")
        part = service.get(
            f"/maps/yard/versions/{sequence}/changes", headers={"Range": "bytes=0-7"}
        )
        assert (part.status_code, part.content) == (206, answer.content[:8])


def test_changes_of_a_compacted_version_are_gone(service: Any, files: list[bytes]) -> None:
    assert len(files) == 4
    service.post("/maps/yard/compact?keep=2")
    for sequence in (1, 2, 3):
        gone = service.get(f"/maps/yard/versions/{sequence}/changes")
        assert_problem(gone, 410, "version-gone", f"ersion {sequence} of map 'yard'")
    assert service.get("/maps/yard/versions/4/changes").status_code == 200
    assert_problem(service.get("/maps/yard/versions/5/changes"), 404, "unknown-version")
    assert_problem(service.get("/maps/yard/versions/0/changes"), 422, "invalid-request")
    assert_problem(service.get("/maps/other/versions/1/changes"), 404, "unknown-map")


def test_dry_run_of_a_restore_counts_what_it_would_change(service: Any, files: list[bytes]) -> None:
    before = service.get("/maps/yard").headers["etag"]
    dry = service.post("/maps/yard/versions/1/restore?dry_run=true")
    assert dry.status_code == 200
    assert dry.headers["etag"] == before == service.get("/maps/yard").headers["etag"]
    assert service.get("/maps/yard").content == files[3]
    done = service.post("/maps/yard/versions/1/restore").json()
    counts = ("changed", "removed")
    assert [dry.json()[key] for key in counts] == [done[key] for key in counts]
    assert sum(done[key] for key in counts) > 0
    none = service.post("/maps/yard/versions/1/restore?dry_run=true").json()
    assert [none[key] for key in counts] == [0, 0]
    assert_problem(
        service.post("/maps/yard/versions/9/restore?dry_run=true"), 404, "unknown-version"
    )
