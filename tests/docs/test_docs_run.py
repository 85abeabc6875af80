"""B8: every command and snippet of the documents is run, parsed, or marked with a reason.

A block that cannot be run here has a comment above it: `<!-- not run: needs Docker -->`. Commands
of `placecell` that take long are parsed: the command and its options exist and take these values.
The scripts of the tutorials run in `test_tutorials.py`, the examples of the HTTP API in
`test_http_api.py`.
"""

import asyncio
import json
import re
import shlex
import subprocess
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import placecell_client
import pytest
import typer
from placecell_client import Client, CompactMap, Delta, encode, encode_delta
from placecell_client.maps.edit import take

from benchmarks.synthetic_maps.road_map import road_map
from cli import app
from placecell.datasets import KittiOdometry
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.child_process import running_service
from tests.docs import http_examples
from tests.placecell.segment_builders import pose, write_odometry
from town import ODOMETRY_FILE

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted(
    {
        ROOT / "README.md",
        ROOT / "CONTRIBUTING.md",
        *(ROOT / "docs").rglob("*.md"),
        ROOT / "client" / "README.md",
        ROOT / "deploy" / "README.md",
        ROOT / "examples" / "cpp" / "README.md",
        ROOT / "ros" / "placecell_ros" / "README.md",
    }
)
LOCAL = "http://127.0.0.1:8000"

HELD_ELSEWHERE = {
    "mermaid": "a picture",
    "cpp": "checked in tests/client/test_map_file_document.py and test_msgpack_document.py",
    "map": "compared in tests/client/test_map_file_document.py",
    "delta": "compared in tests/client/test_map_file_document.py",
    "moved": "compared in tests/client/test_map_file_document.py",
    "request": "compared in tests/client/test_msgpack_document.py",
    "answer": "compared in tests/client/test_msgpack_document.py",
    "text": "no command",
}

FIGURES = {"FIRST:LAST": "0:9", "N": "2", "HOST": "127.0.0.1", "SECONDS": "5"}
"""Values for the placeholders of commands that are parsed."""


@dataclass(frozen=True)
class Block:
    file: Path
    line: int
    kind: str
    text: str
    reason: str

    def __str__(self) -> str:
        return f"{self.file.relative_to(ROOT)}:{self.line}"


def blocks_of(file: Path) -> Iterator[Block]:
    """Fenced blocks, and commands that are indented by four after an empty line."""
    lines = file.read_text(encoding="utf-8").splitlines()
    at, reason = 0, ""
    while at < len(lines):
        line = lines[at]
        if mark := re.match(r"<!-- not run: (.+) -->", line.strip()):
            reason = mark[1]
        elif fence := re.match(r" *```(\w*)( title=)?", line):
            first, at = at + 1, at + 1
            while not lines[at].strip().startswith("```"):
                at += 1
            text = "\n".join(lines[first:at]) + "\n"
            if fence[2]:
                reason = "a file of a tutorial"
            yield Block(file, first, fence[1] or "sh", textwrap.dedent(text), reason)
            reason = ""
        elif line.startswith("    ") and not lines[at - 1].strip() and not in_list(lines, at):
            first = at
            while at < len(lines) and lines[at].startswith("    "):
                at += 1
            text = "\n".join(part[4:] for part in lines[first:at]) + "\n"
            yield Block(file, first + 1, "sh", text, reason)
            reason = ""
        elif line.strip():
            reason = ""
        at += 1


def in_list(lines: list[str], at: int) -> bool:
    """Return whether an indented line continues a list item."""
    before = [line for line in lines[:at] if line.strip()]
    while before and before[-1].startswith(" "):
        before.pop()
    return bool(before) and re.match(r"([-*]|\d+\.) ", before[-1]) is not None


BLOCKS = [block for file in DOCUMENTS for block in blocks_of(file)]
SHELL = [block for block in BLOCKS if block.kind in {"sh", "bash", "console"} and not block.reason]
MARKED = [block for block in BLOCKS if block.kind in {"sh", "bash", "console"} and block.reason]
PYTHON = [block for block in BLOCKS if block.kind == "python" and not block.reason]
SPANS = sorted(
    {
        (file.relative_to(ROOT).as_posix(), span)
        for file in DOCUMENTS
        for span in re.findall(r"`(placecell [^`]+)`", file.read_text(encoding="utf-8"))
    }
)


