"""A newcomer can follow the tutorials: their scripts and commands run, and find the robot."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.datasets import Drive, open_drive
from service.child_process import running_service
from tests.docs.http_examples import LOCAL, SILENT
from town import two_robots

DOCS = Path(__file__).parents[2] / "docs"
SCANS = 24
"""Scans of a drive: enough for a map in which a robot is found."""


def text_of(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


def scripts_of(page: str) -> dict[str, str]:
    """Return the files that a page tells to write; blocks of one file are joined."""
    files: dict[str, str] = {}
    for name, content in re.findall(r'```python title="(.+?)"\n(.*?)```', text_of(page), re.DOTALL):
        files[name] = files.get(name, "") + content
    return files


def commands_of(page: str, word: str) -> list[str]:
    """Return the commands of a page that begin with a word, each once."""
    blocks = re.findall(r"```sh\n(.*?)```", text_of(page), re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    return [line for line in dict.fromkeys(lines) if line.startswith(f"{word} ")]


class Newcomer:
    """Follow a page in a folder, with a service of one's own."""

    def __init__(self, folder: Path, address: str) -> None:
        self.folder = folder
        self.address = address

    def run(self, command: str) -> str:
        """Run a command of a page and return what it prints."""
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        environment = os.environ | {"PLACECELL_URL": self.address, "PATH": path}
        done = subprocess.run(
            ["bash", "-c", SILENT + command.replace(LOCAL, self.address)],
            cwd=self.folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert done.returncode == 0, f"{command}: {done.stdout:.500} {done.stderr[-1000:]}"
        return done.stdout


@pytest.fixture(scope="module")
def newcomer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Newcomer]:
    folder = tmp_path_factory.mktemp("newcomer")
    two_robots(folder / "out" / "town", seed=7, scans=SCANS)
    with running_service(folder / "var") as address:
        for name, script in scripts_of("tutorials/first-map.md").items():
            (folder / name).write_text(script.replace(LOCAL, address))
        yield Newcomer(folder, address)


@pytest.mark.slow
def test_first_map_is_made_and_the_other_robot_is_found_in_it(newcomer: Newcomer) -> None:
    for command in commands_of("tutorials/first-map.md", "python"):
        printed = newcomer.run(command)
        if command.startswith("python map_drive.py"):
            assert re.match(r"yard: \d+ segments, \d+ bytes, version 1\n", printed)
        else:
            assert " in yard, turned by " in printed
    (curl,) = commands_of("tutorials/first-map.md", "curl")
    assert '"map":"yard"' in newcomer.run(curl)
    assert "yard" in newcomer.run("placecell maps list")


@pytest.mark.slow
def test_two_robots_maps_are_aligned_and_merged(newcomer: Newcomer) -> None:
    page = "tutorials/two-robots.md"
    for command in commands_of(page, "python"):
        if command.startswith("python map_drive.py") and " yard" not in command:
            newcomer.run(command)
    for command in commands_of(page, "placecell"):
        if "shared" not in command:
            newcomer.run(command)
    assert "site" in newcomer.run("placecell maps list")
    (localize,) = [each for each in commands_of(page, "python") if "localize" in each]
    assert " in site, turned by " in newcomer.run(localize)


def defined(page: str, name: str) -> Any:
    """Return what a page's own snippet defines under a name."""
    for content in re.findall(r"```python\n(.*?)```", text_of(page), re.DOTALL):
        if re.search(rf"^(def|class) {name}\b", content, re.MULTILINE):
            names: dict[str, Any] = {}
            exec(compile(content, page, "exec"), names)
            return names[name]
    raise AssertionError(f"{page}: no {name}")


def equal(read: Drive, scans: list[np.ndarray], poses: np.ndarray, times: np.ndarray) -> None:
    np.testing.assert_allclose(read.poses, poses, atol=1e-6)
    np.testing.assert_allclose(read.times, times)
    for index, scan in enumerate(scans):
        np.testing.assert_allclose(read.scan(index), scan, atol=1e-6)


@pytest.fixture
def recorded() -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
    """Scans, poses and times of a short recording that begins at its world's origin."""
    random = np.random.default_rng(0)
    scans = [random.normal(size=(50, 3)).astype(np.float32) for _ in range(3)]
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 0, 3] = np.arange(3)
    return scans, poses, np.arange(3) / 10


def test_own_logs_are_written_as_the_page_shows(tmp_path: Path, recorded: Any) -> None:
    write_drive = defined("tutorials/your-own-logs.md", "write_drive")
    write_drive(tmp_path / "my_drive", *recorded)
    equal(open_drive(tmp_path / "my_drive"), *recorded)


def test_a_drive_format_is_added_as_the_page_shows(tmp_path: Path, recorded: Any) -> None:
    scans, poses, times = recorded
    (tmp_path / "scans").mkdir()
    for index, scan in enumerate(scans):
        np.save(tmp_path / "scans" / f"{index:06d}.npy", scan)
    np.save(tmp_path / "poses.npy", poses)
    np.save(tmp_path / "times.npy", times)
    reader = defined("how-to/add-a-drive-format.md", "NumpyDrive")
    assert reader.recognizes(tmp_path)
    equal(reader(tmp_path), *recorded)
    np.save(tmp_path / "times.npy", times[:2])
    with pytest.raises(ValueError, match="3 scans, 3 poses and 2 times"):
        reader(tmp_path)
