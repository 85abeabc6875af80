"""Body limit: enforces the largest size of a request's body while the body streams in."""

import re

import anyio
from starlette._utils import get_route_path
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.body.problem_json import response_of
from service.core.problems import Problem
from service.core.settings import Limits

PATIENCE = (256 << 20, 5.0)
"""Bytes and seconds for which a body that is too large is still received.

The connection may be closed afterwards, even if the client has not read the answer.
"""


RECOGNITION = frozenset({"/describe", "/match", "/localize", "/coverage"})
"""Paths whose JSON bodies have the limit `json_bytes`."""


MAP_FILES = re.compile(r"/maps/[^/]*(/uploads/[^/]*)?")
"""Paths whose `PUT` has a map file as its body."""


class BodyLimit:
    """ASGI middleware that answers 413 if a body is larger than its limit.

    The limit is checked against Content-Length and against the bytes that arrive.
    """

    def __init__(self, app: ASGIApp, limits: Limits) -> None:
        self._app = app
        self._limits = limits

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and count the bytes of its body."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit = self._limit(scope)
        headers = dict(scope["headers"])
        stated = headers.get(b"content-length", b"")
        if stated.isdigit() and int(stated) > limit:
            # A client that sends `Expect: 100-continue` waits for the answer before the body.
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
        if scope["method"] == "PUT" and MAP_FILES.fullmatch(get_route_path(scope)):
            return self._limits.map_bytes
        if scope["method"] == "POST" and is_scan(get_route_path(scope)):
            return self._limits.scan_bytes
        if get_route_path(scope) in RECOGNITION and not _is_msgpack(scope):
            return self._limits.json_bytes
        return self._limits.body_bytes


def is_scan(path: str) -> bool:
    """Return whether a path takes a point cloud file."""
    return path == "/scans" or (path.startswith("/maps/") and path.endswith("/scans"))


def _is_msgpack(scope: Scope) -> bool:
    types = (value for name, value in scope["headers"] if name == b"content-type")
    return next(types, b"").lower().startswith(b"application/msgpack")


def _too_large(limit: int) -> Problem:
    return Problem(
        413,
        "body-too-large",
        f"The body is larger than {limit} bytes, the limit. Send smaller bodies; GET /info shows "
        "all limits.",
        # Otherwise the rest of the body would be read as the next request.
        headers={"Connection": "close"},
    )


async def discard(receive: Receive, most: int = 4 << 20, seconds: float = 0.5) -> bool:
    """Receive and drop the rest of a body; return whether the body ended.

    If a connection is closed while the client still sends, it is reset, and the client may never
    read the answer.

    Args:
        receive: ASGI channel of the request.
        most: number of bytes after which to stop.
        seconds: time after which to stop.
    """
    discarded = 0
    with anyio.move_on_after(seconds):
        while discarded < most:
            message = await receive()
            discarded += len(message.get("body", b""))
            if not message.get("more_body", False):
                return True
    return False
