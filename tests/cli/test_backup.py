"""`placecell backup`, `restore` and `migrate` from the command line."""

import json
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from cli import app
from service.maps.sqlite.store import FILE, SqliteMapStore
from tests.service.backup.builders import NOTE, content_of, fill


def run(*words: object) -> Result:
    result: Result = CliRunner().invoke(app, [*map(str, words)])
    return result


def good(*words: object) -> str:
    result = run(*words)
    assert result.exit_code == 0, result.output
    return result.output


def bad(*words: object) -> str:
    result = run(*words)
    assert result.exit_code == 1, result.output
    assert "Traceback" not in result.output
    return result.output


@pytest.fixture
def data_dir(tmp_path: Path) -> Path:
    with SqliteMapStore.owned(tmp_path / "var") as store:
        fill(store)
    return tmp_path / "var"


def stored(folder: Path) -> dict[str, object]:
    with SqliteMapStore.owned(folder) as store:
        assert store.verify() == []
        return content_of(store)


def test_backup_is_checked_and_restored(data_dir: Path, tmp_path: Path) -> None:
    target, other = tmp_path / "copy", tmp_path / "other"
    told = json.loads(good("backup", target, "--database", data_dir, "--json"))
    assert [each["name"] for each in told["maps"]] == ["shed", "yard"]
    assert told["new_bytes"] == told["bytes"] > 0
    assert "0 of them new" in good("backup", target, "--database", data_dir / FILE)
    told = json.loads(good("restore", target, "--verify", "--json"))
    assert (told["maps"], told["whole"], told["restored"]) == (["shed", "yard"], True, False)
    assert "Checked 2 maps" in good("restore", target, "--verify")
    assert "Restored 2 maps" in good("restore", target, "--database", other)
    assert [*stored(other)] == ["shed", "yard"]
    before = stored(other)
    assert "Use --replace" in bad("restore", target, "--database", other)
    assert stored(other) == before
    good("restore", target, "--database", other, "--replace")


