"""Listening: IPv4 and IPv6, Unix sockets, a proxy's prefix, HEAD, CORS."""

import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import typer
from placecell_client import encode

from cli.serve import _listening_socket, _local
from placecell.descriptors.manifest import Manifest
from service.core.settings import Settings
from tests.service.api.test_process import command, running
from tests.service.service_builders import map_of, random_codes


def listening(**settings: Any) -> Iterator[socket.socket]:
    with _listening_socket(Settings(port=0, **settings), open_to_all=True) as found:
        yield found


@pytest.mark.skipif(not socket.has_dualstack_ipv6(), reason="no IPv6 with IPv4 here")
@pytest.mark.parametrize("target", ["127.0.0.1", "::1"])
def test_B11_ipv6_wildcard_address_accepts_ipv4(target: str) -> None:
    for found in listening(host="::"):
        port = found.getsockname()[1]
        try:
            socket.create_connection((target, port), timeout=10).close()
        except OSError as error:
            if target == "::1":
                pytest.skip(f"no IPv6 address here: {error}")
            raise


def test_B11_service_answers_on_a_unix_socket(
    models_dir: Path, data_dir: Path, tmp_path: Path
) -> None:
    import subprocess

    path = tmp_path / "placecell.sock"
    for _ in range(2):  # the second time, the killed service has left its file
        process = subprocess.Popen(
            command(models_dir, data_dir, "--unix-socket", str(path)),
            stdout=subprocess.PIPE,
            text=True,
        )
        assert process.stdout is not None
        try:
            assert f"listens on unix:{path}" in process.stdout.readline()
            transport = httpx.HTTPTransport(uds=str(path))
            with httpx.Client(transport=transport, base_url="http://localhost") as client:
                assert client.get("/livez").status_code == 200
                assert client.get("/maps").json()["maps"] == []
        finally:
            process.kill()
            process.wait(60)
            process.stdout.close()
        assert path.is_socket()


def test_B11_unix_socket_in_use_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "placecell.sock"
    for _ in listening(unix_socket=path):
        with pytest.raises(typer.Exit):
            list(listening(unix_socket=path))
        with socket.socket(socket.AF_UNIX) as client:
            client.connect(str(path))
    assert not path.exists()


def test_B11_file_that_is_not_a_socket_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("mine")
    with pytest.raises(typer.Exit):
        list(listening(unix_socket=path))
    assert path.read_text() == "mine"


def test_B11_head_is_answered_wherever_get_is(service: Any, manifest: Manifest) -> None:
    data = encode(map_of(random_codes(5), manifest.model_id))
    assert service.put("/maps/yard", content=data).status_code == 201
    for path in (
        *("/livez", "/readyz", "/metrics", "/info", "/maps", "/maps/yard", "/openapi.json"),
        *("/maps/yard?version=1", "/maps/yard/versions", "/maps/yard/changes"),
    ):
        got, head = service.get(path), service.head(path)
        assert head.status_code == got.status_code == 200, path
        assert head.content == b""
        if path != "/metrics":  # counts its own requests
            assert head.headers["content-length"] == got.headers["content-length"]
        assert head.headers.get("etag") == got.headers.get("etag")
    assert service.head("/maps/none").status_code == 404
    assert service.head("/describe").status_code == 405
    assert "HEAD" in service.post("/livez").headers["allow"]
    assert 'placecell_requests_total{method="HEAD",route="/livez",status="200"} 1.0' in (
        service.get("/metrics").text
    )


def test_B11_head_leaves_the_connection_usable(models_dir: Path, data_dir: Path) -> None:
    with running(models_dir, data_dir) as (_, address), httpx.Client(base_url=address) as client:
        for _ in range(3):
            assert client.head("/livez").status_code == 200
            assert client.get("/livez").json() == {"status": "alive"}


@pytest.mark.slow
@pytest.mark.parametrize("prefix", ["", "/robots/placecell"])
def test_B11_service_answers_under_a_path_prefix(
    start: Any, manifest: Manifest, prefix: str
) -> None:
    data = encode(map_of(random_codes(5), manifest.model_id))
    with start(root_path="/robots/placecell", limits={"body_bytes": 10}) as service:
        # Some proxies forward the path with the prefix, others without it.
        put = service.put(f"{prefix}/maps/yard", content=data)
        assert put.status_code == 201
        assert put.headers["location"] == "/robots/placecell/maps/yard"
        assert service.get(f"{prefix}/maps/yard").content == data
        assert service.get(f"{prefix}/openapi.json").json()["servers"] == [
            {"url": "/robots/placecell"}
        ]


def test_B11_cors_is_off_unless_allowed(start: Any) -> None:
    page = {"Origin": "https://map.example"}
    asks = page | {"Access-Control-Request-Method": "PUT"}
    allowed = "access-control-allow-origin"
    with start() as service:
        assert allowed not in service.get("/livez", headers=page).headers
        assert service.options("/maps/yard", headers=asks).status_code in {403, 405}
    with start(cors_origins=["https://map.example"]) as service:
        assert service.get("/livez", headers=page).headers[allowed] == page["Origin"]
        assert (
            "ETag" in (service.get("/livez", headers=page).headers["access-control-expose-headers"])
        )
        preflight = service.options("/maps/yard", headers=asks)
        assert preflight.status_code == 200
        assert preflight.headers[allowed] == page["Origin"]
        other = {"Origin": "https://evil.example"}
        assert allowed not in service.get("/livez", headers=other).headers


def test_B11_command_options_change_the_settings(models_dir: Path, data_dir: Path) -> None:
    options = ("--root-path", "/p", "--keep-alive-seconds", "30", "--cors-origin", "http://a.b")
    with running(models_dir, data_dir, *options) as (_, address):
        answer = httpx.get(f"{address}/p/livez", headers={"Origin": "http://a.b"})
        assert answer.status_code == 200
        assert answer.headers["access-control-allow-origin"] == "http://a.b"


@pytest.mark.parametrize(
    ("address", "opened"),
    [
        ("http://127.0.0.1:8000", "http://127.0.0.1:8000"),
        ("http://0.0.0.0:8000", "http://localhost:8000"),
        ("http://[::]:80", "http://localhost:80"),
        ("http://[::1]:80", "http://[::1]:80"),
        ("http://10.0.0.0:8000", "http://10.0.0.0:8000"),
    ],
)
def test_address_of_the_page_can_be_opened(address: str, opened: str) -> None:
    assert _local(address) == opened
