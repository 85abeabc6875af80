"""`/events`: server-sent events of what happens in the service."""

import json
from collections.abc import AsyncIterator
from time import monotonic
from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Request, Response
from fastapi.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from service.api.admission.admission import client_of
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf
from service.api.state import State
from service.core.auth import Principal
from service.core.problems import Problem
from service.live.events import EventRing, Listener, ServiceEvent

# StreamingResponse is enough: it ends when the client leaves. sse-starlette would only add the
# format of the lines, and its own shutdown, which needs a hook into uvicorn's signals.

router = APIRouter(tags=["events"])

MEDIA_TYPE = "text/event-stream"

HEARTBEAT_SECONDS = 15.0
"""Seconds without an event after which an id alone is sent, and the key is checked again."""

RETRY_MILLISECONDS = 2_000
"""Time after which a browser reconnects."""

_STREAM: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The stream of events; the schema is that of one event.",
        "content": {
            MEDIA_TYPE: {
                "schema": {
                    "type": "object",
                    "properties": {
                        "id": {"type": "string"},
                        "event": {"type": "string"},
                        "data": {"type": "string", "description": "JSON of the event."},
                        "retry": {"type": "integer"},
                    },
                }
            }
        },
    }
}


@router.get(
    "/events",
    summary="Listen to events",
    response_class=StreamingResponse,
    responses=_STREAM | documented(400, 401, 422, 429, 500, 503),
)
async def events(
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    seconds: Annotated[
        float | None,
        Query(ge=0, le=86_400, description="Time after which the stream ends. Default: never."),
    ] = None,
    last_event_id: Annotated[
        str | None,
        Header(max_length=40, description="Id of the last event that the client has seen."),
    ] = None,
) -> Response:
    """Stream what happens in the maps that the key may read, as server-sent events.

    Kinds: `fix` and `no-fix` (answers of `/localize` to a robot or a session), `robot` (reports),
    `upload`, `merge` and `write` (all other writes), and `alarm` (the store cannot be written, a
    map is damaged, requests are refused). Each event has JSON data with `time` and `map`. Alarms
    without a map are for keys of all maps.

    A new stream begins with the alarms that stand. With `Last-Event-ID`, it begins after this
    event; `missed` tells how many events are lost, because only the last `limits.events` are kept,
    or that the service was restarted. A client that reads too slowly gets `dropped`, and the stream
    ends. An id alone is sent every 15 s
    without an event. When the service stops, the stream ends with `stopping`.
    """
    return EventStream(request, state, principal, seconds, last_event_id)


class EventStream(StreamingResponse):
    """Stream of events to one client."""

    def __init__(
        self,
        request: Request,
        state: State,
        principal: Principal,
        seconds: float | None,
        last_event_id: str | None,
    ) -> None:
        """Prepare the stream; it begins when the response is sent.

        Args:
            request: the HTTP request.
            state: state of the service.
            principal: principal of the request.
            seconds: time after which the stream ends; None: never.
            last_event_id: id of the last event that the client has seen.
        """
        headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
        super().__init__((), media_type=MEDIA_TYPE, headers=headers)
        self._request = request
        self._state = state
        self._principal = principal
        self._seconds = seconds
        self._last = last_event_id

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the stream; 429 if there are too many listeners."""
        if scope["state"].get("is_head"):
            await super().__call__(scope, receive, send)
            return
        with self._state.engine.events.listening(client_of(self._request)) as listener:
            self.body_iterator = self._stream(listener)
            await super().__call__(scope, receive, send)

    async def _stream(self, listener: Listener) -> AsyncIterator[str]:
        log = self._state.engine.events
        until = None if self._seconds is None else monotonic() + self._seconds
        at, first = _begin(log, self._principal, self._last)
        yield f"retry: {RETRY_MILLISECONDS}\n\n{first}"
        while True:
            found, lost = log.after(at)
            if lost:
                yield _text("dropped", {"missed": lost}, log.id_of(at))
                return
            told = [_event(log, each) for each in found if each.is_visible_to(self._principal)]
            at = found[-1].number if found else at
            if told:
                yield "".join(told)
            if log.is_closed:
                yield _text("stopping", {}, log.id_of(at))
                return
            left = HEARTBEAT_SECONDS if until is None else until - monotonic()
            if left <= 0:
                return
            if not await listener.wait(min(left, HEARTBEAT_SECONDS)):
                # The key may have been removed since.
                if not self._is_known():
                    return
                # An id alone is no event. It lets a client skip events that it may not see.
                yield f"id: {log.id_of(at)}\n\n"

    def _is_known(self) -> bool:
        """Return whether the key of the request still works."""
        try:
            self._state.keys.principal(self._request.headers.get("authorization"))
        except Problem:
            return False
        return True


def _begin(log: EventRing, principal: Principal, last_event_id: str | None) -> tuple[int, str]:
    """Return the event to begin after, and the first events of the stream."""
    if not last_event_id:
        at = log.last
        alarms = [each for each in log.alarms() if each.is_visible_to(principal)]
        # Without ids of their own, or a client would resume after an old alarm.
        standing = "".join(f"event: alarm\ndata: {each.data}\n\n" for each in alarms)
        return at, f"{standing}id: {log.id_of(at)}\n\n"
    number = log.number_of(last_event_id)
    if number is None:
        at = log.last
        return at, _text("missed", {"missed": None, "restarted": True}, log.id_of(at))
    _, lost = log.after(number)
    if lost:
        at = number + lost
        return at, _text("missed", {"missed": lost, "restarted": False}, log.id_of(at))
    return number, f"id: {log.id_of(number)}\n\n"


def _event(log: EventRing, event: ServiceEvent) -> str:
    return f"id: {log.id_of(event.number)}\nevent: {event.kind}\ndata: {event.data}\n\n"


def _text(kind: str, data: dict[str, Any], identity: str) -> str:
    return f"id: {identity}\nevent: {kind}\ndata: {json.dumps(data)}\n\n"
