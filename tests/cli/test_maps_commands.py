"""`placecell maps`, against a service that runs."""

import re
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from placecell_client import Client, Delta, decode, encode, encode_delta
from typer.testing import CliRunner, Result

from cli import app
from segments.manifest import Manifest
from tests.service.service_builders import map_of, random_codes, write_eigenvalue_model
from tests.service.test_service_process import running

NONE = np.zeros(0, np.uint32)


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Manifest]:
    folder = tmp_path_factory.mktemp("models")
    return folder, write_eigenvalue_model(folder)


@pytest.fixture(scope="module")
def address(
    model: tuple[Path, Manifest], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[str]:
    with running(model[0], tmp_path_factory.mktemp("data")) as (_, address):
        yield address


@pytest.fixture
def files(model: tuple[Path, Manifest], tmp_path: Path) -> dict[str, Path]:
    """A map, another, a delta, and something else."""
    model_id = model[1].model_id
    contents = {
        "yard.map": encode(map_of(random_codes(20), model_id)),
        "other.map": encode(map_of(random_codes(20, 1), model_id, 110, "zoe")),
        "edit.delta": encode_delta(Delta(map_of(random_codes(3, 2), model_id, 118), NONE)),
        "rubbish": b"rubbish" * 9,
    }
    for name, data in contents.items():
        (tmp_path / name).write_bytes(data)
    return {name: tmp_path / name for name in contents}


def run(address: str, *words: str | Path, status: int = 0) -> Result:
    result = CliRunner().invoke(
        app, ["maps", *map(str, words)], env={"PLACECELL_URL": address, "COLUMNS": "200"}
    )
    assert result.exit_code == status, result.output
    assert "Traceback" not in result.output
    return result


def test_a_map_is_pushed_shown_and_taken_back(
    address: str, files: dict[str, Path], tmp_path: Path
) -> None:
    assert "version 1" in run(address, "push", "yard", files["yard.map"]).output
    told = run(address, "push", "yard", files["edit.delta"]).output
    assert "3 segments changed, 0 removed" in told
    refused = run(address, "push", "yard", files["other.map"], status=1)
    assert "428" in refused.output
    refused = run(address, "push", "yard", files["other.map"], "--new", status=1)
    assert "412" in refused.output
    listed = run(address, "list").output
    assert "ann 21" in listed
    (etag,) = re.findall("[0-9a-f]{16}-2", listed)
    assert (
        "version 3" in run(address, "push", "yard", files["other.map"], "--if-match", etag).output
    )
    versions = run(address, "versions", "yard").output
    assert [versions.index(word) for word in ("│ 3", "│ 2", "│ 1")] == sorted(
        versions.index(word) for word in ("│ 3", "│ 2", "│ 1")
    )
    assert "as in version 1" in run(address, "restore", "yard", "1").output
    picture = tmp_path / "yard.png"
    shown = run(address, "show", "yard", "--plot", picture).output
    assert re.search(r"segments +20\n", shown)
    assert re.search(r"robot +ann: 20 segments", shown)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert run(address, "show", files["yard.map"]).output == shown
    assert "segments       20" in run(address, "show", "yard@3").output
    assert (
        "0 segments would be removed"
        in run(address, "age", "yard", "--unseen-since", "5", "--dry-run").output
    )
    assert "20 segments removed" in run(address, "age", "yard", "--unseen-since", "2e9").output
    assert "version 5 is the oldest" in run(address, "compact", "yard").output


def test_a_pulled_file_is_kept_up_to_date(
    address: str, files: dict[str, Path], tmp_path: Path
) -> None:
    run(address, "push", "site", files["yard.map"])
    kept = tmp_path / "kept.map"
    assert "20 segments; version 1," in run(address, "pull", "site", kept).output
    run(address, "push", "site", files["edit.delta"])
    assert "21 segments; version 2 (was 1)" in run(address, "pull", "site", kept).output
    with Client(address) as client:
        assert kept.read_bytes() == client.get_map_file("site")
    kept.write_bytes(b"damaged")
    assert "got anew" in run(address, "pull", "site", kept).output
    assert len(decode(kept.read_bytes())) == 21
    run(address, "pull", "site", kept, "--version", "1")
    assert kept.read_bytes() == files["yard.map"].read_bytes()
    # Which is then not taken for the newest.
    assert "version 2," in run(address, "pull", "site", kept).output
    assert len(decode(kept.read_bytes())) == 21
    run(address, "pull", "nowhere", kept, status=1)
    assert len(decode(kept.read_bytes())) == 21


def test_differences_are_told_and_written(
    address: str, files: dict[str, Path], tmp_path: Path
) -> None:
    assert "no difference" in run(address, "diff", files["yard.map"], files["yard.map"]).output
    written = tmp_path / "way.delta"
    told = run(
        address, "diff", files["yard.map"], files["other.map"], "-o", written, status=1
    ).output
    rows = {line.split()[1]: re.findall(r"\d+", line) for line in told.splitlines() if "│" in line}
    # Ten ids become zoe's, ten are new, ten of ann's are gone.
    assert rows["zoe"] == ["10", "10", "0"]
    assert rows["ann"] == ["0", "0", "10"]
    run(address, "push", "way", files["yard.map"])
    with Client(address) as client:
        client.edit_map("way", written.read_bytes(), if_match="*")
    assert "no difference" in run(address, "diff", "way", files["other.map"]).output
    assert "no difference" in run(address, "diff", "way@1", files["yard.map"]).output


def test_what_cannot_be_is_a_line(address: str, files: dict[str, Path], tmp_path: Path) -> None:
    for words, expected in (
        (("push", "yard", files["rubbish"]), "not a map file"),
        (("push", "yard", tmp_path / "absent"), "absent"),
        (("push", "a b", files["yard.map"]), "invalid"),
        (("show", "nowhere"), "No map is named"),
        (("show", files["rubbish"]), "not a map file"),
        (("versions", "nowhere"), "No map is named"),
        (("restore", "nowhere", "1"), "No map is named"),
        (("list", "--url", "http://127.0.0.1:1"), "127.0.0.1:1"),
        (("list", "--url", "nonsense"), "nonsense"),
        (("list", "--key", "a\nb"), "key"),
    ):
        assert expected.lower() in run(address, *words, status=1).output.lower()


def test_files_and_directories_are_verified(
    address: str, model: tuple[Path, Manifest], files: dict[str, Path], tmp_path: Path
) -> None:
    good = run(address, "verify", files["yard.map"], files["edit.delta"]).output
    assert good.count("good") == 2
    bad = run(address, "verify", files["yard.map"], files["rubbish"], status=1).output
    assert "rubbish: not a map file" in bad
    data_dir = tmp_path / "var"
    with running(model[0], data_dir) as (_, other), Client(other) as client:
        client.put_map("yard", files["yard.map"].read_bytes())
        client.edit_map("yard", files["edit.delta"].read_bytes())
        assert "in use" in run(address, "verify", data_dir, status=1).output
    assert "good" in run(address, "verify", data_dir).output
    with closing(sqlite3.connect(data_dir / "maps.sqlite")) as connection:
        connection.execute("UPDATE commits SET delta = x'00' WHERE sequence = 2")
        connection.commit()
    told = run(address, "verify", data_dir, status=1).output
    assert told.count("version 2 was altered or lost") == 1
    (data_dir / "maps.sqlite").write_bytes(b"")
    assert "from a backup" in run(address, "verify", data_dir, status=1).output
    assert "no data directory" in run(address, "verify", tmp_path, status=1).output
