"""The limit on a request's body, enforced while it streams in, before anything buffers it."""

import anyio
from starlette._utils import get_route_path
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.body.problem_json import response_of
from service.core.problems import Problem
from service.core.settings import Limits

PATIENCE = (256 << 20, 5.0)
"""Bytes and seconds of a body that is too large, until the client may be cut off."""


RECOGNITION = frozenset({"/describe", "/match", "/localize"})


class BodyLimit:
    """ASGI middleware: 413 for a body that is, or turns out to be, too large."""

    def __init__(self, app: ASGIApp, limits: Limits) -> None:
        self._app = app
        self._limits = limits

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, counting its bytes."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit = self._limit(scope)
        headers = dict(scope["headers"])
        stated = headers.get(b"content-length", b"")
        if stated.isdigit() and int(stated) > limit:
            # A client that expects a 100 waits for the answer before it sends.
            if b"expect" not in headers:
                await discard(receive, *PATIENCE)
            scope["app"].state.placecell.metrics.rejected.labels("body-too-large").inc()
            await response_of(_too_large(limit))(scope, receive, send)
            return
        received = 0

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > limit:
                    if message.get("more_body", False):
                        await discard(receive, *PATIENCE)
                    raise _too_large(limit)
            return message

        await self._app(scope, counted, send)

    def _limit(self, scope: Scope) -> int:
        if scope["method"] == "PUT" and get_route_path(scope).startswith("/maps/"):
            return self._limits.map_bytes
        if get_route_path(scope) in RECOGNITION and not _is_msgpack(scope):
            return self._limits.json_bytes
        return self._limits.body_bytes


def _is_msgpack(scope: Scope) -> bool:
    types = (value for name, value in scope["headers"] if name == b"content-type")
    return next(types, b"").lower().startswith(b"application/msgpack")


def _too_large(limit: int) -> Problem:
    return Problem(
        413,
        "body-too-large",
        f"The body is larger than {limit} bytes, the limit; see /info.",
        # What is left of the body would be read as the next request.
        headers={"Connection": "close"},
    )


async def discard(receive: Receive, most: int = 4 << 20, seconds: float = 0.5) -> bool:
    """Take what is left of a body, within reason; whether that was all.

    A connection closed on a client that still sends is reset, and the client may never read why.
    """
    discarded = 0
    with anyio.move_on_after(seconds):
        while discarded < most:
            message = await receive()
            discarded += len(message.get("body", b""))
            if not message.get("more_body", False):
                return True
    return False
