"""Events: scope, order, resumption, slow and too many listeners, and the stop of the service."""

import asyncio
import json
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode
from placecell_client.http.events import EventLines, ServerEvent

from placecell.descriptors.manifest import Manifest
from service.core.auth import ANYONE, Key, Principal
from service.core.problems import Problem
from service.live.alarms import RefusalCounter, StoreWatch
from service.live.events import EVENT_BYTES, EventRing
from tests.service.core.test_auth import made
from tests.service.search.test_localize import by_codes, seen_in, street_map
from tests.service.service_builders import assert_problem, map_of, random_codes


def principal(name: str, *maps: str) -> Principal:
    return Principal(name, Key(sha256="0" * 64, maps=maps or ("*",)))


def read(text: str, last_id: str = "") -> list[ServerEvent]:
    lines = EventLines(last_id)
    events = [lines.read(line) for line in text.split("\n")]
    return [event for event in events if event is not None]


def listen(
    service: Any, headers: dict[str, str] | None = None, seconds: float = 0.2
) -> list[ServerEvent]:
    response = service.get("/events", params={"seconds": seconds}, headers=headers)
    assert response.status_code == 200, response.text
    assert response.headers["content-type"].startswith("text/event-stream")
    assert response.headers["cache-control"] == "no-store"
    return read(response.text)


def test_events_after_a_number_and_the_lost_ones() -> None:
    log = EventRing(3, 4)
    for number in range(5):
        log.publish("robot", {"n": number}, "yard")
    found, lost = log.after(1)
    assert [json.loads(each.data)["n"] for each in found] == [2, 3, 4]
    assert (lost, log.last) == (1, 5)
    assert log.after(4)[0][0].number == 5
    assert log.after(5) == ([], 0)
    assert log.number_of(log.id_of(4)) == 4
    for foreign in ("", "x", "ffffffff-3", f"{log.epoch}-", f"{log.epoch}-x", "<b>-1"):
        assert log.number_of(foreign) is None
    assert log.number_of(f"{log.epoch}-{'9' * 40}") == 5  # of the future


def test_event_that_is_too_long_is_not_published() -> None:
    log = EventRing(3, 4)
    assert log.publish("robot", {"reason": "x" * EVENT_BYTES}) is None
    assert log.last == 0


def test_key_sees_events_of_its_maps_and_its_own() -> None:
    log = EventRing(9, 4)
    yard = log.publish("upload", {}, "yard", "ann")
    hall = log.publish("upload", {}, "hall", "bob")
    lost = log.publish("no-fix", {}, None, "bob")
    disk = log.publish("alarm", {}, None)
    for who, seen in (
        (ANYONE, [yard, hall, lost, disk]),
        (principal("ann", "yard"), [yard]),
        (principal("bob", "hall"), [hall, lost]),
        (principal("eve", "h*"), [hall]),
    ):
        assert [each for each in log.after(0)[0] if each.is_visible_to(who)] == seen


def test_alarm_is_raised_and_cleared_once() -> None:
    log = EventRing(9, 4)
    assert log.set_alarm("store", None) is None
    assert log.set_alarm("store", "full") is not None
    assert log.set_alarm("store", "still full") is None
    assert [json.loads(each.data)["detail"] for each in log.alarms()] == ["full"]
    assert log.set_alarm("store", None) is not None
    assert log.alarms() == []
    told = [json.loads(each.data)["raised"] for each in log.after(0)[0]]
    assert told == [True, False]


def test_watch_looks_at_the_store_and_at_damaged_maps() -> None:
    log, now, trouble, damaged = EventRing(9, 4), [0.0], ["full"], ["yard"]
    watch = StoreWatch(log, lambda: trouble[0] or None, lambda: damaged, lambda: now[0])
    watch.check()
    watch.check()
    assert [(each.map, json.loads(each.data)["alarm"]) for each in log.alarms()] == [
        (None, "store"),
        ("yard", "map-damaged"),
    ]
    trouble[0] = ""
    damaged.clear()
    watch.check()  # too early
    assert len(log.alarms()) == 2
    now[0] += 11.0
    watch.check()
    assert log.alarms() == []
    assert log.last == 4


