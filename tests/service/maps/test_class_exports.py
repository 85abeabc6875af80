"""Filters by class in downloads and exports, over HTTP, the client and the commands."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, decode, encode
from typer.testing import CliRunner

from cli import app
from placecell.core.segment_classes import CLASSES, encoded
from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, map_of, random_codes

NAMES = ["building", "vehicle", None, "person", "pole", "vehicle"] * 4


@pytest.fixture
def stored(manifest: Manifest) -> CompactMap:
    indices = [-1 if name is None else CLASSES.index(name) for name in NAMES]
    content = map_of(random_codes(len(NAMES)), manifest.model_id)
    return replace(content, classes=encoded(indices, np.full(len(NAMES), 0.8)))


@pytest.fixture
def yard(service: Any, stored: CompactMap) -> Any:
    assert service.put("/maps/yard", content=encode(stored)).status_code == 201
    return service


def rows_of(stored: CompactMap, *names: str | None) -> list[int]:
    ids = stored.ids.tolist()
    return [row for row, name in zip(ids, NAMES, strict=True) if name in names]


@pytest.mark.parametrize(
    ("query", "kept"),
    [
        ("ignore=movable", ("building", "pole", None)),
        ("ignore=vehicle&ignore=pole", ("building", "person", None)),
        ("classes=pole&classes=building", ("pole", "building")),
        ("classes=vehicle&ignore=movable", ()),
    ],
)
def test_download_has_the_wanted_segments_only(
    yard: Any, stored: CompactMap, query: str, kept: tuple[str | None, ...]
) -> None:
    for way in (f"/maps/yard?{query}", f"/maps/yard?version=1&{query}"):
        answer = yard.get(way)
        assert answer.status_code == 200, answer.text
        assert decode(answer.content).ids.tolist() == rows_of(stored, *kept)


def test_filtered_download_has_a_tag_that_does_not_replace_the_map(yard: Any) -> None:
    whole = yard.get("/maps/yard")
    part = yard.get("/maps/yard?ignore=movable")
    assert part.headers["etag"] != whole.headers["etag"]
    known = {"If-None-Match": part.headers["etag"]}
    assert yard.get("/maps/yard?ignore=movable", headers=known).status_code == 304
    assert yard.get("/maps/yard?ignore=person", headers=known).status_code == 200
    assert yard.get("/maps/yard", headers=known).status_code == 200
    replaced = yard.put(
        "/maps/yard", content=part.content, headers={"If-Match": part.headers["etag"]}
    )
    assert replaced.status_code == 412
    ranged = yard.get("/maps/yard?ignore=movable", headers={"Range": "bytes=0-9"})
    assert (ranged.status_code, ranged.content) == (206, part.content[:10])


def test_class_that_is_none_is_refused_and_named(yard: Any) -> None:
    for way in ("/maps/yard?classes=car", "/maps/yard/export?to=ply&ignore=car"):
        assert_problem(yard.get(way), 422, "invalid-request", "vegetation")


def test_export_over_http_is_the_file_of_the_command(
    yard: Any, stored: CompactMap, tmp_path: Path
) -> None:
    source, file = tmp_path / "yard.map", tmp_path / "out.ply"
    source.write_bytes(encode(stored))
    words = ["export", source, "--to", "ply", "--ignore", "movable", "-o", file]
    done = CliRunner().invoke(app, [str(word) for word in words])
    assert done.exit_code == 0, done.output
    assert b"element vertex 12\n" in file.read_bytes()
    answer = yard.get("/maps/yard/export?to=ply&ignore=movable")
    assert answer.content == file.read_bytes()
    assert answer.headers["etag"] != yard.get("/maps/yard/export?to=ply").headers["etag"]


def test_captures_stay_in_an_export_of_poses(yard: Any) -> None:
    whole = yard.get("/maps/yard/export?to=tum").content
    assert yard.get("/maps/yard/export?to=tum&classes=sign").content == whole


def test_command_refuses_what_it_cannot_filter(stored: CompactMap, tmp_path: Path) -> None:
    plain, file = tmp_path / "plain.map", tmp_path / "out.ply"
    plain.write_bytes(encode(replace(stored, classes=None)))
    for words, message in (
        (["--ignore", "movable"], "has no classes"),
        (["--classes", "car"], "Invalid class 'car'"),
    ):
        command = ["export", str(plain), "--to", "ply", "-o", str(file), *words]
        done = CliRunner().invoke(app, command)
        assert done.exit_code == 1
        assert message in done.output
        assert not file.exists()
