"""The pages against the code: the ways of requests, dependencies, named files, lengths."""

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from tests.service.conftest import manifest, models_dir, start
from tests.service.request_tracing import end_at_commit, trace_of_search, traced
from tests.service.service_builders import map_of, random_codes

__all__ = ["manifest", "models_dir", "start"]

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "explanation" / "architecture.md"
MATCH, UPLOAD = "A `/match`, step by step", "An upload, step by step"
LONGEST = {MATCH: 15, UPLOAD: 14}
"""Largest number of files of a way."""


@pytest.fixture
def data_dir(tmp_path: Path) -> Path:
    return tmp_path / "var"


def section(title: str) -> str:
    """Return the text of one section of the page."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found is not None, f"no section {title!r}"
    return found[1]


def files_of(title: str) -> list[str]:
    """Return the files that the numbered steps of a section name, in order."""
    steps = re.findall(r"^\d+\. (.+?)(?=^\d+\. |^$|\Z)", section(title), re.MULTILINE | re.DOTALL)
    assert steps, f"no numbered steps in {title!r}"
    return [file for step in steps for file in re.findall(r"`([\w/]+\.py)`", step)]


def exists(file: str) -> bool:
    return (ROOT / file).is_file() or (ROOT / "client" / file).is_file()


@pytest.mark.parametrize("title", [MATCH, UPLOAD])
def test_way_is_short_and_its_files_exist(title: str) -> None:
    files = files_of(title)
    assert len(files) == len(set(files)) <= LONGEST[title]
    assert f" {len(files)} files" in section(title)
    assert all(exists(file) for file in files)


def test_steps_of_a_match_are_those_of_a_traced_request(
    start: Callable[..., Any], models_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trace = trace_of_search(start, models_dir, monkeypatch, "match")
    assert sorted(files_of(MATCH)) == sorted(trace.passed)


def test_steps_of_an_upload_are_those_of_a_traced_request(
    start: Callable[..., Any], manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    with traced(("service/api/routes/maps.py", "put_map")) as trace:
        end_at_commit(trace, monkeypatch)
        with start() as service:
            yard = encode(map_of(random_codes(20), manifest.model_id))
            assert service.put("/maps/yard", content=yard).status_code == 201
    assert trace.has_ended
    assert sorted(files_of(UPLOAD)) == sorted(trace.passed)


def dependencies() -> set[str]:
    """Return the names of all direct dependencies of both distributions."""
    names = set()
    for file in (ROOT / "pyproject.toml", ROOT / "client" / "pyproject.toml"):
        declared = tomllib.loads(file.read_text(encoding="utf-8"))
        project = declared["project"]
        groups = [project["dependencies"], *project.get("optional-dependencies", {}).values()]
        groups.append(declared["build-system"]["requires"])
        for requirement in (one for group in groups for one in group):
            names.add(re.match(r"[\w.-]+", requirement)[0].lower())  # type: ignore[index]
    return names - {"placecell"}


def test_every_dependency_has_a_reason() -> None:
    rows = re.findall(r"^\| ([\w, .-]+) \| (.+) \|$", section("Dependencies"), re.MULTILINE)
    reasons = {name.strip().lower(): why for names, why in rows[1:] for name in names.split(",")}
    assert not dependencies() - set(reasons)
    assert all(len(why.split()) > 2 for why in reasons.values())


def words_of(file: Path) -> int:
    return len(file.read_text(encoding="utf-8").split())


def test_readme_is_read_in_a_minute() -> None:
    assert words_of(ROOT / "README.md") <= 600


@pytest.mark.parametrize(
    "file", sorted((ROOT / "docs" / "decisions").glob("0*.md")), ids=lambda file: file.stem
)
def test_decision_record_is_short(file: Path) -> None:
    titles = re.findall(r"^## (.+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    assert titles == ["Context", "Decision", "Consequences"]
    assert words_of(file) <= 300


PATHS = sorted(
    (file.relative_to(ROOT).as_posix(), path)
    for folder in ("explanation", "decisions", "results")
    for file in (ROOT / "docs" / folder).glob("*.md")
    for path in set(re.findall(r"`((?:\w+/)+\w+\.py)`", file.read_text(encoding="utf-8")))
)


@pytest.mark.parametrize(("file", "path"), PATHS)
def test_named_files_exist(file: str, path: str) -> None:
    assert exists(path), file
