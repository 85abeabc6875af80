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


class Protocol(H11Protocol):
    """HTTP/1.1 whose refusals are problems too."""

    def send_400_response(self, msg: str) -> None:
        """What is no HTTP, or has too long a head."""
        del msg  # says less than h11's error, which is being handled
        error = sys.exc_info()[1]
        status = getattr(error, "error_status_hint", 400)
        body = Problem(status, "invalid-http", f"The request is not HTTP/1.1: {error}.").response
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
        super().__init__(
            uvicorn.Config(
                app,
                http=Protocol,
                access_log=False,
                log_config=None,
                server_header=False,
                h11_max_incomplete_event_size=HEAD_BYTES,
                timeout_graceful_shutdown=int(settings.limits.deadline) + 1,
            )
        )
        self._state = state

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Drain at the first signal; a second one stops at once."""
        if self._state.draining or sig == signal.SIGINT:
            super().handle_exit(sig, frame)
            return
        self._state.draining = True
        seconds = self._state.settings.drain_seconds
        # From a signal's handler the loop must be woken.
        loop = asyncio.get_running_loop()
        loop.call_soon_threadsafe(loop.call_later, seconds, super().handle_exit, sig, frame)
