"""The service as a process, over real sockets."""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, MapFileError, Maps, ServiceError, encode
from typer.testing import CliRunner

from cli import app
from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import PROBLEM, cloud, map_of, random_codes, write_onnx_model

PROGRAM = "import service.server; service.server.HEAD_SECONDS = 2; from cli import app; app()"
"""`placecell` with a shorter time limit for the head of a request."""

ROOT = Path(__file__).resolve().parents[3]


def command(models_dir: Path, data_dir: Path, *more: str) -> list[str]:
    return [
        sys.executable, "-c", PROGRAM, "serve", "--model", "tiny", "--port", "0",
        "--models-dir", str(models_dir), "--data-dir", str(data_dir), *more,
    ]  # fmt: skip


@contextmanager
def running(
    models_dir: Path, data_dir: Path, *options: str
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Run the service as a process; yield the process and its address."""
    process = subprocess.Popen(
        command(models_dir, data_dir, *options),
        stdout=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env=os.environ | {"PLACECELL_DRAIN_SECONDS": "0.5"},
    )
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        assert "listens on http://" in line
        yield process, line.split("listens on ")[1].split()[0]
    finally:
        process.kill()
        process.wait(60)
        process.stdout.close()


def refused(*arguments: str, models_dir: Path, data_dir: Path) -> str:
    """Return the output of a service that exits with status 1."""
    done = subprocess.run(
        command(models_dir, data_dir, *arguments),
        capture_output=True, text=True, timeout=60, cwd=ROOT, check=False,
    )  # fmt: skip
    assert done.returncode == 1, done
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") == 1
    return done.stderr


def raw_request(address: str, head: str, *body: bytes) -> tuple[int, str]:
    """Send raw bytes; return the status and the rest of the answer."""
    host, port = address.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=60) as connection:
        connection.sendall(head.replace("\n", "\r\n").encode())
        try:
            for part in body:
                connection.sendall(part)
        except (BrokenPipeError, ConnectionResetError):
            pass  # the answer was sent already
        answer = b""
        try:
            while part := connection.recv(65536):
                answer += part
        except ConnectionResetError:
            pass
    return int(answer.split()[1]), answer.decode()


def peak_memory(process: subprocess.Popen[str]) -> int:
    """Return the peak memory of a process, bytes."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) * 1024


def test_answered_upload_survives_sigkill(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    stored = map_of(random_codes(50), manifest.model_id)
    clouds = [cloud(seed) for seed in range(5)]
    with running(models_dir, data_dir) as (process, address), Client(address) as client:
        summary = client.put_map("yard", stored)
        description = client.describe(clouds, [9.0, -3.0, 1.7])
        before = client.match(description, k=20)
        process.send_signal(signal.SIGKILL)
        process.wait(60)
    with running(models_dir, data_dir) as (_, address), Client(address) as client:
        assert client.get_map_file("yard") == encode(stored)
        assert client.maps() == Maps((summary,))
        after = client.match(description, k=20)
        assert after.queries == before.queries
        assert len(after.queries[0]) == 20
        by_segments = client.match(segments=clouds, sensors=[9.0, -3.0, 1.7], k=20)
        assert by_segments.queries == before.queries


def test_client_works_over_a_real_socket(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    with running(models_dir, data_dir) as (_, address), Client(address) as client:
        info = client.info()
        assert info.model_id == manifest.model_id
        assert info.limits["min_points"] == 10
        described = client.describe([cloud(0), cloud(1)[:2], cloud(2)], np.zeros((3, 3)))
        assert described.model_id == manifest.model_id
        assert described.codes.shape == (3, 7)
        assert set(described.errors) == {1}
        stored = map_of(described.codes[[0, 2]], manifest.model_id)
        client.put_map("yard", encode(stored))
        np.testing.assert_array_equal(client.get_map("yard").codes, stored.codes)
        matches = client.match(described, maps=["yard"], k=1)
        assert [query[0].id if query else None for query in matches.queries] == [100, None, 101]
        assert matches.searched == ("yard",)
        with pytest.raises(ServiceError) as raised:
            client.put_map("../yard", stored)
        assert raised.value.status == 404
        for name in ("..", ".", "a b"):
            with pytest.raises(ServiceError) as raised:
                client.put_map(name, stored)
            assert raised.value.type == "urn:placecell:problem:invalid-map-name"
        client.delete_map("yard")
        with pytest.raises(ServiceError, match="'yard'"):
            client.get_map("yard")
        with pytest.raises(MapFileError):
            client.put_map("yard", map_of(random_codes(2), ""))


def test_invalid_input_over_a_real_socket_is_refused(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    yard = encode(map_of(random_codes(50), manifest.model_id))
    million = b",".join([b"[1.25,2.25,3.25]"] * 1_000_000)
    with (
        running(models_dir, data_dir) as (process, address),
        httpx.Client(base_url=address, timeout=60) as client,
    ):
        assert client.put("/maps/yard", content=yard).status_code == 201
        before = peak_memory(process)

        def ten_million_points() -> Iterator[bytes]:
            yield b'{"segments": [{"sensor": [0, 0, 0], "points": ['
            for part in range(10):
                yield million + (b"," if part < 9 else b"]}]}")

        stated = sum(map(len, ten_million_points()))
        for headers in ({}, {"Content-Length": str(stated)}):
            response = client.post("/describe", content=ten_million_points(), headers=headers)
            assert response.status_code == 413
            assert response.headers["content-type"] == PROBLEM
            assert f"{40 << 20} bytes" in response.json()["detail"]
        # Each body has 170 MB. At most 40 MiB of it, the limit, are held in memory.
        assert peak_memory(process) - before < 60_000_000

        for path in ("/maps/..", "/maps/../../etc/passwd", "/maps/..%2f..%2fetc%2fpasswd"):
            head = f"DELETE {path} HTTP/1.1\nHost: localhost\nConnection: close\n\n"
            status, answer = raw_request(address, head)
            assert status in {404, 405, 422}
            assert PROBLEM in answer
        head = (
            "POST /describe HTTP/1.1\nHost: localhost\nContent-Length: 999\nConnection: close\n\n"
        )
        host, port = address.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=60) as connection:
            connection.sendall(head.replace("\n", "\r\n").encode() + b'{"segments"')
        assert client.get("/livez").status_code == 200
        assert client.get("/maps/yard").content == yard


def test_second_service_on_a_data_directory_exits_with_an_error(
    models_dir: Path, data_dir: Path
) -> None:
    with running(models_dir, data_dir) as (process, address):
        assert process.stdout is not None
        assert process.stdout.readline() == f"Page: {address}/\n"
        message = refused(models_dir=models_dir, data_dir=data_dir)
        assert str(data_dir) in message
        assert "in use by another service" in message
        assert httpx.get(f"{address}/livez").status_code == 200


def test_failed_start_exits_with_the_reason(
    models_dir: Path, tmp_path: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        said = refused("--port", port, models_dir=models_dir, data_dir=data_dir)
        assert f"Cannot listen on 127.0.0.1 port {port}" in said

    # The cases above start processes. The messages below are checked without one.
    monkeypatch.setattr("service.core.logging.install", lambda *_: None)

    def why(*arguments: str, models: Path = models_dir, data: Path = data_dir) -> str:
        words = command(models, data, *arguments)
        result = CliRunner().invoke(app, words[words.index("serve") :])
        assert result.exit_code == 1, result.output
        assert isinstance(result.exception, SystemExit)
        assert result.stdout == ""
        assert result.stderr.count("\n") == 1
        return result.stderr

    assert "--allow-remote" in why("--host", "0.0.0.0")
    assert "Invalid host 'no.such.host.invalid'" in why("--host", "no.such.host.invalid")
    assert "'absent' cannot be loaded" in why("--model", "absent")
    write_onnx_model(tmp_path / "models", "cut")
    model = tmp_path / "models" / "cut" / "model.onnx"
    model.write_bytes(model.read_bytes()[:-1])
    assert "'cut' cannot be loaded" in why("--model", "cut", models=tmp_path / "models")
    (tmp_path / "file").write_text("")
    assert "data directory" in why(data=tmp_path / "file")
    assert not data_dir.exists()


def test_environment_variables_change_the_settings(
    models_dir: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_LIMITS__K", "7")
    with running(models_dir, data_dir) as (_, address):
        info: Any = httpx.get(f"{address}/info").json()
    assert info["limits"]["k"] == 7
    monkeypatch.setenv("PLACECELL_LIMITS__K", "many")
    done = subprocess.run(
        command(models_dir, data_dir),
        capture_output=True, text=True, timeout=60, cwd=ROOT, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert "limits.k" in done.stderr
    assert "Traceback" not in done.stderr


def test_invalid_http_answers_with_a_problem(models_dir: Path, data_dir: Path) -> None:
    with running(models_dir, data_dir) as (_, address):
        for head in ("what is this\n\n", "GET /livez HTTP/1.1\nbad header\n\n", "\x00\x01\n\n"):
            status, answer = raw_request(address, head)
            assert status == 400
            assert PROBLEM in answer
            assert "invalid-http" in answer
        huge = "GET /livez HTTP/1.1\nHost: localhost\nX-Huge: " + "a" * 200_000 + "\n\n"
        status, answer = raw_request(address, huge)
        assert status == 431
        assert PROBLEM in answer
        assert httpx.get(f"{address}/livez").status_code == 200


def test_sigterm_finishes_running_requests(models_dir: Path, data_dir: Path) -> None:
    """After SIGTERM the service is not ready, finishes its requests, then exits."""
    body = b'{"model_id": "m", "codes": [[1]]}'
    head = (
        f"POST /match HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(body)}\r\n\r\n".encode()
    )
    with running(models_dir, data_dir) as (process, address):
        host, port = address.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=60) as connection:
            connection.sendall(head + body[:5])
            assert httpx.get(f"{address}/readyz").status_code == 200
            process.send_signal(signal.SIGTERM)
            deadline = time.monotonic() + 30
            while (status := httpx.get(f"{address}/readyz").status_code) == 200:
                assert time.monotonic() < deadline
            assert status == 503
            assert httpx.get(f"{address}/livez").status_code == 200
            while True:
                try:
                    httpx.get(f"{address}/livez")
                except httpx.TransportError:
                    break
                assert time.monotonic() < deadline
            connection.sendall(body[5:])
            answer = connection.recv(65536)
            # The codes belong to an unknown model, but the request is answered.
            assert answer.startswith(b"HTTP/1.1 409")
        assert process.wait(30) == 0
    # The database was closed, so the content of its log is in the main file.
    assert not (data_dir / "maps.sqlite-wal").exists()


def test_service_with_keys_may_listen_on_all_addresses(
    models_dir: Path, data_dir: Path, tmp_path: Path
) -> None:
    file = tmp_path / "keys.toml"
    file.write_text("[a]\nsha256 = '" + "0" * 64 + "'\n")
    with running(models_dir, data_dir, "--host", "0.0.0.0", "--keys-file", str(file)) as (_, shown):
        port = shown.rpartition(":")[2]
        assert httpx.get(f"http://127.0.0.1:{port}/livez").status_code == 200
        assert httpx.get(f"http://127.0.0.1:{port}/maps").status_code == 401


def test_silent_clients_are_disconnected(models_dir: Path, data_dir: Path) -> None:
    with running(models_dir, data_dir) as (_, address):
        host, port = address.removeprefix("http://").split(":")
        heads = (b"", b"GET /livez HT", b"POST /describe HTTP/1.1\r\nHost: localhost\r\n")
        connections = [socket.create_connection((host, int(port)), timeout=30) for _ in heads]
        for connection, head in zip(connections, heads, strict=True):
            connection.sendall(head)
        for connection in connections:
            with connection, suppress(ConnectionResetError):
                assert connection.recv(1000) == b""
        # A client that is refused before its body arrives may not send for ever.
        with socket.create_connection((host, int(port)), timeout=30) as connection:
            head = b"POST /describe HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\n"
            connection.sendall(head + b"Content-Length: 99\r\n\r\n")
            answer = b""
            with suppress(ConnectionResetError):
                while part := connection.recv(1000):
                    answer += part
            assert answer.startswith(b"HTTP/1.1 415")
        with httpx.Client(base_url=address) as client:
            for _ in range(4):
                assert client.get("/livez").status_code == 200


def test_invalid_chunk_after_the_answer_ends_the_connection(
    models_dir: Path, data_dir: Path
) -> None:
    with running(models_dir, data_dir) as (_, address):
        host, port = address.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=30) as connection:
            head = b"POST /describe HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\n"
            connection.sendall(head + b"Transfer-Encoding: chunked\r\n\r\n")
            assert connection.recv(65536).startswith(b"HTTP/1.1 415")
            connection.sendall(b"zz\r\n")
            with suppress(ConnectionResetError):
                while connection.recv(65536):
                    pass
        assert httpx.get(f"{address}/livez").status_code == 200


def test_second_signal_stops_at_once(models_dir: Path, data_dir: Path) -> None:
    with running(models_dir, data_dir) as (process, address):
        host, port = address.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=60) as connection:
            connection.sendall(
                b"PUT /maps/a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nx"
            )
            assert httpx.get(f"{address}/livez").status_code == 200
            process.send_signal(signal.SIGTERM)
            time.sleep(0.2)
            assert process.poll() is None
            process.send_signal(signal.SIGTERM)
            # Without the second signal, the upload could take ten more seconds.
            process.wait(5)


def test_streams_of_events_do_not_delay_the_stop(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    with running(models_dir, data_dir) as (process, address), Client(address) as client:
        with httpx.stream("GET", f"{address}/events", timeout=30) as response:
            lines = response.iter_lines()
            assert next(lines) == "retry: 2000"
            client.put_map("yard", map_of(random_codes(5), manifest.model_id))
            assert any(line == "event: upload" for line in lines)
            process.send_signal(signal.SIGTERM)
            began = time.monotonic()
            assert any(line == "event: stopping" for line in lines)
            assert [*lines][-1:] in ([], [""])  # the stream ends
        assert process.wait(30) == 0
        assert time.monotonic() - began < 8


def test_answered_tags_and_anchors_survive_sigkill(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    with running(models_dir, data_dir) as (process, address), Client(address) as client:
        client.put_map("yard", map_of(random_codes(5), manifest.model_id))
        client.set_tags("yard", ["outdoor"])
        client.set_anchor("yard", 49.0, 8.4, yaw_deg=20.0)
        for number in range(20):
            client.set_named_anchor("yard", f"dock-{number}", (number, 0, 0))
        process.send_signal(signal.SIGKILL)
        process.wait(60)
    with running(models_dir, data_dir) as (_, address), Client(address) as client:
        assert client.tags("yard") == ("outdoor",)
        assert client.anchor("yard").yaw_deg == 20.0
        found = {each.name: each.position[0] for each in client.anchors("yard")}
        assert found == {f"dock-{number}": number for number in range(20)}
