"""Unknown settings: refused with the nearest setting."""

import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cli import app
from service.core.settings import Limits, Settings


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in list(os.environ):
        if name.startswith("PLACECELL_"):
            monkeypatch.delenv(name)
    return tmp_path


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("PLACECELL_DATADIR", "PLACECELL_DATA_DIR"),
        ("PLACECELL_DATA_DIRECTORY", "PLACECELL_DATA_DIR"),
        ("PLACECELL_KEYFILE", "PLACECELL_KEYS_FILE"),
        ("placecell_keys_fil", "PLACECELL_KEYS_FILE"),
        ("PLACECELL_LIMITS__DEADLIN", "PLACECELL_LIMITS__DEADLINE"),
        ("PLACECELL_LIMITS_K", "PLACECELL_LIMITS__K"),
        ("PLACECELLDATA_DIR", "PLACECELL_DATA_DIR"),
    ],
)
def test_B5_unknown_name_is_refused_with_the_nearest(
    name: str, meant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(name, "/mnt")
    with pytest.raises(ValueError, match="unknown setting") as caught:
        Settings()
    assert f"{name} (did you mean {meant}?)" in str(caught.value)
    refused = CliRunner().invoke(app, ["serve", "--port", "0"])
    assert refused.exit_code == 1
    assert meant in refused.output


def test_B5_name_similar_to_none_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PLACECELL_QQQQQQ", "1")
    with pytest.raises(ValueError, match=r"PLACECELL_QQQQQQ\. Unset them"):
        Settings()


def test_B5_names_of_other_programs_are_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("URL", "KEY", "DRIVES", "DEBUG"):
        monkeypatch.setenv(f"PLACECELL_{name}", "x")
    monkeypatch.setenv("placecell_data_dir", "mine")
    assert Settings().data_dir == Path("mine")


def test_B5_kubernetes_links_are_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    links = {
        "PLACECELL_SERVICE_HOST": "10.0.0.7",
        "PLACECELL_SERVICE_PORT": "8000",
        "PLACECELL_SERVICE_PORT_HTTP": "8000",
        "PLACECELL_PORT": "tcp://10.0.0.7:8000",
        "PLACECELL_PORT_8000_TCP": "tcp://10.0.0.7:8000",
        "PLACECELL_PORT_8000_TCP_PROTO": "tcp",
        "PLACECELL_PORT_8000_TCP_PORT": "8000",
        "PLACECELL_PORT_8000_TCP_ADDR": "10.0.0.7",
        "PLACECELL_GRAFANA_SERVICE_HOST": "10.0.0.8",
        "PLACECELL_GRAFANA_PORT": "tcp://10.0.0.8:3000",
    }
    for name, value in links.items():
        monkeypatch.setenv(name, value)
    assert Settings().port == 8000
    shown = CliRunner().invoke(app, ["config"])
    assert shown.exit_code == 0
    monkeypatch.setenv("PLACECELL_PORT", "9001")
    assert Settings().port == 9001


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("datadir = 'x'", "datadir (did you mean data_dir?)"),
        ("Port = 9000", "Port (did you mean port?)"),
        ("[limits]\ndeadlin = 5", "limits.deadlin (did you mean deadline?)"),
        ("[limit]\nk = 5", "limit (did you mean limits?)"),
        ("port = ", "is not valid TOML"),
    ],
)
def test_B5_unknown_key_of_the_file_is_refused(text: str, said: str, elsewhere: Path) -> None:
    (elsewhere / "placecell.toml").write_text(text)
    with pytest.raises(ValueError, match=r"placecell\.toml") as caught:
        Settings()
    assert said in str(caught.value)


def test_B16_file_with_a_byte_order_mark_is_read(elsewhere: Path) -> None:
    (elsewhere / "placecell.toml").write_bytes(b"\xef\xbb\xbfport = 9000\r\n[limits]\r\nk = 7\r\n")
    assert (Settings().port, Settings().limits.k) == (9000, 7)


def test_body_bytes_alone_limits_json_too() -> None:
    assert Limits(body_bytes=1_000).json_bytes == 1_000
    assert Limits(body_bytes=1_000, json_bytes=2_000).json_bytes == 2_000
    assert Limits().json_bytes > Limits().body_bytes


def test_database_is_a_postgresql_url_and_never_shown() -> None:
    settings = Settings(database="postgresql://ann:hidden@db/maps")  # type: ignore[arg-type]
    assert settings.database.get_secret_value().endswith("@db/maps")
    assert "hidden" not in repr(settings)
    with pytest.raises(ValueError, match="must begin with postgresql://") as raised:
        Settings(database="mysql://ann:hidden@db/maps")  # type: ignore[arg-type]
    assert "hidden" not in str(raised.value)


@pytest.mark.parametrize("options", [["--json"], []])
def test_config_does_not_show_the_password_of_the_database(
    monkeypatch: pytest.MonkeyPatch, options: list[str]
) -> None:
    monkeypatch.setenv("PLACECELL_DATABASE", "postgresql://ann:hidden@db/maps")
    shown = CliRunner().invoke(app, ["config", *options])
    assert shown.exit_code == 0, shown.output
    assert "hidden" not in shown.output
    assert "PLACECELL_DATABASE" in shown.output