def test_refusals_are_counted_in_one_event_a_minute() -> None:
    log, now = EventRing(9, 4), [100.0]
    counter = RefusalCounter(lambda: now[0])
    for status in (401, 401, 403, 200, 404, 429):
        counter.add(status, log)
    now[0] += 61.0
    counter.add(429, log)
    told = [json.loads(each.data)["counts"] for each in log.after(0)[0]]
    assert told == [{"401": 1}, {"401": 1, "403": 1, "429": 2}]


def test_listener_is_woken_from_another_thread() -> None:
    async def scenario() -> None:
        log = EventRing(9, 4)
        with log.listening("a") as listener:
            assert not await listener.wait(0.01)
            threading.Timer(0.05, log.publish, ("robot", {}, "yard")).start()
            assert await listener.wait(5.0)
            log.close()
            assert await listener.wait(5.0)
        assert len(log) == 0

    asyncio.run(scenario())


def test_number_of_listeners_is_bounded_for_each_client_and_for_all() -> None:
    async def scenario() -> None:
        log = EventRing(9, 8)
        with log.listening("a"), log.listening("a"):
            with pytest.raises(Problem) as refused, log.listening("a"):
                pass
            assert refused.value.status == 429
            with log.listening("b"):
                assert len(log) == 3
        assert len(log) == 0

    asyncio.run(scenario())


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    service.put("/maps/yard", content=encode(map_of(random_codes(3), manifest.model_id)))
    return service


def test_stream_resumes_after_an_event(stocked: Any) -> None:
    log = stocked.app.state.placecell.engine.events
    assert listen(stocked) == []  # a new stream begins with what comes
    stocked.put("/robots/ann", json={"map": "yard", "position": [1, 2, 3], "reason": "<b>\n"})
    stocked.put("/maps/yard/tags", json={"tags": ["x"]})
    stocked.delete("/maps/yard")
    told = listen(stocked, {"Last-Event-ID": log.id_of(0)})
    assert [event.kind for event in told] == ["upload", "robot", "write", "write"]
    upload, robot, tags, deletion = told
    assert upload.data["map"] == "yard"
    assert (upload.data["operation"], upload.data["segments"]) == ("put", 3)
    assert (robot.data["robot"], robot.data["reason"]) == ("ann", "<b>\n")
    assert robot.data["position"] == [1, 2, 3]
    assert (tags.data["operation"], deletion.data["operation"]) == ("tags", "delete")
    rest = listen(stocked, {"Last-Event-ID": robot.id})
    assert [event.id for event in rest] == [tags.id, deletion.id]
    assert listen(stocked, {"Last-Event-ID": deletion.id}) == []


def test_lost_events_and_a_restart_are_told(start: Any) -> None:
    with start(limits={"events": 2}) as service:
        log = service.app.state.placecell.engine.events
        for number in range(5):
            log.publish("robot", {"n": number})
        missed, *rest = listen(service, {"Last-Event-ID": log.id_of(1)})
        assert (missed.kind, missed.data) == ("missed", {"missed": 2, "restarted": False})
        assert [event.data["n"] for event in rest] == [3, 4]
        (restarted,) = listen(service, {"Last-Event-ID": "00000000-3"})
        assert restarted.data == {"missed": None, "restarted": True}
        assert listen(service, {"Last-Event-ID": restarted.id}) == []


def test_standing_alarms_come_first(stocked: Any) -> None:
    log = stocked.app.state.placecell.engine.events
    # The service itself looks at the disk every ten seconds, and would end the alarm `store`.
    log.set_alarm("trial", "The disk is full.")
    (alarm,) = listen(stocked)
    assert (alarm.kind, alarm.data["raised"], alarm.id) == ("alarm", True, "")


