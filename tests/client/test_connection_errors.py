"""Explanations of connection errors, with what to do."""

import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from placecell_client import AsyncClient, Client
from placecell_client.http.connection_errors import explained, is_loopback
from placecell_client.http.retry import Retries

ONCE = Retries(attempts=1)


@contextmanager
def answering(content: bytes) -> Iterator[int]:
    """Serve these bytes as the answer to any request; yield the port."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            try:
                while True:
                    connection, _ = server.accept()
                    with connection:
                        connection.settimeout(5)
                        connection.recv(4096)
                        connection.sendall(content)
            except OSError:
                return

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        yield server.getsockname()[1]
        server.shutdown(socket.SHUT_RDWR)
    thread.join(5)


@pytest.fixture
def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


@pytest.mark.parametrize(
    "url", ["127.0.0.1:8000", "robot:8000", "", "robot", "ftp://robot", "http://", "http://[::1"]
)
def test_B16_url_without_scheme_or_host_is_refused(url: str) -> None:
    for kind in (Client, AsyncClient):
        with pytest.raises(ValueError, match=r"Invalid URL .*xpected http://HOST:PORT"):
            kind(url)


def test_B16_closed_port_gets_a_hint(free_port: int) -> None:
    with (
        Client(f"http://127.0.0.1:{free_port}", retries=ONCE) as client,
        pytest.raises(httpx.ConnectError, match=f"placecell serve.*127.0.0.1:{free_port}"),
    ):
        client.info()


def test_B16_https_to_an_http_port_gets_a_hint() -> None:
    with (
        answering(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n") as port,
        Client(f"https://127.0.0.1:{port}", retries=ONCE) as client,
        pytest.raises(httpx.TransportError, match=f"Use http://127.0.0.1:{port}"),
    ):
        client.info()


def test_B16_http_to_another_protocol_gets_a_hint() -> None:
    with (
        answering(b"\x15\x03\x01\x00\x02\x02\x46") as port,
        Client(f"http://127.0.0.1:{port}", retries=ONCE) as client,
        pytest.raises(httpx.TransportError, match=f"use https://127.0.0.1:{port}"),
    ):
        client.info()


def test_B16_loopback_ignores_the_proxy(monkeypatch: pytest.MonkeyPatch, free_port: int) -> None:
    monkeypatch.delenv("NO_PROXY", raising=False)
    monkeypatch.delenv("no_proxy", raising=False)
    for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY"):
        monkeypatch.setenv(name, f"http://127.0.0.1:{free_port}")
    body = b'{"maps": [], "damaged": []}'
    head = b"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n"
    with answering(head % len(body) + body) as port:
        for host in ("127.0.0.1", "localhost"):
            with Client(f"http://{host}:{port}", retries=ONCE) as client:
                assert len(client.maps()) == 0


def test_B16_proxy_is_named_without_its_password(
    monkeypatch: pytest.MonkeyPatch, free_port: int
) -> None:
    for name in ("NO_PROXY", "no_proxy", "http_proxy"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HTTP_PROXY", f"http://me:secret@127.0.0.1:{free_port}")
    with (
        Client("http://robot.invalid:8000", retries=ONCE) as client,
        pytest.raises(httpx.TransportError, match="proxy") as raised,
    ):
        client.info()
    assert f"HTTP_PROXY=http://127.0.0.1:{free_port}" in str(raised.value)
    assert "NO_PROXY=robot.invalid" in str(raised.value)
    assert "secret" not in str(raised.value)


def test_B16_untrusted_certificate_gets_a_hint() -> None:
    error = httpx.ConnectError("[SSL: CERTIFICATE_VERIFY_FAILED] self-signed certificate")
    error.__context__ = ssl.SSLError("self-signed")
    assert "SSL_CERT_FILE" in explained(error, httpx.URL("https://robot:8443"))


def test_B16_timeouts_get_a_hint() -> None:
    url = httpx.URL("http://robot:8000")
    assert "firewall" in explained(httpx.ConnectTimeout("timed out"), url)
    assert "longer timeout" in explained(httpx.ReadTimeout("timed out"), url)
    assert "The host name robot is unknown" in explained(
        httpx.ConnectError("[Errno -2] Name or service not known"), url
    )


def test_loopback_is_recognized_by_name_and_address() -> None:
    for host in ("localhost", "127.0.0.1", "127.1.2.3", "::1"):
        assert is_loopback(host)
    for host in ("robot", "10.0.0.1", "127.0.0.1.example.org", "::2"):
        assert not is_loopback(host)
