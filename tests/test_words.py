"""The words: openings of texts that the style bans, and spelling."""

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

import cli
from service.app import create_app
from service.core.settings import Limits, Settings
from tests.test_layout import ROOT, sources, tree_of

RIDDLE = re.compile(r"(Of|What|Whoever|Who|Whose|See that)\b")
"""Openings that make a reader wait for the subject of the sentence."""

TEXTS = {"help", "short_help", "epilog", "description", "summary", "detail", "title"}
"""Keyword arguments that users read."""

BRITISH = re.compile(
    r"(?<![\"'`\w-])(?:--)?\b\w*("
    r"metre|localis|normalis|quantis|recognis|optimis(?!tic)|initialis|serialis|summaris|minimis"
    r"|maximis|regularis|voxelis|generalis|organis|realis(e|ed|ing|ation)\b|neighbour|colour"
    r"|behaviour|centre|judgement|catalogue|licence|analys(e|ed|ing)\b"
    r")\w*",
    re.IGNORECASE,
)
"""Words in British spelling. A word in quotes is exempt: such keys stay in users' files."""


def tracked(*patterns: str) -> list[Path]:
    """Return the files of the repository that match."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", *patterns], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [ROOT / name for name in listed.stdout.split("\0") if name]


def place(file: Path, node: ast.AST) -> str:
    return f"{file.relative_to(ROOT).as_posix()}:{getattr(node, 'lineno', 1)}"


def docstrings(file: Path) -> Iterator[tuple[str, str]]:
    """Yield place and text of each docstring of a file."""
    for node in ast.walk(tree_of(file)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text = ast.get_docstring(node)
            if text:
                yield place(file, node), text


def opening(node: ast.expr) -> str | None:
    """Return the first words of a string or of an f-string that begins with words."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr) and node.values:
        return opening(node.values[0])
    return None


def messages(file: Path) -> Iterator[tuple[str, str]]:
    """Yield place and text of each help text, description and error of a file."""
    for node in ast.walk(tree_of(file)):
        found: list[ast.expr] = []
        if isinstance(node, ast.Call):
            found += [each.value for each in node.keywords if each.arg in TEXTS]
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            found += node.exc.args
        for each in found:
            text = opening(each)
            if text:
                yield place(file, each), text


def test_no_docstring_opens_with_a_riddle() -> None:
    found = [
        f"{where}: {text.splitlines()[0]}"
        for file in tracked("*.py")
        for where, text in docstrings(file)
        if RIDDLE.match(text)
    ]
    assert found == []


def test_no_help_text_or_error_opens_with_a_riddle() -> None:
    found = [
        f"{where}: {text}"
        for file in sources().values()
        for where, text in messages(file)
        if RIDDLE.match(text)
    ]
    assert found == []


def commands(command: Any, path: str) -> Iterator[tuple[str, str]]:
    """Yield each help text of a command, its options and its subcommands."""
    yield path, command.help or ""
    for parameter in command.params:
        help_text = getattr(parameter, "help", None)
        if not getattr(parameter, "hidden", False):
            yield f"{path} {parameter.name}", help_text or ""
    for name, below in getattr(command, "commands", {}).items():
        if not below.hidden:
            yield from commands(below, f"{path} {name}")


def test_every_command_and_option_has_a_help_text_that_opens_plainly() -> None:
    texts = list(commands(typer.main.get_command(cli.app), "placecell"))
    assert [where for where, text in texts if not text.strip()] == []
    assert [f"{where}: {text}" for where, text in texts if RIDDLE.match(text.strip())] == []


def descriptions(part: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield each description and summary of an OpenAPI document."""
    if isinstance(part, dict):
        for key, value in part.items():
            if key in {"description", "summary"} and isinstance(value, str):
                yield path, value
            else:
                yield from descriptions(value, f"{path}/{key}")
    elif isinstance(part, list):
        for index, value in enumerate(part):
            yield from descriptions(value, f"{path}/{index}")


def test_no_description_of_the_api_opens_with_a_riddle(tmp_path: Path) -> None:
    document = create_app(Settings(data_dir=tmp_path)).openapi()
    found = [f"{path}: {text}" for path, text in descriptions(document) if RIDDLE.match(text)]
    assert found == []


@pytest.mark.parametrize("kind", [Settings, Limits])
def test_every_setting_says_what_it_is(kind: type[Settings] | type[Limits]) -> None:
    for name, field in kind.model_fields.items():
        assert field.description, name
        assert not RIDDLE.match(field.description), name


def test_spelling_is_american() -> None:
    found = set()
    for file in tracked("*.py", "*.md", "*.toml", "*.yml", "*.yaml", "Makefile"):
        if file in {Path(__file__), ROOT / "CHANGELOG.md"} or ROOT / "models" in file.parents:
            continue  # the changelog names old spellings; cards quote how a model was made
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            for word in BRITISH.finditer(line):
                found.add(f"{file.relative_to(ROOT).as_posix()}:{number}: {word[0]}")
    assert sorted(found) == []