def test_fix_and_no_fix_are_told(service: Any, manifest: Manifest) -> None:
    content = street_map(manifest)
    service.put("/maps/street", content=encode(content))
    body = by_codes(manifest, *seen_in(content))
    log = service.app.state.placecell.engine.events
    begun = log.id_of(log.last)
    service.post("/localize", json=body)  # neither robot nor session
    service.post("/localize", json=body | {"session": "s1"})
    service.post("/localize", json=body | {"robot": "ann"})
    service.post("/localize", json=body | {"robot": "ann", "tags": ["none"]})
    fix, also, lost = listen(service, {"Last-Event-ID": begun})
    assert (fix.kind, fix.data["session"], fix.data["robot"]) == ("fix", "s1", None)
    assert len(fix.data["inliers"]) >= 4
    assert (also.data["robot"], also.data["map"]) == ("ann", "street")
    assert also.data["probability"] > 0.9
    assert (lost.kind, lost.data["reason"]) == ("no-fix", "no map was searched")


def test_stream_shows_only_what_the_key_may_read(
    start: Any, tmp_path: Path, manifest: Manifest
) -> None:
    file = tmp_path / "keys.toml"
    all_maps = made(file, "all", "--write")
    hall = made(file, "hall", "--map", "hall")
    with start(keys_file=file) as service:
        log = service.app.state.placecell.engine.events
        for name in ("yard", "hall"):
            data = encode(map_of(random_codes(3), manifest.model_id))
            service.put(f"/maps/{name}", content=data, headers=all_maps)
        assert_problem(service.get("/events?seconds=0"), 401, "unauthorized")
        since = {"Last-Event-ID": log.id_of(0)}
        told = listen(service, hall | since)
        assert [(event.kind, event.data["map"]) for event in told] == [("upload", "hall")]
        everything = listen(service, all_maps | since)
        assert [event.kind for event in everything] == ["upload", "upload", "alarm"]
        assert everything[-1].data["counts"] == {"401": 1}


def test_head_and_wrong_parameters(stocked: Any) -> None:
    head = stocked.head("/events")
    assert (head.status_code, head.content) == (200, b"")
    assert_problem(stocked.get("/events?seconds=-1"), 422, "invalid-request")
    assert_problem(
        stocked.get("/events", headers={"Last-Event-ID": "x" * 41}), 422, "invalid-request"
    )


def test_too_many_streams_are_refused(start: Any) -> None:
    with start(limits={"event_clients": 1}) as service:
        done = threading.Thread(target=listen, args=(service, None, 1.0))
        done.start()
        log = service.app.state.placecell.engine.events
        while not len(log):
            time.sleep(0.01)
        refused = service.get("/events?seconds=0")
        assert_problem(refused, 429, "busy", "streams of events")
        assert "retry-after" in refused.headers
        assert "placecell_event_clients 1.0" in service.get("/metrics").text
        done.join()
        assert listen(service, None, 0.0) == []


def test_closed_log_ends_the_stream(stocked: Any) -> None:
    log = stocked.app.state.placecell.engine.events
    threading.Timer(0.3, log.close).start()
    (last,) = listen(stocked, None, 60.0)
    assert last.kind == "stopping"


def test_slow_listener_is_dropped_and_told(start: Any) -> None:
    async def scenario(app: Any) -> list[str]:
        log = app.state.placecell.engine.events
        sent: list[str] = []
        stalled = asyncio.Event()

        async def receive() -> dict[str, Any]:
            await asyncio.sleep(60)
            return {"type": "http.disconnect"}

        async def send(message: Any) -> None:
            sent.append(message.get("body", b"").decode())
            if len(sent) == 2:  # the client does not read for a while
                for number in range(10):
                    log.publish("robot", {"n": number})
                stalled.set()

        scope = {
            "type": "http", "method": "GET", "path": "/events", "raw_path": b"/events",
            "query_string": b"", "headers": [], "http_version": "1.1", "scheme": "http",
            "server": ("x", 80), "client": ("y", 1), "root_path": "",
        }  # fmt: skip
        await asyncio.wait_for(app(scope, receive, send), 10)
        return sent

    with start(limits={"events": 3}) as service:
        told = read("".join(asyncio.run(scenario(service.app))))
    assert [event.kind for event in told] == ["dropped"]
    assert told[0].data == {"missed": 7}
