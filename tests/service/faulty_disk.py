"""Disks that fail, are full or take no writes, under a service that runs."""

import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import which

import pytest

PATIENCE = 30
"""Seconds after which what should be done at once has failed, however busy the machine."""


@contextmanager
def failing(pid: int, calls: str, error: str, log: Path) -> Iterator[None]:
    """While the block runs, these system calls of a process fail; skips where strace cannot.

    Args:
        pid: of the process.
        calls: names, with commas.
        error: such as `EIO`.
        log: a file for strace to write to.
    """
    if which("strace") is None:
        pytest.skip("strace is not installed")
    options = ("-f", "-p", str(pid), "-e", f"trace={calls}", "-e", f"inject={calls}:error={error}")
    with log.open("w+") as told:
        tracer = subprocess.Popen(
            ["strace", *options, "-o", "/dev/null"], stderr=told, stdout=subprocess.DEVNULL
        )
        try:
            deadline = time.monotonic() + PATIENCE
            while "attached" not in log.read_text():
                if tracer.poll() is not None:
                    pytest.skip(f"strace cannot watch a process here: {log.read_text().strip()}")
                assert time.monotonic() < deadline, log.read_text()
                time.sleep(0.02)
            yield
        finally:
            tracer.terminate()
            tracer.wait(PATIENCE)


@contextmanager
def small_disk(folder: Path, size: str) -> Iterator[None]:
    """While the block runs, the folder is a disk of this size; skips where none may be mounted."""
    folder.mkdir()
    mounted = _mount("-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder))
    if mounted.returncode:
        pytest.skip(f"no small disk can be mounted here: {mounted.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def make_read_only(folder: Path) -> None:
    """Make a mounted disk refuse all writes."""
    mounted = _mount("-o", "remount,ro", str(folder))
    assert not mounted.returncode, mounted.stderr


def _mount(*arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(["mount", *arguments], capture_output=True, text=True, check=False)
