"""The spool: what survives, what is refused, and what a damaged file does."""

import os
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from robot.mapping.spool import FILE, Spool


def test_edits_are_sent_oldest_first(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        for number in range(3):
            assert spool.add(number, 0, bytes([number]), 1)
        assert [each.content for each in spool.oldest(2)] == [b"\x00", b"\x01"]
        spool.remove(spool.oldest(1)[0])
        assert [each.content for each in spool.oldest(5)] == [b"\x01", b"\x02"]
        assert spool.status().entries == 2
        assert spool.status().bytes == 2


def test_edit_of_the_same_number_is_stored_once(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        spool.add(0, 0, b"first", 1)
        spool.remove(spool.oldest(1)[0])
    with Spool.open(tmp_path, "one", 1000) as spool:
        assert spool.add(0, 0, b"again", 1)
        assert spool.oldest(5) == []
        assert spool.progress().last == 0


def test_full_spool_keeps_the_old_edits_and_counts_new_segments() -> None:
    spool = Spool.open(None, "one", 10)
    assert spool.add(0, 0, b"12345678", 3)
    assert not spool.add(1, 0, b"12345678", 4)
    assert spool.status().dropped_segments == 4
    assert [each.content for each in spool.oldest(5)] == [b"12345678"]


def test_full_disk_keeps_the_old_edits_and_counts_new_segments(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1 << 30) as spool:
        assert spool.add(0, 0, b"before", 1)
        (pages,) = spool._database.execute("PRAGMA page_count").fetchone()
        spool._database.execute(f"PRAGMA max_page_count = {pages}")
        assert not spool.add(1, 0, bytes(1 << 16), 5)
        assert spool.status().dropped_segments == 5
        assert not spool.save(7, bytes(1 << 16))
        spool._database.execute(f"PRAGMA max_page_count = {pages + 1000}")
        assert spool.add(1, 0, b"after", 1)
        assert [each.content for each in spool.oldest(5)] == [b"before", b"after"]


def test_checkpoint_is_returned_until_the_drive_is_finished(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        spool.save(42, b"state")
    with Spool.open(tmp_path, "one", 1000) as spool:
        assert (spool.progress().scans, spool.progress().checkpoint) == (42, b"state")
        spool.finish()
        assert spool.progress().finished
        assert spool.progress().checkpoint is None


def test_damaged_checkpoint_is_left_out(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        spool.save(42, b"state")
        spool._database.execute("UPDATE sessions SET checkpoint = ?", (b"stale",))
        assert spool.progress().checkpoint is None


def test_edits_of_an_earlier_session_are_still_sent(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        spool.add(0, 0, b"yesterday", 1)
        spool.set_map("one", 0, "yard")
    with Spool.open(tmp_path, "two", 1000) as spool:
        spool.add(0, 0, b"today", 1)
        assert [each.session for each in spool.oldest(5)] == ["one", "two"]
        assert spool.map_of("one", 0) == "yard"
        assert spool.map_of("two", 0) is None


@pytest.mark.parametrize("content", [b"garbage" * 1000, b"SQLite format 3\x00" + b"\xff" * 5000])
def test_garbage_is_set_aside_and_told(tmp_path: Path, content: bytes) -> None:
    (tmp_path / FILE).write_bytes(content)
    told: list[str] = []
    with Spool.open(tmp_path, "one", 1000, told.append) as spool:
        assert spool.add(0, 0, b"new", 1)
    assert "damaged" in told[0]
    assert (tmp_path / f"{FILE}.damaged-1").read_bytes() == content


def test_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        Spool.open(tmp_path / "file", "one", 1000)


def test_two_agents_never_use_one_folder(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        with pytest.raises(OSError, match="in use by another agent"):
            Spool.open(tmp_path, "two", 1000)
        assert spool.add(0, 0, b"mine", 1)
    with Spool.open(tmp_path, "two", 1000) as spool:
        assert [each.content for each in spool.oldest(5)] == [b"mine"]


WRITER = """
import sys
from pathlib import Path
from robot.mapping.spool import Spool
spool = Spool.open(Path(sys.argv[1]), "one", 1 << 30)
first = spool.progress().last + 1
for number in range(first, first + 100000):
    spool.add(number, 0, number.to_bytes(4, "big") * 50, 1)
    print(number, flush=True)
"""


@pytest.mark.integration
@pytest.mark.slow
def test_edit_that_was_told_stored_survives_sigkill(tmp_path: Path) -> None:
    told = -1
    for kill_after in (1, 7, 30):
        writer = subprocess.Popen(
            [sys.executable, "-c", WRITER, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        assert writer.stdout is not None
        for _ in range(kill_after):
            told = int(writer.stdout.readline())
        os.kill(writer.pid, signal.SIGKILL)
        told = int((writer.stdout.read().split() or [str(told)])[-1])
        writer.wait()
        writer.stdout.close()
    with Spool.open(tmp_path, "one", 1 << 30) as spool:
        stored = spool.oldest(100000)
        assert len(stored) >= told + 1
        numbers = [int.from_bytes(each.content[:4], "big") for each in stored]
        assert numbers == list(range(len(stored)))


def test_database_of_the_spool_syncs_each_transaction(tmp_path: Path) -> None:
    with Spool.open(tmp_path, "one", 1000) as spool:
        (synchronous,) = spool._database.execute("PRAGMA synchronous").fetchone()
        assert synchronous == 2
        assert isinstance(spool._database, sqlite3.Connection)
