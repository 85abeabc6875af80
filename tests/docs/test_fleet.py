"""The commands of docs/how-to/fleet.md run in order: three replicas, a failover, and back."""

import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from benchmarks.replicas.missing_tool import (
    MissingToolError,
    haproxy_program,
    ordinary_user,
    postgres_binaries,
)
from tests.docs.test_docs_run import blocks_of

pytestmark = [pytest.mark.integration, pytest.mark.slow]

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/how-to/fleet.md"
REASON = "tests/docs/test_fleet.py runs all commands of this section in order"
SECONDS = 240


@pytest.fixture
def folder() -> Iterator[Path]:
    # Not below pytest's own folder, which only the user of the tests may enter.
    made = Path(tempfile.mkdtemp(prefix="placecell-how-to-"))
    made.chmod(0o777)
    yield made
    shutil.rmtree(made, ignore_errors=True)


@pytest.fixture
def environment(folder: Path) -> Iterator[dict[str, str]]:
    """Yield an environment with all programs; PostgreSQL's run as another user than root."""
    try:
        binaries, haproxy, user = postgres_binaries(), haproxy_program(), ordinary_user()
    except MissingToolError as error:
        pytest.skip(str(error))
    programs = folder / "programs"
    programs.mkdir()
    names = ("initdb", "pg_ctl", "pg_basebackup", "psql")
    if user is not None and shutil.which("setpriv") is None:
        pytest.skip("root needs setpriv of util-linux to start PostgreSQL as another user")
    become = f"setpriv --reuid={user} --clear-groups " if user is not None else ""
    for name in names:
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec {become}{binaries}/{name} "$@"\n')
        program.chmod(0o755)
    placecell = programs / "placecell"
    placecell.write_text(f'#!/bin/sh\nexec {sys.executable} -m cli "$@"\n')
    placecell.chmod(placecell.stat().st_mode | stat.S_IXUSR)
    (folder / "deploy").symlink_to(ROOT / "deploy")
    path = [str(programs), str(Path(haproxy).parent), str(Path(sys.executable).parent)]
    yield os.environ | {
        "PATH": os.pathsep.join([*path, os.environ["PATH"]]),
        "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "client")]),
        "PLACECELL_DRAIN_SECONDS": "0",
        "OMP_NUM_THREADS": "1",
    }
    for name in ("db-1", "db-2"):
        subprocess.run(
            [programs / "pg_ctl", "--pgdata", folder / name, "--mode", "immediate", "stop"],
            cwd=folder,
            capture_output=True,
            check=False,
            timeout=60,
        )
    with suppress(FileNotFoundError, ValueError, ProcessLookupError):
        os.kill(int((folder / "haproxy.pid").read_text()), signal.SIGKILL)


def test_commands_lead_to_three_replicas_a_failover_and_back(
    folder: Path, environment: dict[str, str]
) -> None:
    blocks = [each.text for each in blocks_of(PAGE) if each.reason == REASON]
    assert len(blocks) == 8
    # A script has no jobs control, by which a terminal knows `%1`.
    script = "set -eum\n" + "\n".join(f"echo STEP {n}\n{b}" for n, b in enumerate(blocks, 1))
    with (folder / "output").open("w+") as output:
        shell = subprocess.Popen(
            ["bash", "-c", script],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        status: int | None = None
        try:
            with suppress(subprocess.TimeoutExpired):
                status = shell.wait(SECONDS)
        finally:
            end_session(shell.pid)
            shell.wait(30)
    said = (folder / "output").read_text()
    logs = "".join(
        f"--- {each.name}\n{each.read_text(errors='replace')[-800:]}"
        for each in sorted(folder.glob("*.log"))
    )
    assert status == 0, f"{said[-3000:]}\n{logs}"
    # The map is listed with three replicas, with two, and by the one process at the end.
    assert len(re.findall(r"^\W*yard\b", said, re.MULTILINE)) >= 3, said


def end_session(leader: int) -> None:
    """Kill all processes of a session that this test started."""
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError, ValueError):
            # The sixth field is the session; the second one, the name, may hold spaces.
            fields = status.read_text().rpartition(")")[2].split()
            if int(fields[3]) == leader:
                os.kill(int(status.parent.name), signal.SIGKILL)
