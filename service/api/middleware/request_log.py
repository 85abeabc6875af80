"""Request log: records each request's id, times and client in headers, metrics and the log."""

import asyncio
import logging
import re
import secrets
from time import perf_counter

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.body.problem_json import response_of
from service.api.middleware.refusal_log import LOGGED_STATUSES, RefusalLog, address_of
from service.core.problems import Problem, unexpected
from service.core.timing import Timing
from service.core.tracing import RequestTrace
from service.live.alarms import RefusalCounter

logger = logging.getLogger("placecell.requests")

METHODS = {"GET", "HEAD", "OPTIONS", "PUT", "POST", "DELETE", "PATCH"}
"""Methods that metrics show by name; all others count as `other`, so labels stay bounded."""

ID_PATTERN = re.compile(r"[A-Za-z0-9._-]{1,64}")
"""Pattern of a request id that a client may choose; it excludes forged log lines."""


PROBES = {"/livez", "/readyz", "/metrics"}
"""Routes that balancers and monitors ask several times a second. Their requests are no spans unless
the caller traces them, and no log lines unless they fail."""

GOOD = 400
"""Statuses below this one are no failures."""


class RequestLog:
    """ASGI middleware that records every request. It is the outermost middleware."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._refusals = RefusalLog()
        self._refused = RefusalCounter()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on; record its status, time and client."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        given = {
            name: value
            for name in ("x-request-id", "traceparent", "tracestate")
            if (value := dict(scope["headers"]).get(name.encode(), b"").decode("latin-1"))
        }
        request_id = given.pop("x-request-id", "")
        if not ID_PATTERN.fullmatch(request_id):
            request_id = secrets.token_hex(8)
        timing = Timing()
        tracing = scope["app"].state.placecell.tracing
        path = scope["path"].removeprefix(scope.get("root_path", ""))
        if path in PROBES and "traceparent" not in given:
            tracing = None
        trace = tracing.start(scope["method"], given, timing) if tracing else None
        # All requests share the server's dictionary, so each request gets a copy.
        facts = scope["state"] = dict(scope.get("state", {}))
        facts |= {"timing": timing, "request_id": request_id}
        status = 0

        async def noted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                headers = MutableHeaders(scope=message)
                headers["X-Request-Id"] = request_id
                if trace is not None:
                    headers["Traceresponse"] = trace.traceresponse
                default = scope["app"].state.placecell.model_id
                headers["Placecell-Model"] = facts.get("model_id", default)
                if times := timing.header():
                    headers["Server-Timing"] = times
            # The server limits the time that a client takes to read the answer.
            await send(message)

        try:
            await self._app(scope, receive, noted)
        except asyncio.CancelledError:
            # The server stops and no longer waits for this request.
            if status:
                raise
            stopping = Problem(
                503,
                "stopping",
                "The service is stopping. Send the request again after the restart.",
                headers={"Connection": "close"},
            )
            await response_of(stopping)(scope, receive, noted)
        except Exception:
            logger.exception("request to %s failed", scope["path"])
            if status:
                raise
            await response_of(unexpected())(scope, receive, noted)
        finally:
            self._note(scope, status, timing, trace)

    def _note(self, scope: Scope, status: int, timing: Timing, trace: RequestTrace | None) -> None:
        metrics = scope["app"].state.placecell.metrics
        seconds = perf_counter() - timing.started
        route = getattr(scope.get("route"), "path", "none")
        method = scope["method"] if scope["method"] in METHODS else "other"
        metrics.requests.labels(route, method, status).inc()
        metrics.seconds.labels(route).observe(seconds)
        metrics.observe(timing)
        address = address_of(scope)
        key, request_id = scope["state"].get("key"), scope["state"]["request_id"]
        if status in LOGGED_STATUSES:
            self._refusals.add(status, method, route, address, key, request_id)
        self._refused.add(status, scope["app"].state.placecell.engine.events)
        logger.log(
            logging.DEBUG if route in PROBES and status < GOOD else logging.INFO,
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
                **(trace.ids if trace is not None else {}),
            },
        )
        if trace is not None:
            facts = {
                "http.request.method": method,
                "http.route": route,
                "client.address": address,
                "placecell.request_id": request_id,
                "placecell.model": scope["state"].get("model_id"),
            }
            trace.end(f"{method} {route}", status, facts, timing)
