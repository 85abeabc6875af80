"""Marks of mirrors: they refuse all writes but those of the program that copies the map."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

SOURCE = "https://hq.example/maps/yard"
OWN = {"Placecell-Mirror": SOURCE}


@pytest.fixture
def mirror(service: Any, manifest: Manifest) -> Any:
    """A service with an empty map that is marked as a mirror."""
    empty = encode(map_of(random_codes(0), manifest.model_id))
    assert service.put("/maps/yard", content=empty).status_code == 201
    assert service.put("/maps/yard/mirror", json={"source": SOURCE}).status_code == 200
    return service


def detail(service: Any) -> Any:
    return service.get("/maps/yard", headers={"Accept": "application/json"}).json()


def test_mirror_takes_writes_of_its_copier_only(mirror: Any, manifest: Manifest) -> None:
    content = encode(map_of(random_codes(9), manifest.model_id))
    edit = edit_of(random_codes(2), manifest.model_id)
    replace = {"If-Match": "*"}
    for method, path, body in (
        ("PUT", "/maps/yard", content),
        ("POST", "/maps/yard/segments", edit),
        ("POST", "/maps/yard/ids?count=1", b""),
        ("POST", "/maps/yard/compact", b""),
        ("POST", "/maps/yard/age?unseen_since=1", b""),
        ("PUT", "/maps/yard/tags", b'{"tags": []}'),
        ("DELETE", "/maps/yard", b""),
        ("PUT", "/maps/yard/mirror", b'{"source": "http://other/maps/yard"}'),
    ):
        for headers in ({}, {"Placecell-Mirror": "http://other/maps/yard"}):
            refused = mirror.request(method, path, content=body, headers=replace | headers)
            assert_problem(refused, 409, "mirrored-map", f"mirror of {SOURCE}")
    assert mirror.put("/maps/yard", content=content, headers=replace | OWN).status_code == 200
    mark = {"source": SOURCE, "etag": "0123456789abcdef-7"}
    marked = mirror.put("/maps/yard/mirror", json=mark, headers=OWN).json()
    assert marked.items() >= mark.items()
    assert detail(mirror)["mirror"] == marked
    assert mirror.get("/maps/yard").status_code == 200


def test_ended_mirror_takes_writes(mirror: Any, manifest: Manifest) -> None:
    assert mirror.delete("/maps/yard/mirror").status_code == 204
    assert detail(mirror)["mirror"] is None
    edit = edit_of(random_codes(2), manifest.model_id)
    assert mirror.post("/maps/yard/segments", content=edit).status_code == 200
    assert_problem(mirror.delete("/maps/yard/mirror"), 404, "not-a-mirror")
    refused = mirror.put("/maps/yard/mirror", json={"source": SOURCE})
    assert_problem(refused, 409, "not-a-mirror", "2 segments")


@pytest.mark.parametrize(
    "body",
    [
        {"source": "ftp://hq/maps/yard"},
        {"source": "http://ann:secret@hq/maps/yard"},
        {"source": SOURCE, "etag": "7"},
        {},
    ],
)
def test_invalid_marks_are_refused(mirror: Any, body: dict[str, str]) -> None:
    refused = mirror.put("/maps/yard/mirror", json=body, headers=OWN)
    assert refused.status_code == 422


def test_mark_survives_a_restart_and_needs_a_key_of_all_robots(
    start: Callable[..., Any], tmp_path: Path, manifest: Manifest
) -> None:
    file = tmp_path / "keys.toml"
    fleet, ann = (
        made(file, "fleet", "--write"),
        made(file, "ann", "--write", "--robot", "ann"),
    )
    empty = encode(map_of(random_codes(0), manifest.model_id))
    with start(keys_file=file) as service:
        assert service.put("/maps/yard", content=empty, headers=fleet).status_code == 201
        refused = service.put("/maps/yard/mirror", json={"source": SOURCE}, headers=ann)
        assert refused.status_code == 403
        marked = service.put("/maps/yard/mirror", json={"source": SOURCE}, headers=fleet)
        assert marked.status_code == 200
    with start(keys_file=file) as service:
        refused = service.delete("/maps/yard", headers=fleet)
        assert_problem(refused, 409, "mirrored-map")
        assert service.delete("/maps/yard/mirror", headers=ann).status_code == 403
        assert service.delete("/maps/yard/mirror", headers=fleet).status_code == 204


def test_every_write_of_a_map_documents_the_refusal_of_a_mirror(service: Any) -> None:
    paths = service.get("/openapi.json").json()["paths"]
    ends = ("delete", "/maps/{map}/mirror")  # the end of a mirror is never refused
    missing = [
        f"{method} {path}"
        for path, methods in paths.items()
        for method, route in methods.items()
        if path.startswith("/maps/{map}") and method != "get" and (method, path) != ends
        if "409" not in route["responses"]
    ]
    assert missing == []
