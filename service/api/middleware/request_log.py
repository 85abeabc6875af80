"""An account of every request: its id, its times, who sent it, in headers, metrics and the log."""

import asyncio
import logging
import re
import secrets
from time import perf_counter

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.body.problem_json import response_of
from service.api.middleware.refusal_log import TOLD, RefusalLog, address_of
from service.core.problems import Problem, unexpected
from service.core.timing import Timing

logger = logging.getLogger("placecell.requests")

METHODS = {"GET", "HEAD", "OPTIONS", "PUT", "POST", "DELETE", "PATCH"}
"""Told by name; others are made up by clients, without end."""

ID_PATTERN = re.compile(r"[A-Za-z0-9._-]{1,64}")
"""Of a request's id that a client may choose: nothing that could forge a line of the log."""


class Account:
    """ASGI middleware, the outermost."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._refusals = RefusalLog()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, and note what became of it."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        given = dict(scope["headers"]).get(b"x-request-id", b"").decode("latin-1")
        request_id = given if ID_PATTERN.fullmatch(given) else secrets.token_hex(8)
        timing = Timing()
        # The server's own dictionary is that of all requests.
        facts = scope["state"] = dict(scope.get("state", {}))
        facts |= {"timing": timing, "request_id": request_id}
        status = 0

        async def noted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                headers = MutableHeaders(scope=message)
                headers["X-Request-Id"] = request_id
                default = scope["app"].state.placecell.model_id
                headers["Placecell-Model"] = facts.get("model_id", default)
                if times := timing.header():
                    headers["Server-Timing"] = times
            # How long a client may take to read it is the server's matter, which sees the socket.
            await send(message)

        try:
            await self._app(scope, receive, noted)
        except asyncio.CancelledError:
            # The server stops, and no longer waits for this request.
            if status:
                raise
            stopping = Problem(
                503, "stopping", "The service stops.", headers={"Connection": "close"}
            )
            await response_of(stopping)(scope, receive, noted)
        except Exception:
            logger.exception("failed at %s", scope["path"])
            if status:
                raise
            await response_of(unexpected())(scope, receive, noted)
        finally:
            self._note(scope, status, timing)

    def _note(self, scope: Scope, status: int, timing: Timing) -> None:
        metrics = scope["app"].state.placecell.metrics
        seconds = perf_counter() - timing.started
        route = getattr(scope.get("route"), "path", "none")
        method = scope["method"] if scope["method"] in METHODS else "other"
        metrics.requests.labels(route, method, status).inc()
        metrics.seconds.labels(route).observe(seconds)
        metrics.observe(timing)
        address = address_of(scope)
        key, request_id = scope["state"].get("key"), scope["state"]["request_id"]
        if status in TOLD:
            self._refusals.tell(status, method, route, address, key, request_id)
        logger.info(
            "%s %s %s",
            method,
            route,
            status,
            extra={
                "request_id": request_id,
                "key": key,
                "client": address,
                "milliseconds": round(1e3 * seconds, 2),
                "stages": {stage: round(1e3 * spent, 2) for stage, spent in timing.items()},
            },
        )