def commands_of(block: Block) -> Iterator[str]:
    """Commands, a line each, without comments."""
    text = re.sub(r"\\\n\s*", " ", block.text)
    for line in text.splitlines():
        words = line.removeprefix("$ ").strip()
        if words and not words.startswith("#"):
            yield words


@cache
def command_line() -> Any:
    """Return the command line; a command of it may be parsed many times."""
    return typer.main.get_command(app)


def check_placecell(words: list[str]) -> None:
    """Parse a command of `placecell` without running it."""
    command: Any = command_line()
    context = command.make_context("placecell", ["--help"], resilient_parsing=True)
    while hasattr(command, "commands"):
        name = words.pop(0) if words else ""
        assert name in command.commands, f"no command {name!r}"
        command = command.commands[name]
    words = [FIGURES.get(word, word) for word in words]
    command.make_context(command.name, words, parent=context)


def plain(text: str) -> list[str]:
    """Words of a command; what is optional is taken, what may be repeated is given once."""
    return shlex.split(re.sub(r"[\[\]]|\.\.\.(?!/)", " ", text), comments=True)


@pytest.mark.parametrize("block", BLOCKS, ids=str)
def test_B8_every_block_is_run_or_marked(block: Block) -> None:
    known = {"sh", "bash", "console", "python", "toml", "json", *HELD_ELSEWHERE}
    assert block.reason or block.kind in known, f"{block}: say how a {block.kind} block is checked"


@pytest.mark.parametrize("block", SHELL, ids=str)
def test_B8_commands_exist_with_their_options(block: Block) -> None:
    if block.file == http_examples.PAGE:
        return
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for line in commands_of(block):
        words = plain(line)
        if words[0] == "placecell":
            if words[1] == "train" and "..." in line:
                words.insert(3, "DRIVE")
            check_placecell(words[1:])
        elif words[0] == "make":
            assert set(words[1:]) <= set(targets)
        else:
            assert words[0] == "curl", f"{block}: {line!r} is neither run nor marked as not run"


@pytest.mark.parametrize("block", MARKED, ids=str)
def test_B8_commands_that_are_not_run_exist_too(block: Block) -> None:
    if block.reason.startswith("tests/docs/test_fleet.py runs"):
        return
    for line in commands_of(block):
        if line.startswith("placecell "):
            check_placecell(plain(line.split("&&")[0])[1:])


@pytest.mark.parametrize(("file", "span"), SPANS)
def test_B8_commands_in_sentences_exist(file: str, span: str) -> None:
    words = plain(span)[1:]
    command: Any = command_line()
    while words and hasattr(command, "commands"):
        assert words[0] in command.commands, f"{file}: `{span}`"
        command = command.commands[words.pop(0)]
    options = {option for each in command.params for option in (*each.opts, *each.secondary_opts)}
    named = {word.partition("=")[0] for word in words if word.startswith("--")}
    assert named <= options | {"--help"}, f"{file}: `{span}`"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with running_service(tmp_path_factory.mktemp("data")) as address:
        yield address


def made(robot: str, count: int = 300, first: int = 0, seed: int = 0) -> CompactMap:
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    codes = np.random.default_rng(seed).integers(-128, 128, (count, manifest.code_bytes))
    content = road_map(codes.astype(np.int8), manifest, robot)
    return replace(content, ids=content.ids + np.uint32(first))


CURLS = [
    block
    for block in SHELL
    if block.file != http_examples.PAGE
    and any(line.startswith("curl") for line in commands_of(block))
]


