"""HTTP server: uvicorn with strict parsing and limits on slow clients."""

import array
import asyncio
import fcntl
import re
import signal
import socket
import sys
import termios
import time
from types import FrameType

import h11
import uvicorn
from fastapi import FastAPI
from h11._receivebuffer import ReceiveBuffer
from uvicorn.protocols.http.h11_impl import H11Protocol

from service.api.admission.addresses import client_network
from service.api.body.problem_json import response_of
from service.api.state import State
from service.core.problems import Problem

HEAD_BYTES = 32 << 10
"""Largest size of a request's line and headers, bytes."""

AHEAD_BYTES = 64 << 10
"""Largest size of requests sent ahead of answers, bytes; above it, reading pauses."""

HEAD_SECONDS = 15.0
"""Seconds within which a client must send line and headers, and the rest of the last request."""

RESERVE = 16
"""Number of connections above the limit, for health checks, if no other can be dropped."""

_BAD_LINE = re.compile(rb"(?<!\r)\n|\r(?!\n)|\n[ \t]")
"""Bare line feed, bare carriage return or folded line: servers read these differently."""


class _StrictBuffer(ReceiveBuffer):
    """Receive buffer whose head lines must end in CRLF and not be folded."""

    def maybe_extract_lines(self) -> list[bytearray] | None:
        """Return the lines of a head; None if the head is incomplete."""
        held = bytes(self)
        lines = super().maybe_extract_lines()
        if lines is not None and _BAD_LINE.search(held[: len(held) - len(self)]):
            raise h11.RemoteProtocolError("a line of the head is folded, or does not end in CRLF")
        return lines


class _StrictConnection(h11.Connection):
    """HTTP/1.1 connection without forms that servers and proxies read differently (smuggling)."""

    def __init__(self, max_head_bytes: int) -> None:
        super().__init__(h11.SERVER, max_incomplete_event_size=max_head_bytes)
        self._receive_buffer = _StrictBuffer()

    def next_event(self) -> h11.Event | type[h11.NEED_DATA] | type[h11.PAUSED]:
        """Return the next event; a request whose length is ambiguous is refused."""
        event = super().next_event()
        if isinstance(event, h11.Request):
            _check_framing(event)
        return event


def _check_framing(request: h11.Request) -> None:
    names = [name for name, _ in request.headers]
    codings = b"transfer-encoding" in names
    if codings and b"content-length" in names:
        raise h11.RemoteProtocolError("Transfer-Encoding and Content-Length exclude each other")
    if codings and request.http_version < b"1.1":
        raise h11.RemoteProtocolError("Transfer-Encoding needs HTTP/1.1")


