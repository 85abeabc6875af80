"""Errors of the command line: one or two lines and an exit status, never a stack trace."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from placecell_client import Client, encode
from typer.testing import CliRunner

from cli import app
from cli.errors import plain
from cli.tables import write_json
from service.child_process import running_service


def leaves(
    command: Any = None, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield every subcommand with the words that lead to it."""
    command = typer.main.get_command(app) if command is None else command
    if hasattr(command, "commands"):
        for name, each in command.commands.items():
            yield from leaves(each, (*path, name))
    else:
        yield path, command


LEAVES = dict(leaves())
NO_JSON: dict[tuple[str, ...], str] = {
    ("serve",): "runs until it is stopped",
    ("events",): "prints lines of JSON",
    ("train",): "writes a model's folder",
    ("train-classes",): "writes into a model's folder",
    ("train-shapes",): "writes into a model's folder",
    ("maps", "render"): "writes a cloud or a picture",
    ("experiments",): "writes a report's folder",
    ("ablations",): "writes a report's folder with ablations.json",
    ("export",): "writes a file for another program",
}
"""Commands without --json, each with the reason."""


def run(*words: object, env: dict[str, str] | None = None) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(word) for word in words], env=env)
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.exit_code, result.output


@pytest.mark.parametrize("path", LEAVES, ids=" ".join)
def test_B12_every_command_that_prints_figures_has_json(path: tuple[str, ...]) -> None:
    options = {option for each in LEAVES[path].params for option in each.opts}
    assert ("--json" in options) == (path not in NO_JSON), NO_JSON.get(path)


