"""The commands of the page on backups run, in its order, on a store with maps."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cli import app
from service.maps.sqlite.store import SqliteMapStore
from tests.docs.test_docs_run import SHELL, commands_of, plain
from tests.service.backup.builders import content_of, fill

DATABASE = "postgresql://localhost/placecell"


def commands(pattern: str) -> list[list[str]]:
    """Return the words of the page's commands that are run and have this pattern."""
    lines = [
        line
        for block in SHELL
        if block.file.name == "back-up-and-restore.md"
        for line in commands_of(block)
    ]
    page = Path(__file__).parents[2] / "docs" / "how-to" / "back-up-and-restore.md"
    # Commands of a list are no blocks of their own.
    lines += re.findall(r"^ {8}(placecell .*)", page.read_text(encoding="utf-8"), re.MULTILINE)
    return [plain(line)[1:] for line in lines if re.search(pattern, line)]


@pytest.fixture
def before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """Content of a data directory `var` in the present folder."""
    monkeypatch.chdir(tmp_path)
    with SqliteMapStore.owned(Path("var")) as store:
        fill(store)
        return content_of(store)


def run(words: list[str]) -> None:
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, f"{words}: {result.output}"


def names(folder: str) -> list[str]:
    with SqliteMapStore.owned(Path(folder)) as store:
        assert store.verify() == []
        return [head.name for head in store.heads()]


def test_backup_check_and_restore_run(before: dict[str, object]) -> None:
    found = commands(r"placecell (backup|restore) copy")
    assert [words[0] for words in found] == ["backup", "restore", "restore"]
    for words in found:
        run(words)
    assert names("var") == [*before]


def test_backup_to_s3_runs(before: dict[str, object], monkeypatch: pytest.MonkeyPatch) -> None:
    boto3 = pytest.importorskip("boto3")
    moto = pytest.importorskip("moto")
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "a")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "b")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    (words,) = commands(r"placecell backup s3:")
    with moto.mock_aws():
        boto3.client("s3").create_bucket(Bucket="robots")
        run(words)
        run(["restore", words[1], "--database", "other"])
    assert names("other") == [*before]


@pytest.mark.integration
def test_move_to_postgresql_and_back_runs(
    before: dict[str, object], postgres_database: str
) -> None:
    there, back = commands(r"placecell migrate")
    for words in (there, back):
        run([word.replace(DATABASE, postgres_database) for word in words])
    assert names(back[-1]) == [*before]