class Protocol(H11Protocol):
    """HTTP/1.1 protocol that answers refusals as problems and drops clients without progress.

    A connection ends when a request's head does not come in time, or when for `stall_seconds` no
    byte of an answer has left for the client.
    """

    most = 1_000
    """Largest number of connections."""

    address_most = 256
    """Largest number of connections of one address."""

    stall_seconds = 60.0
    """Seconds within which a byte of an answer must be sent."""

    _impatience: asyncio.TimerHandle | None = None
    _watch: asyncio.TimerHandle | None = None
    _unsent = 0
    _progress = 0.0
    _used = 0.0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Start the limits of a new connection: its client must send a head in time."""
        super().connection_made(transport)
        self.conn = _StrictConnection(self.config.h11_max_incomplete_event_size or HEAD_BYTES)
        self._used = self._progress = time.monotonic()
        self._make_room()
        self._wait_for_head()
        self._watch_progress()

    def data_received(self, data: bytes) -> None:
        """Receive bytes of a request."""
        self._used = time.monotonic()
        before = self.cycle
        super().data_received(data)
        self._patient_if_new(before)
        self._listen()

    def on_response_complete(self) -> None:
        """Start the wait for the rest of the request and for the head of the next one."""
        before = self.cycle
        self._used = time.monotonic()
        self._wait_for_head()
        super().on_response_complete()
        self._patient_if_new(before)
        self._listen()

    def resume_writing(self) -> None:
        """Resume sending: most of the bytes have been sent."""
        self._progress = time.monotonic()
        super().resume_writing()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop all timers of the connection."""
        self._patient()
        if self._watch is not None:
            self._watch.cancel()
        super().connection_lost(exc)

    def _make_room(self) -> None:
        """Keep the number of connections within the limits: drop the one that is idle longest."""
        every = [each for each in self.connections if isinstance(each, Protocol) and each != self]
        own = [each for each in every if each.client_address == self.client_address]
        if not self.client_address:  # a Unix socket: a proxy's, that counts for itself
            own = []
        for others, most in ((own, self.address_most), (every, self.most)):
            if len(others) < most:
                continue
            victim = _least_useful(others)
            if victim is not None:
                victim.connections.discard(victim)
                victim.transport.abort()
            elif len(others) >= most + RESERVE:
                self.connections.discard(self)
                self.transport.abort()
                return

    @property
    def client_address(self) -> str:
        """Return the network of the client's address; empty for a Unix socket."""
        return client_network(self.client[0]) if self.client else ""

    @property
    def is_idle(self) -> bool:
        """Return whether no request is in progress and no answer is being sent."""
        return (self.cycle is None or self.cycle.response_complete) and not self._pending()

    @property
    def is_receiving(self) -> bool:
        """Return whether the present request's body is still arriving."""
        return self.cycle is not None and self.cycle.more_body

    @property
    def is_stuck(self) -> bool:
        """Return whether an answer has bytes to send but none left for a while."""
        quiet = time.monotonic() - self._progress
        return quiet > self.stall_seconds / 4 and self._pending() > 0

    @property
    def last_used(self) -> float:
        """Return the time of the last exchange with the client, of `time.monotonic`."""
        return self._used

    def _listen(self) -> None:
        # If a request arrives ahead of an answer, uvicorn stops reading. It would not notice
        # that the client disconnects, and the work would go on without a reader.
        if (
            self.flow.read_paused
            and self.conn.their_state is h11.DONE
            and len(self.conn.trailing_data[0]) < AHEAD_BYTES
            and not self.transport.is_closing()
        ):
            self.flow.resume_reading()

    def _pending(self) -> int:
        """Return the bytes of answers that the client's machine has not received yet."""
        size = self.transport.get_write_buffer_size()
        sock = self.transport.get_extra_info("socket")
        held = array.array("i", [0])
        try:
            fcntl.ioctl(sock.fileno(), termios.TIOCOUTQ, held)
        except (OSError, ValueError, AttributeError):
            return size
        return size + held[0]

    def _watch_progress(self) -> None:
        """End the connection if there are bytes to send but none is sent."""
        pending, now = self._pending(), time.monotonic()
        if pending == 0 or pending < self._unsent:
            self._progress = now
        self._unsent = pending
        if now - self._progress >= self.stall_seconds:
            self.transport.abort()
            return
        self._watch = self.loop.call_later(self.stall_seconds / 8, self._watch_progress)

    def _wait_for_head(self) -> None:
        self._patient()
        self._impatience = self.loop.call_later(HEAD_SECONDS, self._head_is_late)

    def _head_is_late(self) -> None:
        if self._pending():
            # The client still reads the last answer; `_watch_progress` limits that time.
            self._wait_for_head()
        else:
            self.transport.abort()

    def _patient_if_new(self, before: object) -> None:
        if self.cycle is not None and self.cycle is not before:
            self._patient()

    def _patient(self) -> None:
        if self._impatience is not None:
            self._impatience.cancel()
            self._impatience = None

    def send_400_response(self, msg: str) -> None:
        """Answer bytes that are not HTTP, or a head that is too long."""
        del msg  # says less than h11's error, which is being handled
        if self.conn.our_state not in {h11.IDLE, h11.SEND_RESPONSE}:
            self.transport.close()  # an answer has begun already
            return
        error = sys.exc_info()[1]
        status = getattr(error, "error_status_hint", 400)
        problem = Problem(status, "invalid-http", f"The request is not HTTP/1.1: {error!s:.100}.")
        body = response_of(problem)
        head = h11.Response(
            status_code=status,
            headers=[*body.raw_headers, (b"connection", b"close")],
            reason=b"",
        )
        for event in (head, h11.Data(data=bytes(body.body)), h11.EndOfMessage()):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()


def _least_useful(connections: list[Protocol]) -> Protocol | None:
    """Return the connection idle longest; else one whose body or reader has paused."""
    candidates = (
        [each for each in connections if each.is_idle]
        or [each for each in connections if each.is_receiving]
        or [each for each in connections if each.is_stuck]
    )
    return min(candidates, key=lambda each: each.last_used, default=None)


class Server(uvicorn.Server):
    """Server that reports "not ready" for a while before it refuses connections."""

    def __init__(self, app: FastAPI, state: State) -> None:
        settings = state.settings
        limits = settings.limits
        facts = {
            "most": limits.connections,
            "address_most": limits.address_connections,
            "stall_seconds": limits.stall_seconds,
        }
        super().__init__(
            uvicorn.Config(
                app,
                http=type("Limited", (Protocol,), facts),
                access_log=False,
                log_config=None,
                server_header=False,
                proxy_headers=bool(settings.forwarded_allow_ips),
                forwarded_allow_ips=list(settings.forwarded_allow_ips),
                timeout_keep_alive=settings.keep_alive_seconds,
                h11_max_incomplete_event_size=HEAD_BYTES,
                timeout_graceful_shutdown=int(max(limits.deadline, limits.body_seconds)) + 1,
            )
        )
        self._state = state

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End the streams of events, which would not end by themselves, and stop."""
        self._state.engine.events.close()
        await super().shutdown(sockets)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Drain at the first signal; stop at once at the second."""
        if self._state.draining:
            self.should_exit = self.force_exit = True
        if self._state.draining or sig == signal.SIGINT:
            self._state.draining = True
            super().handle_exit(sig, frame)
            return
        self._state.draining = True
        seconds = self._state.settings.drain_seconds
        # A signal handler has to wake the loop.
        loop = asyncio.get_running_loop()
        loop.call_soon_threadsafe(loop.call_later, seconds, super().handle_exit, sig, frame)