@pytest.mark.parametrize("path", LEAVES, ids=" ".join)
def test_B16_usage_errors_take_at_most_two_lines(
    path: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Unknown option, missing path, value that is not a number: each gives an exit status."""
    monkeypatch.chdir(tmp_path)
    command = LEAVES[path]
    status, said = run(*path, "--no-such-option")
    assert status == 2
    assert len(said.strip().splitlines()) <= 2
    assert "--help" in said
    needed = [each for each in command.params if each.param_type_name == "argument"]
    arguments = [
        "group" if each.name == "method" else "/nowhere/at/all" for each in needed if each.required
    ]
    url = (
        ["--url", "http://127.0.0.1:9"]
        if any(each.name == "url" for each in command.params)
        else []
    )
    for option in command.params:
        kind = str(option.type_descriptor.annotation)
        if option.param_type_name == "option" and ("int" in kind or "float" in kind):
            status, said = run(*path, *arguments, *url, option.opts[0], "seven")
            assert status == 2, option.opts
            assert option.opts[0] in said
            assert len(said.strip().splitlines()) <= 2
    reads = {"prepare", "evaluate", "evaluate-poses", "train", "study", "verify", "ladder", "views"}
    if path[-1] in reads | {"peers", "align", "pose-tables", "list", "show"}:
        more = ["--scans", "0:9"] if path[-1] in {"ladder", "views"} else []
        status, said = run(*path, *arguments, *url, *more)
        assert status == 1
        assert len(said.strip().splitlines()) <= 2, said
        assert "Traceback" not in said


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (PermissionError(13, "Permission denied", "/a/b"), "/a/b: permission denied"),
        (FileNotFoundError(2, "No such file", "x"), "x: no such file or folder"),
        (IsADirectoryError(21, "Is a directory", "x"), "x: is a folder, expected a file"),
        (NotADirectoryError(20, "Not a directory", "x/y"), "x/y: a part of the path is a file"),
        (OSError(28, "No space left on device", "out.json"), "out.json: no space left"),
        (OSError(28, "No space left on device"), "no space left on the disk"),
        (MemoryError(), "out of memory"),
        (ValueError("a\nb"), "a\nb"),
    ],
)
def test_B16_system_errors_name_the_file_first(error: Exception, words: str) -> None:
    assert words in plain(error)


def test_B16_unexpected_error_prints_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise KeyError("column")

    monkeypatch.setattr(sys.modules["cli.prepare"], "load", broken)
    status, said = run("prepare", "x")
    assert status == 1
    assert "KeyError" in said
    assert len(said.strip().splitlines()) == 1


def test_events_of_an_unknown_kind_are_refused_at_once() -> None:
    status, said = run("events", "--kind", "fixes", "--url", "http://127.0.0.1:9")
    assert status == 1
    assert "Unknown kind 'fixes': expected one of fix" in said


@pytest.mark.parametrize("where", ["file/below", "file"])
def test_B16_output_below_a_file_is_an_error(where: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    status, said = run("town", tmp_path / where, "--scans", "1", "--columns", "16")
    assert status == 1
    assert "file" in said
    assert len(said.strip().splitlines()) <= 2


def shell(words: str, **env: str) -> subprocess.CompletedProcess[bytes]:
    placecell = f"{sys.executable} -m cli"
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", words.replace("placecell", placecell)],
        capture_output=True,
        env=os.environ | env,
        timeout=60,
        check=False,
    )


def test_B16_closed_pipe_prints_nothing() -> None:
    done = shell("placecell config | true")
    assert done.returncode == 141
    assert done.stderr == b""


def test_B16_full_output_device_is_an_error() -> None:
    done = shell("placecell config > /dev/full")
    assert done.returncode == 1
    assert b"no space left" in done.stderr
    assert done.stderr.count(b"\n") == 1


def test_B16_ctrl_c_prints_one_line() -> None:
    code = (
        "import cli, signal, sys, time\n"
        # A shell starts programs in the background with this signal ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def wait(*_):\n    print('waits', flush=True)\n    time.sleep(60)\n"
        "sys.modules['cli.prepare'].load = wait\ncli.app()\n"
    )
    words = [sys.executable, "-c", code, "prepare", "x"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"waits\n"
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=30)
    assert process.returncode == 130
    assert said == b"placecell: interrupted\n"


def test_B12_B16_names_are_whole_in_a_pipe_and_escaped_on_an_ascii_terminal(
    tmp_path: Path, yard: Any
) -> None:
    name = "a-rather-long-name-of-a-map." + "x" * 36
    robot = "j\N{LATIN SMALL LETTER U WITH DIAERESIS}rgen [bold]:smile:"
    with running_service(tmp_path) as address:
        with Client(address) as client:
            client.put_map(name, replace(yard, robots=(robot,)))
        listed = shell("placecell maps list", PLACECELL_URL=address, COLUMNS="40")
        ascii_only = shell(
            "placecell maps list", PLACECELL_URL=address, PYTHONIOENCODING="ascii", LC_ALL="C"
        )
        as_json = shell("placecell maps list --json", PLACECELL_URL=address)
        (tmp_path / "copy.map").write_bytes(encode(yard))
        verified = shell(f"placecell maps verify {tmp_path / 'copy.map'} --json")
    assert listed.returncode == 0, listed.stderr
    text = listed.stdout.decode()
    assert name in text
    assert f"{robot} 300" in text
    assert "\x1b" not in text
    assert ascii_only.returncode == 0, ascii_only.stderr
    assert name in ascii_only.stdout.decode("ascii")
    assert r"j\xfcrgen [bold]:smile:" in ascii_only.stdout.decode("ascii")
    (one,) = json.loads(as_json.stdout)["maps"]
    assert one["name"] == name
    assert one["robots"] == {robot: 300}
    assert json.loads(verified.stdout)["files"][0]["whole"] is True


def test_version_option_prints_the_version() -> None:
    status, said = run("--version")
    assert status == 0
    assert said.startswith("placecell ")


@pytest.mark.parametrize(
    ("variable", "value", "words"),
    [
        ("PLACECELL_PORT", "abc", "port: found 'abc', expected a valid integer"),
        ("PLACECELL_PORT", "90000", "port: found '90000', expected at most 65535"),
        ("PLACECELL_LOG", "xml", "log: found 'xml', expected 'json' or 'text'"),
        ("PLACECELL_ALSO", "group", "PLACECELL_ALSO: found 'group', expected JSON"),
    ],
)
def test_B16_wrong_setting_shows_value_and_expectation(
    monkeypatch: pytest.MonkeyPatch, variable: str, value: str, words: str
) -> None:
    monkeypatch.setenv(variable, value)
    status, said = run("config")
    assert status == 1
    assert words in said


READ = {
    "--drive",
    "--key-file",
    "--keys-file",
    "--kiss-slam",
    "--map-drive",
    "--map-recording",
    "--models-dir",
    "--pairs",
    "--poses",
    "--python",
    "--query-recording",
    "--recording-a",
    "--recording-b",
    "--segments",
}
"""Options that name what is read."""
OWN_CHECK = {
    "--data-dir": "the service checks its folder before it listens",
    "--file": "a key is added to it at once",
    "--local": "the agent goes on without it",
    "--spool": "the mirror checks it before the first copy",
    "--unix-socket": "the service checks it before it listens",
}
"""Options that name what is written, each with the reason why no callback checks them."""


def path_options() -> list[tuple[tuple[str, ...], Any]]:
    """Return all options that name a file or a folder."""
    return [
        (path, each)
        for path, command in LEAVES.items()
        for each in command.params
        if each.param_type_name == "option"
        and "Path" in str(each.type_descriptor.annotation)
        and each.opts[0] not in READ | OWN_CHECK.keys()
    ]


@pytest.mark.parametrize(
    ("path", "option"), path_options(), ids=lambda each: " ".join(getattr(each, "opts", each))
)
def test_output_that_cannot_be_written_is_refused_before_the_work(
    path: tuple[str, ...], option: Any, tmp_path: Path
) -> None:
    (tmp_path / "file.png").write_text("x")
    (tmp_path / "folder.png").mkdir()
    arguments = [
        "group" if each.name == "method" else "/nowhere/at/all"
        for each in LEAVES[path].params
        if each.param_type_name == "argument" and each.required
    ]
    wrong = [tmp_path / "file.png" / "below.png", tmp_path / "folder.png"]
    is_folder = "folder" in option.help.lower().partition(".")[0] and "file" not in option.help[:5]
    if is_folder:
        wrong[1] = tmp_path / "file.png"
    for each in wrong:
        status, said = run(*path, *arguments, option.opts[0], each)
        assert status == 2, said
        assert f"expected a {'folder' if is_folder or 'below' in each.name else 'file'}" in said
        assert len(said.strip().splitlines()) <= 2
    assert (tmp_path / "file.png").read_text() == "x"


def test_picture_of_an_unknown_format_is_refused_before_the_work(tmp_path: Path) -> None:
    status, said = run("inspect", "/nowhere", "--plot", tmp_path / "scan.xyz")
    assert status == 2
    assert "expected a name that ends in .png, .pdf or .svg" in said


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_output_in_a_folder_without_permission_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    status, said = run("inspect", "/nowhere", "--json", tmp_path / "found.json")
    assert status == 2
    assert "Check the permissions of the folder" in said


def test_figures_that_are_not_finite_are_null_in_json(tmp_path: Path) -> None:
    content = {"rows": [{"p50": float("nan"), "most": np.array([1.0, np.inf])}], "n": np.int64(3)}
    write_json(content, tmp_path / "new" / "figures.json")
    text = (tmp_path / "new" / "figures.json").read_text()
    assert json.loads(text) == {"rows": [{"p50": None, "most": [1.0, None]}], "n": 3}
