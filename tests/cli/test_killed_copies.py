"""SIGKILL during `placecell backup`, `restore` and `migrate`: the old state or all of the new."""

import json
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from service.backup.databases import reading, writing
from service.backup.folder import FolderTarget
from service.backup.reading import BackupSnapshot
from tests.service.backup.builders import NOTE, content, fill

pytestmark = [pytest.mark.integration, pytest.mark.slow]

RUNS = """
import json, os, signal, sys
import psycopg
from rich.progress import Progress
from cli import app
from service.backup import migration, reading, targets, writing
from service.core import version
from service.maps.postgres import store

def killed_at(moment):
    left = [moment]
    def passed():
        left[0] -= 1
        if not left[0]:
            os.kill(os.getpid(), signal.SIGKILL)
    advance, commit = Progress.advance, psycopg.Connection.commit
    def advanced(self, *rest, **named):
        passed()
        advance(self, *rest, **named)
    def committed(self):
        passed()
        commit(self)
        passed()
    Progress.advance, psycopg.Connection.commit = advanced, committed
    sys.addaudithook(lambda event, _: passed() if event in ("os.rename", "os.remove") else None)

for line in sys.stdin:
    moment, *words = json.loads(line)
    child = os.fork()
    if not child:
        os.dup2(2, 1)
        killed_at(moment)
        sys.argv[1:] = words
        app()
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""
"""Runs commands, each in a child that kills itself at a moment: before the given read of a map's
bytes, renamed or removed file, or begin or end of a commit. The imports are done once."""

Run = Callable[..., int]


@pytest.fixture(scope="module")
def run() -> Iterator[Run]:
    """Run a command that is killed at a moment (0: at none); return its exit status."""
    with subprocess.Popen(
        [sys.executable, "-c", RUNS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None

        def once(moment: int, *words: object) -> int:
            print(json.dumps([moment, *map(str, words)]), file=process.stdin, flush=True)
            return int(process.stdout.readline())  # type: ignore[union-attr]

        yield once
        process.stdin.close()


@pytest.fixture(params=["sqlite", "postgres"])
def database(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Name of an empty store."""
    if request.param == "sqlite":
        return str(tmp_path / "var")
    return str(request.getfixturevalue("postgres_database"))


def maps_of(database: str) -> dict[str, object]:
    """Return all maps of a store."""
    with reading(database) as source:
        return content(source)


def stored(database: str) -> dict[str, object]:
    """Fill a store; return all that it has."""
    with writing(database) as store:
        fill(store)
    return maps_of(database)


def write_more(database: str) -> dict[str, object]:
    """Write to a filled store; return all that it has then."""
    with writing(database) as store:
        head = next(each for each in store.heads() if each.name == "yard")
        store.append(head, b"later" * 1_000, NOTE, 0)
    return maps_of(database)


def kills(run: Run, *words: object, step: int = 4) -> Iterator[int]:
    """Yield each moment at which a command was killed; the last run ends by itself."""
    for moment in range(2, 200, step):
        status = run(moment, *words)
        if status == 0:
            assert moment > step + 2, "the command was killed at too few moments"
            return
        assert status == -signal.SIGKILL
        yield moment
    raise AssertionError("the command never ends")


def test_killed_backup_leaves_the_previous_one(run: Run, database: str, tmp_path: Path) -> None:
    before = stored(database)
    assert run(0, "backup", tmp_path / "copy", "--database", database) == 0
    after = write_more(database)
    for _ in kills(run, "backup", tmp_path / "copy", "--database", database):
        found = BackupSnapshot(FolderTarget(tmp_path / "copy"))
        assert content(found) in (before, after)
        assert not found.faults(lambda _: None)
    assert content(BackupSnapshot(FolderTarget(tmp_path / "copy"))) == after
    assert maps_of(database) == after


def test_killed_restore_leaves_the_old_maps(run: Run, database: str, tmp_path: Path) -> None:
    stored(database)
    assert run(0, "backup", tmp_path / "copy", "--database", database) == 0
    before = write_more(database)
    seen = 0
    for _ in kills(run, "restore", tmp_path / "copy", "--database", database, "--replace"):
        found = maps_of(database)
        if not has_versions_of(found, before):  # the kill came just after the commit
            assert sequences(found) == {"yard": 6, "shed": 1}
        seen += has_versions_of(found, before)
    assert seen > 1
    assert sequences(maps_of(database)) == {"yard": 6, "shed": 1}


def test_killed_migration_leaves_the_target_empty_or_complete(
    run: Run, database: str, tmp_path: Path, postgres_database: str
) -> None:
    other = str(tmp_path / "other") if database == postgres_database else postgres_database
    before = stored(database)
    with writing(other) as store:
        assert store.heads() == []
    seen = set()
    for _ in kills(run, "migrate", "--from", database, "--to", other):
        found = maps_of(other)
        assert found in ({}, before)
        seen.add(len(found))
        assert maps_of(database) == before
    # It was killed while it copied, and while it compared the complete copy.
    assert seen == {0, 2}
    assert maps_of(other) == before == maps_of(database)


def has_versions_of(found: dict[str, object], before: dict[str, object]) -> bool:
    """Return whether a store has the versions and annotations of another.

    Its ids may be skipped: SQLite's record of them is beside the database.
    """
    return (
        found.keys() == before.keys()
        and all(
            (mine[0].mark, mine[0].oldest, *mine[1:4], mine[5])  # type: ignore[index]
            == (other[0].mark, other[0].oldest, *other[1:4], other[5])  # type: ignore[index]
            and mine[0].next_id >= other[0].next_id  # type: ignore[index]
            for mine, other in zip(found.values(), before.values(), strict=True)
        )
    )


def sequences(maps: dict[str, object]) -> dict[str, int]:
    """Return the newest version of each map."""
    return {name: each[0].sequence for name, each in maps.items()}  # type: ignore[index]