@pytest.mark.parametrize("block", CURLS, ids=str)
def test_B8_curl_commands_are_answered(block: Block, address: str, tmp_path: Path) -> None:
    first = made("ann")
    (tmp_path / "yard.map").write_bytes(encode(first))
    (tmp_path / "newer.map").write_bytes(encode(made("ann", seed=1)))
    delta = Delta(take(first, np.arange(5)), np.array([9], np.uint32))
    (tmp_path / "edit.delta").write_bytes(encode_delta(delta))
    points = np.random.default_rng(0).normal(size=(200, 3)) + [12, 0, 0]
    scan = {"segments": [{"points": points.tolist(), "sensor": [0.0, 0.0, 1.8]}]}
    (tmp_path / "scan.json").write_text(json.dumps(scan))
    with Client(address) as client:
        client.put_map("hall", made("bob", seed=2))
        for line in commands_of(block):
            if "/maps/yard" in line and "PUT" not in line:
                newest = client.versions("yard", 1)[0].sequence
                while newest < 3:
                    newest = client.restore_map("yard", 1).sequence
            etag = next((each.etag for each in client.maps() if each.name == "yard"), "")
            words = [
                word.replace(LOCAL, address).replace("ETAG", etag.strip('"'))
                for word in shlex.split(line, comments=True)
            ]
            done = subprocess.run(
                [*words, "--silent", "--show-error", "--fail-with-body"],
                cwd=tmp_path,
                capture_output=True,
                text=True,
                timeout=30,
                check=False,
            )
            # Random maps are not alike: to say so is the answer that is due.
            assert done.returncode == 0 or "not-aligned" in done.stdout, (line, done.stdout)


def given(address: str, tmp_path: Path) -> dict[str, Any]:
    """Return the names that the snippets take for granted."""
    random = np.random.default_rng(0)
    clouds = [random.normal(size=(200, 3)) + [12, 5 * n, 0] for n in range(6)]
    old, new = made("ann"), take(made("ann"), np.arange(2, 300))
    drive = write_odometry(tmp_path / "drive", [clouds[0]] * 3, [pose(x) for x in range(3)])
    (drive / ODOMETRY_FILE).write_bytes((drive / "poses.txt").read_bytes())
    first = Delta(take(old, np.arange(3)), np.zeros(0, np.uint32))
    names = {name: getattr(placecell_client, name) for name in placecell_client.__all__}
    return names | {
        "np": np,
        "asyncio": asyncio,
        "clouds": clouds,
        "folder": drive,
        "KittiOdometry": KittiOdometry,
        "ODOMETRY_FILE": ODOMETRY_FILE,
        "first": first,
        "second": Delta(take(old, np.arange(2)), np.array([9], np.uint32)),
        "parts": [first],
        "key": None,
        "address": address,
        "segments": clouds,
        "sensors": [0.0, 0.0, 1.8],
        "time": 1.7e9,
        "position": [0.0, 0.0, 1.8],
        "quaternion": [0.0, 0.0, 0.0, 1.0],
        "first_map": old,
        "seen": made("ann", 40, seed=5),
        "made": made("ann", 20, seed=6),
        "removed": np.array([3], np.uint32),
        "compact_map": old,
        "old": old,
        "new": new,
    }


@pytest.fixture
def maps(address: str) -> None:
    """Store the maps that the snippets name; remove those of other snippets."""
    with Client(address) as client:
        for one in list(client.maps()):
            client.delete_map(one.name)
        for name in ("depot", "hall", "shed"):
            client.put_map(name, made("bob"))


@pytest.mark.parametrize("block", PYTHON, ids=str)
def test_B8_python_snippets_run(
    block: Block, address: str, maps: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = given(address, tmp_path)
    code = block.text.replace(LOCAL, address).replace("= [...]", "= clouds")
    if "async with" in code:
        code = f"async def run():\n{textwrap.indent(code, '    ')}\nasyncio.run(run())\n"
    if "client." in code and "with Client(" not in code:
        with Client(address) as client:
            client.put_map("yard", made("ann"))
            exec(compile(code, str(block), "exec"), names | {"client": client})
    else:
        exec(compile(code, str(block), "exec"), names)


def test_B8_a_form_is_told_which_header_to_send(address: str) -> None:
    done = subprocess.run(
        ["curl", "--silent", "-X", "PUT", "--data-binary", "x", f"{address}/maps/form"],
        capture_output=True,
        text=True,
        timeout=30,
        check=True,
    )
    assert "Content-Type: application/octet-stream" in done.stdout
