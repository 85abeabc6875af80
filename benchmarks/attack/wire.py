"""Requests of an attacker: complete, slow, cut, concurrent, or not HTTP."""

import http.client
import json
import socket
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from benchmarks.attack.target import Target

ATTACKER = "127.0.0.66"
"""The attacker's own address on the loopback interface."""

MSGPACK = "application/msgpack"
JSON = "application/json"
MAP = "application/vnd.placecell.map"
DELTA = "application/vnd.placecell.delta"


@dataclass(frozen=True, slots=True)
class AttackRequest:
    """One request of an attacker."""

    method: str
    path: str
    body: bytes = b""
    key: str | None = None
    headers: Mapping[str, str] = field(default_factory=dict)


def edit_request(name: str, delta: bytes, key: str | None, query: str = "") -> AttackRequest:
    """Return the request that edits a map, with a query such as `create=true`."""
    path = f"/maps/{name}/segments" + (f"?{query}" if query else "")
    return AttackRequest("POST", path, delta, key, {"Content-Type": DELTA})


@dataclass(frozen=True, slots=True)
class AttackResponse:
    """Answer of the service; status 0 if the connection failed before one arrived."""

    status: int
    seconds: float
    body: bytes = b""
    headers: Mapping[str, str] = field(default_factory=dict)

    def json(self) -> Any:
        """Parse the body as JSON."""
        return json.loads(self.body)

    @property
    def text(self) -> str:
        """Decode the body as text."""
        return self.body.decode(errors="replace")


def ask(target: Target, request: AttackRequest, seconds: float = 120.0) -> AttackResponse:
    """Send a request on its own connection and return the answer."""
    host, port = target.place
    connection = http.client.HTTPConnection(
        host, port, timeout=seconds, source_address=_source_of(host)
    )
    begun = time.perf_counter()
    headers = target.authorization(request.key) | dict(request.headers)
    try:
        connection.request(request.method, request.path, request.body or None, headers)
        response = connection.getresponse()
        body = response.read()
        answered = {name.lower(): value for name, value in response.getheaders()}
        return AttackResponse(response.status, time.perf_counter() - begun, body, answered)
    except (OSError, http.client.HTTPException):
        return AttackResponse(0, time.perf_counter() - begun)
    finally:
        connection.close()


def ask_all(
    target: Target, requests: Sequence[AttackRequest], at_once: int, seconds: float = 120.0
) -> list[AttackResponse]:
    """Send requests concurrently and return their answers."""
    with ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(lambda request: ask(target, request, seconds), requests))


def head_of(target: Target, request: AttackRequest, length: int | None = None) -> bytes:
    """Return a request's head; `length` overrides the body's length."""
    length = len(request.body) if length is None else length
    headers = {"Host": target.address.removeprefix("http://")}
    headers |= target.authorization(request.key) | dict(request.headers)
    if length:
        headers["Content-Length"] = str(length)
    lines = [f"{request.method} {request.path} HTTP/1.1"]
    lines += [f"{name}: {value}" for name, value in headers.items()]
    return "\r\n".join([*lines, "", ""]).encode()


def connect(
    target: Target, seconds: float = 30.0, receive_bytes: int | None = None
) -> socket.socket:
    """Open a connection from the attacker's address.

    Args:
        target: service to connect to.
        seconds: timeout of each call, seconds.
        receive_bytes: size of the kernel's receive buffer; None: the default.
    """
    host, port = target.place
    connection = socket.socket()
    try:
        connection.settimeout(seconds)
        if receive_bytes is not None:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
        if source := _source_of(host):
            connection.bind(source)
        connection.connect((host, port))
    except OSError:
        connection.close()
        raise
    return connection


def abandon(target: Target, request: AttackRequest) -> None:
    """Send a complete request and disconnect before its answer."""
    with suppress(OSError), connect(target) as connection:
        connection.sendall(head_of(target, request) + request.body)


def exchange_bytes(target: Target, data: bytes, seconds: float = 10.0) -> bytes:
    """Send raw bytes and return what arrives until the service closes the connection.

    A service that keeps the connection open ends the answer with the text `(left open)`.
    """
    answer = b""
    with connect(target, seconds) as connection:
        with suppress(OSError):
            connection.sendall(data)
        try:
            while piece := connection.recv(1 << 16):
                answer += piece
        except TimeoutError:
            answer += b"(left open)"
        except OSError:
            pass
    return answer


def _source_of(host: str) -> tuple[str, int] | None:
    return (ATTACKER, 0) if host.startswith("127.") else None
