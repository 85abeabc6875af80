"""The HTTP server: uvicorn, that drains before it stops and tells all errors alike."""

import asyncio
import signal
import sys
from types import FrameType

import h11
import uvicorn
from fastapi import FastAPI
from uvicorn.protocols.http.h11_impl import H11Protocol

from service.problems import Problem
from service.state import State

HEAD_BYTES = 32 << 10
"""Of a request's line and headers, at most."""

AHEAD_BYTES = 64 << 10
"""Of requests that a client sends ahead of answers; then it is not read until it has an answer."""

HEAD_SECONDS = 15.0
"""In which a client must have sent them, and what is left of the request before."""


class Protocol(H11Protocol):
    """HTTP/1.1 whose refusals are problems too, and whose clients must say what they want."""

    most = 1_000
    """Connections at once."""

    _impatience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """A client has come; it must send a request's head in time."""
        super().connection_made(transport)
        if len(self.connections) > self.most:
            transport.abort()
        self._wait_for_head()

    def data_received(self, data: bytes) -> None:
        """Some bytes have come."""
        before = self.cycle
        super().data_received(data)
        self._patient_if_new(before)
        self._listen()

    def on_response_complete(self) -> None:
        """An answer was sent; what is left of its request, and the next one's head, must come."""
        before = self.cycle
        self._wait_for_head()
        super().on_response_complete()
        self._patient_if_new(before)
        self._listen()

    def connection_lost(self, exc: Exception | None) -> None:
        """The client has gone."""
        self._patient()
        super().connection_lost(exc)

    def _listen(self) -> None:
        # Where a request comes ahead of an answer, uvicorn stops reading: it would not see that
        # the client goes, and its work would be done for nobody.
        if (
            self.flow.read_paused
            and self.conn.their_state is h11.DONE
            and len(self.conn.trailing_data[0]) < AHEAD_BYTES
            and not self.transport.is_closing()
        ):
            self.flow.resume_reading()

    def _wait_for_head(self) -> None:
        self._patient()
        self._impatience = self.loop.call_later(HEAD_SECONDS, self.transport.abort)

    def _patient_if_new(self, before: object) -> None:
        if self.cycle is not None and self.cycle is not before:
            self._patient()

    def _patient(self) -> None:
        if self._impatience is not None:
            self._impatience.cancel()
            self._impatience = None

    def send_400_response(self, msg: str) -> None:
        """What is no HTTP, or has too long a head."""
        del msg  # says less than h11's error, which is being handled
        if self.conn.our_state not in {h11.IDLE, h11.SEND_RESPONSE}:
            self.transport.close()  # an answer was begun already
            return
        error = sys.exc_info()[1]
        status = getattr(error, "error_status_hint", 400)
        problem = Problem(status, "invalid-http", f"The request is not HTTP/1.1: {error!s:.100}.")
        body = problem.response
        head = h11.Response(
            status_code=status,
            headers=[*body.raw_headers, (b"connection", b"close")],
            reason=b"",
        )
        for event in (head, h11.Data(data=bytes(body.body)), h11.EndOfMessage()):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()


class Server(uvicorn.Server):
    """A server that says it is not ready for a while before it refuses connections."""

    def __init__(self, app: FastAPI, state: State) -> None:
        settings = state.settings
        limits = settings.limits
        super().__init__(
            uvicorn.Config(
                app,
                http=type("Limited", (Protocol,), {"most": limits.connections}),
                access_log=False,
                log_config=None,
                server_header=False,
                h11_max_incomplete_event_size=HEAD_BYTES,
                timeout_graceful_shutdown=int(max(limits.deadline, limits.body_seconds)) + 1,
            )
        )
        self._state = state

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Drain at the first signal; a second one stops at once."""
        if self._state.draining:
            self.should_exit = self.force_exit = True
        if self._state.draining or sig == signal.SIGINT:
            self._state.draining = True
            super().handle_exit(sig, frame)
            return
        self._state.draining = True
        seconds = self._state.settings.drain_seconds
        # From a signal's handler the loop must be woken.
        loop = asyncio.get_running_loop()
        loop.call_soon_threadsafe(loop.call_later, seconds, super().handle_exit, sig, frame)
