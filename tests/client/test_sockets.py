"""Both clients against a server with faults, over real sockets."""

import asyncio
import hashlib
import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import httpx
import pytest
from placecell_client import AsyncClient, Client, Retries, ServiceError

from tests.client.client_fakes import INFO, SUMMARY

pytestmark = pytest.mark.slow  # by their sum

PATIENCE = 30
"""Time limit of a test that should end at once, seconds; long enough on a busy machine."""
LARGE = bytes(range(256)) * 4096


class Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False
    request_queue_size = 32

    def __init__(self, plan: list[str]) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.plan = plan
        self.bodies: list[str] = []
        self.ended = threading.Event()

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.server_port}"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A client that went away is what some tests are about."""


class Handler(BaseHTTPRequestHandler):
    """Server that follows a plan of faults; the last one repeats."""

    protocol_version = "HTTP/1.1"
    server: Server

    def log_message(self, *arguments: Any) -> None:
        pass

    def answer(self) -> None:
        plan = self.server.plan
        step = plan.pop(0) if len(plan) > 1 else plan[0]
        if step == "stop reading":
            self.rfile.read(1000)
            self.server.ended.wait(PATIENCE)
            return
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        self.server.bodies.append(hashlib.sha256(body).hexdigest())
        if step == "close":
            self.close_connection = True
        elif step == "silence":
            self.server.ended.wait(PATIENCE)
        elif step == "trickle":
            self.head(200, 10**6)
            for _ in range(50 * PATIENCE):
                self.wfile.write(b" ")
                self.server.ended.wait(0.02)
        elif step == "cut":
            self.head(200, 10**6)
            self.wfile.write(b'{"version": ')
            self.close_connection = True
        elif step == "busy":
            self.head(503, 0, "0")
        else:
            content = json.dumps(SUMMARY if self.command == "PUT" else INFO).encode()
            self.head(200, len(content))
            self.wfile.write(content)

    do_GET = do_PUT = answer

    def head(self, status: int, length: int, retry_after: str | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(length))
        if retry_after is not None:
            self.send_header("Retry-After", retry_after)
        self.end_headers()


@contextmanager
def serving(*plan: str) -> Iterator[Server]:
    server = Server(list(plan))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    try:
        yield server
    finally:
        server.ended.set()
        server.shutdown()
        thread.join()
        server.server_close()


def call(kind: str, address: str, method: str, *arguments: Any, **options: Any) -> Any:
    """Call one of the clients; only the network takes time."""
    if kind == "sync":
        with Client(address, jitter=lambda: 0.0, **options) as client:
            return getattr(client, method)(*arguments)

    async def awaited() -> Any:
        async with AsyncClient(address, jitter=lambda: 0.0, **options) as client:
            return await getattr(client, method)(*arguments)

    return asyncio.run(awaited())


both = pytest.mark.parametrize("kind", ["sync", "async"])


@both
@pytest.mark.parametrize("fault", ["close", "cut", "busy"])
def test_broken_connection_is_repeated(kind: str, fault: str) -> None:
    with serving(fault, fault, "answer") as server:
        assert call(kind, server.address, "info").model_id == "m"
        assert len(server.bodies) == 3


@both
def test_repeated_uploads_are_the_same_bytes(kind: str) -> None:
    with serving("close", "busy", "cut", "answer") as server:
        assert call(kind, server.address, "put_map", "yard", LARGE).name == "yard"
        assert server.bodies == [hashlib.sha256(LARGE).hexdigest()] * 4


@both
@pytest.mark.parametrize("fault", ["silence", "trickle", "stop reading"])
def test_the_timeout_ends_the_call(kind: str, fault: str) -> None:
    with serving(fault) as server:
        started = time.monotonic()
        with pytest.raises(httpx.TimeoutException):
            # The body is larger than the buffers of the sockets.
            call(kind, server.address, "put_map", "yard", LARGE * 16, timeout=0.3)
        assert time.monotonic() - started < PATIENCE


@both
def test_silent_attempt_is_ended_and_repeated(kind: str) -> None:
    with serving("silence", "answer") as server:
        retries = Retries(longest_attempt=0.3)
        assert call(kind, server.address, "info", timeout=PATIENCE, retries=retries)
        assert len(server.bodies) == 2


@both
def test_number_of_attempts_is_limited(kind: str) -> None:
    with serving("busy") as server:
        with pytest.raises(ServiceError) as raised:
            call(kind, server.address, "info", retries=Retries(attempts=3))
        assert (raised.value.status, raised.value.retry_after) == (503, 0)
        assert len(server.bodies) == 3


@both
def test_absent_service_is_a_connect_error(kind: str) -> None:
    with serving("answer") as server:
        address = server.address
    with pytest.raises(httpx.ConnectError):
        call(kind, address, "info", retries=Retries(attempts=2))


def test_threads_share_a_client() -> None:
    with serving("answer") as server, Client(server.address) as client:
        results: list[Any] = []
        threads = [threading.Thread(target=lambda: results.append(client.info())) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(results) == 8
