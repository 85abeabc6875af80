"""Generated pages are as the code is, and hand-written lists are complete."""

import ast
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from prometheus_client import generate_latest

from cli.reference.pages import FOLDER, PAGES, generate
from cli.reference.routes import openapi
from service.core.metrics import Metrics
from service.core.settings import OTHER_NAMES, Limits, Settings, variables

ROOT = Path(__file__).parents[2]

ROW = re.compile(r"^\| (`[a-z`, -]+`) \| ([0-9, ]*)", re.MULTILINE)
HTTP_PHRASES = {"bad-request", "not-found", "method-not-allowed"}
"""Kinds that the framework's own errors get from their status."""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_generated_pages_are_current(page: Path) -> None:
    before, after = generate(page)
    assert before == after, f"{page.name} is not current: run `make reference`"


def documented_kinds() -> dict[str, set[int]]:
    """Return the kinds of problems on the page, each with its statuses."""
    text = (FOLDER / "errors.md").read_text(encoding="utf-8")
    found: dict[str, set[int]] = {}
    for kinds, statuses in ROW.findall(text):
        for kind in re.findall(r"`([a-z-]+)`", kinds):
            found.setdefault(kind, set()).update(map(int, re.findall(r"\d{3}", statuses)))
    return found


def raised_kinds() -> Iterator[tuple[int, str]]:
    """Yield the status and the kind of each problem that the service's code raises."""
    for file in (ROOT / "service").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            match node:
                case ast.Call(args=[ast.Constant(int(status)), kind, *_]) if 400 <= status < 600:
                    yield from ((status, each) for each in kinds_of(kind))


def kinds_of(node: ast.expr) -> Iterator[str]:
    """Yield a kind that is a literal; of an f-string, a pattern."""
    match node:
        case ast.Constant(str(kind)):
            yield kind
        case ast.JoinedStr(parts):
            yield "".join(
                str(part.value) if isinstance(part, ast.Constant) else "[a-z]+" for part in parts
            )


def test_every_problem_of_the_service_is_documented() -> None:
    documented = documented_kinds()
    for status, kind in raised_kinds():
        found = [each for each in documented if re.fullmatch(kind, each)]
        assert found, f"errors.md lacks {kind} ({status})"
        assert any(status in documented[each] for each in found), f"errors.md: {kind} is a {status}"


def test_no_documented_problem_is_unknown_to_the_code() -> None:
    files = [*(ROOT / "service").rglob("*.py"), *(ROOT / "client").rglob("*.py")]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    patterns = [kind for _, kind in raised_kinds() if "[" in kind]
    for kind in documented_kinds().keys() - HTTP_PHRASES:
        made = any(re.fullmatch(pattern, kind) for pattern in patterns)
        assert made or re.search(rf'["\':]{kind}["\']', text), f"errors.md: {kind} is never raised"


def named_in_docs(pattern: str) -> set[str]:
    """Return what the documents name, by a pattern with one group."""
    files = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), ROOT / "deploy" / "README.md"]
    return {
        name for file in files for name in re.findall(pattern, file.read_text(encoding="utf-8"))
    }


def test_settings_that_the_documents_name_exist() -> None:
    known = {*variables(Settings), *OTHER_NAMES, "PLACECELL_KEYS"}  # the last is of compose.yaml
    assert named_in_docs(r"\b(PLACECELL_[A-Z_]*[A-Z])\b") <= known
    assert named_in_docs(r"\blimits\.([a-z_]+)") - {"md"} <= Limits.model_fields.keys()


def test_metrics_that_the_documents_name_exist() -> None:
    shown = generate_latest(Metrics().registry).decode()
    names = named_in_docs(r"\b(placecell_(?!client|example|ros\b)[a-z_]+)\b")
    missing = {name for name in names if not re.search(rf"^# HELP {name}\b", shown, re.MULTILINE)}
    assert not missing


OBJECT = re.compile(r"^::: ([\w.]+)\n(?:    options:\n((?:      .*\n)+))?", re.MULTILINE)


@pytest.mark.parametrize("page", ["library.md", "python-client.md"])
def test_objects_that_the_site_shows_exist(page: str) -> None:
    # The site leaves out what a list of members names and the module lacks.
    found = OBJECT.findall((FOLDER / page).read_text(encoding="utf-8"))
    assert found
    for name, options in found:
        shown = pkgutil.resolve_name(name)
        members = re.search(r"members: \[(.+)\]", options)
        for member in re.split(", *", members[1]) if members else []:
            assert hasattr(shown, member), f"{page}: {name} has no {member}"


def test_keys_of_the_msgpack_page_are_those_of_the_schemas() -> None:
    text = (FOLDER / "msgpack.md").read_text(encoding="utf-8")
    tables = text[text.index("## Requests") : text.index("## Example")]
    cells = re.findall(r"^\| (`[a-z_`, \[\].]+`) \|", tables, re.MULTILINE)
    named = {key for row in cells for key in re.findall(r"`(?:\w+\[\]\.)?(\w+)`", row)}
    schemas = openapi()["components"]["schemas"].values()
    known = {key for schema in schemas for key in schema.get("properties", {})}
    assert {"codes", "localizations", "inliers"} <= named <= known
