"""Listening to events: parsing, reconnection and refusals, with both clients."""

import asyncio
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from placecell_client import AsyncClient, Client, ServerEvent, ServiceError

from tests.client.client_fakes import Time, async_client_of, client_of

STREAM = {"Content-Type": "text/event-stream; charset=utf-8"}
FIX = 'id: a-1\nevent: fix\ndata: {"map": "yard",\ndata: "robot": "ann"}\n\n'
ROBOT = 'id: a-2\r\nevent: robot\r\ndata:{"map": null}\r\n\r\n'


def collected(client: Client | AsyncClient, count: int, **options: str) -> list[ServerEvent]:
    """Return the first events of a client of either kind."""
    if isinstance(client, Client):
        stream = client.events(**options)
        return [next(stream) for _ in range(count)]

    async def all_of() -> list[ServerEvent]:
        found: list[ServerEvent] = []
        async for event in client.events(**options):
            found.append(event)
            if len(found) == count:
                break
        return found

    return asyncio.run(all_of())


MAKERS: list[Callable[..., Any]] = [client_of, async_client_of]


@pytest.mark.parametrize("make", MAKERS)
def test_stream_is_reopened_after_the_last_event(make: Callable[..., Any]) -> None:
    seen: list[str | None] = []

    def answer(request: httpx.Request) -> httpx.Response:
        seen.append(request.headers.get("last-event-id"))
        assert request.headers["accept"] == "text/event-stream"
        if len(seen) == 2:
            raise httpx.ConnectError("the link is down")
        if len(seen) == 3:
            return httpx.Response(503, headers={"Retry-After": "7"})
        text = ": comment\nretry: 2000\n\n" + FIX if len(seen) == 1 else "id: a-1\n\n" + ROBOT
        return httpx.Response(200, headers=STREAM, text=text)

    time = Time()
    fix, robot = collected(make(answer, time), 2)
    assert fix == ServerEvent("fix", {"map": "yard", "robot": "ann"}, "a-1")
    assert robot == ServerEvent("robot", {"map": None}, "a-2")
    assert seen == [None, "a-1", "a-1", "a-1"]
    assert time.slept == [pytest.approx(0.1), pytest.approx(0.2), pytest.approx(7.4)]


@pytest.mark.parametrize("make", MAKERS)
def test_stream_continues_after_a_given_event(make: Callable[..., Any]) -> None:
    def answer(request: httpx.Request) -> httpx.Response:
        assert request.headers["last-event-id"] == "a-7"
        return httpx.Response(200, headers=STREAM, text=FIX)

    assert collected(make(answer), 1, last_event_id="a-7")[0].kind == "fix"


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize(
    ("response", "message"),
    [
        (httpx.Response(401, json={"title": "Unauthorized"}), "401 Unauthorized"),
        (httpx.Response(404, text="no"), "404"),
        (httpx.Response(200, html="<p>Login</p>"), "not a stream of events"),
        (httpx.Response(200, headers=STREAM, text="data: [1]\n\n"), "not a JSON object"),
        (httpx.Response(200, headers=STREAM, text="data: {\n\n"), "not a JSON object"),
    ],
)
def test_refusal_and_other_answers_end_the_stream(
    make: Callable[..., Any], response: httpx.Response, message: str
) -> None:
    with pytest.raises(ServiceError, match=message):
        collected(make(lambda _: response), 1)