def test_store_of_the_settings_is_the_default(
    data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_DATA_DIR", str(data_dir))
    good("backup", tmp_path / "copy")
    monkeypatch.setenv("PLACECELL_DATA_DIR", str(tmp_path / "other"))
    good("restore", tmp_path / "copy")
    assert [*stored(tmp_path / "other")] == ["shed", "yard"]


def test_damaged_backup_ends_with_status_1(data_dir: Path, tmp_path: Path) -> None:
    good("backup", tmp_path / "copy", "--database", data_dir)
    largest = max((tmp_path / "copy" / "objects").rglob("*"), key=lambda path: path.stat().st_size)
    largest.write_bytes(b"altered")
    told = bad("restore", tmp_path / "copy", "--verify")
    assert "was altered" in told
    assert "1 errors" in told
    assert "was altered" in bad("restore", tmp_path / "copy", "--database", tmp_path / "other")
    assert stored(tmp_path / "other") == {}


def test_errors_say_what_to_do(data_dir: Path, tmp_path: Path) -> None:
    assert "holds no maps.sqlite" in bad("backup", tmp_path / "copy", "--database", tmp_path)
    assert "holds no backup" in bad("restore", tmp_path / "copy")
    assert "expected a folder or s3://" in bad("backup", "gs://bucket", "--database", data_dir)
    good("backup", tmp_path / "copy", "--database", data_dir)
    with SqliteMapStore.owned(data_dir):
        told = bad("restore", tmp_path / "copy", "--database", data_dir, "--replace")
        assert "in use by another service. Stop it" in told
        assert "in use" in bad("migrate", "--from", data_dir, "--to", tmp_path / "other")
    copy = tmp_path / "copy.sqlite"
    copy.write_bytes((data_dir / FILE).read_bytes())
    assert "Name the folder" in bad("restore", tmp_path / "copy", "--database", copy)
    assert "is a file. Name a folder" in bad("backup", copy, "--database", data_dir)
    told = bad("migrate", "--from", data_dir, "--to", data_dir / FILE)
    assert "both the source and the target" in told
    (data_dir / FILE).write_bytes(b"no database")
    assert "maps.sqlite" in bad("backup", tmp_path / "copy", "--database", data_dir)


@pytest.mark.parametrize(
    "name",
    [
        "mysql://ann:hidden@host/maps",
        "PostgreSQL://ann:hidden@host/maps",
        "postgresql+psycopg://ann:hidden@host/maps",
        "postgresql:/ann:hidden@host/maps",
        "host=127.0.0.1 password=hidden",
        "password=hidden",
        "postgresql://ann:pass@hidden@127.0.0.1:1/maps",
        "postgresql://ann:hidden/2@127.0.0.1:1/maps",
        "postgresql://ann:pass/hidden@127.0.0.1:1/maps",
        "postgresql://ann:hidden@127.0.0.1:1/maps?none=hidden",
        "",
    ],
)
def test_wrong_name_of_a_database_is_refused_and_shows_no_password(
    data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    good("backup", "copy", "--database", data_dir)
    before = sorted(tmp_path.rglob("*"))
    for words in (
        ("migrate", "--from", data_dir, "--to", name),
        ("migrate", "--from", name, "--to", "other"),
        ("backup", "second", "--database", name),
        ("restore", "copy", "--database", name, "--replace"),
    ):
        told = bad(*words)
        assert "hidden" not in told
        assert "postgresql://" in told
    assert [path for path in sorted(tmp_path.rglob("*")) if "second" not in str(path)] == before


def test_migrate_to_the_source_itself_is_refused(postgres_database: str, data_dir: Path) -> None:
    good("migrate", "--from", data_dir, "--to", postgres_database)
    told = bad("migrate", "--from", postgres_database, "--to", f"{postgres_database}?options=")
    assert "both the source and the target" in told


def test_migrate_moves_all_and_refuses_a_full_target(data_dir: Path, tmp_path: Path) -> None:
    before = stored(data_dir)
    target = tmp_path / "other"
    assert "Moved and compared 2 maps" in good("migrate", "--from", data_dir, "--to", target)
    assert stored(target) == before == stored(data_dir)
    # A repeated command finds the complete copy.
    told = json.loads(good("migrate", "--from", data_dir, "--to", target, "--json"))
    assert told["maps"] == ["shed", "yard"]
    with SqliteMapStore.owned(target) as store:
        store.create("mine", b"file", NOTE, 0)
    assert "has other maps" in bad("migrate", "--from", data_dir, "--to", target)
    assert sorted(stored(target)) == ["mine", "shed", "yard"]


KILLED = """
import sys
from pathlib import Path
from service.backup.counting import CountedSnapshot
from service.backup.folder import FolderTarget
from service.backup.reading import BackupSnapshot
from service.maps.sqlite.store import SqliteMapStore

def wait(_):
    print("half", flush=True)
    sys.stdin.read()

with SqliteMapStore.owned(Path(sys.argv[2])) as store:
    source = BackupSnapshot(FolderTarget(Path(sys.argv[1])))
    store.import_maps(CountedSnapshot(source, wait), 0, True)
"""


@pytest.mark.integration
def test_restore_killed_with_sigkill_leaves_the_old_maps(data_dir: Path, tmp_path: Path) -> None:
    good("backup", tmp_path / "copy", "--database", data_dir)
    with SqliteMapStore.owned(tmp_path / "other") as store:
        store.create("mine", b"file", NOTE, 0)
    before = stored(tmp_path / "other")
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, tmp_path / "copy", tmp_path / "other"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as process:
        timer = threading.Timer(60, process.kill)
        timer.start()
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == b"half\n"
        finally:
            process.kill()
            timer.cancel()
    assert stored(tmp_path / "other") == before
    good("restore", tmp_path / "copy", "--database", tmp_path / "other", "--replace")
    assert [*stored(tmp_path / "other")] == ["shed", "yard"]
