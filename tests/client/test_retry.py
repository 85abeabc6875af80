"""Retries of both clients: which calls, after which waits, until when."""

import random
from collections.abc import Callable, Iterable
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Delta, Retries, ServiceError
from placecell_client.http.attempts import Attempt
from placecell_client.http.deadline import Deadline

from tests.client.client_fakes import INFO, SUMMARY, Blocking, Time, client_of
from tests.client.map_builders import random_map

Make = Callable[..., Any]
Outcome = httpx.Response | Exception
OK = httpx.Response(200, json=INFO)
EDIT = Delta(random_map(), np.zeros(0, np.uint32))


@pytest.fixture(params=[client_of, Blocking], ids=["sync", "async"])
def make(request: pytest.FixtureRequest) -> Make:
    maker: Make = request.param
    return maker


class Service:
    """Transport with scripted outcomes; the last one repeats. It keeps the requests."""

    def __init__(self, *outcomes: Outcome) -> None:
        self.outcomes = list(outcomes)
        self.requests: list[httpx.Request] = []

    def __call__(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        outcome = self.outcomes[min(len(self.requests), len(self.outcomes)) - 1]
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    def sent(self, header: str) -> list[str]:
        return [request.headers[header] for request in self.requests]


def busy(status: int = 503, headers: dict[str, str] | None = None) -> httpx.Response:
    problem = {"type": "urn:busy", "title": "Busy", "status": status, "detail": "Come back."}
    return httpx.Response(status, json=problem, headers=headers)


def after(value: str, **headers: str) -> httpx.Response:
    return busy(503, headers | {"Retry-After": value})


PASSING: Iterable[Outcome] = [
    busy(429), busy(502), busy(503), busy(504), httpx.Response(502, html="<h1>Bad gateway</h1>"),
    httpx.ConnectError("refused"), httpx.ConnectTimeout("silent"), httpx.ReadTimeout("silent"),
    httpx.WriteError("reset"), httpx.RemoteProtocolError("closed in the middle"),
]  # fmt: skip


@pytest.mark.parametrize("passing", PASSING, ids=repr)
def test_temporary_failure_is_repeated(make: Make, passing: Outcome) -> None:
    time, service = Time(), Service(passing, passing, OK)
    assert make(service, time).info().model_id == "m"
    assert time.slept == [0.1, 0.2]


@pytest.mark.parametrize("status", [300, 400, 401, 404, 409, 413, 422, 500, 501, 507, 599])
def test_permanent_failure_is_not_repeated(make: Make, status: int) -> None:
    time, service = Time(), Service(busy(status, {"Retry-After": "1"}))
    with pytest.raises(ServiceError) as raised:
        make(service, time).info()
    assert (raised.value.status, raised.value.retry_after) == (status, 1)
    assert len(service.requests) == 1
    assert not time.slept


@pytest.mark.parametrize("error", [httpx.UnsupportedProtocol("ftp"), httpx.LocalProtocolError("")])
def test_error_of_the_caller_is_not_repeated(make: Make, error: Exception) -> None:
    service = Service(error)
    with pytest.raises(type(error)):
        make(service).info()
    assert len(service.requests) == 1


@pytest.mark.parametrize("last", [busy(), httpx.ReadError("reset")], ids=repr)
def test_attempts_end_with_the_last_error(make: Make, last: Outcome) -> None:
    time, service = Time(), Service(httpx.ConnectError("refused"), busy(429), last)
    with pytest.raises((ServiceError, httpx.TransportError)) as raised:
        make(service, time, retries=Retries(attempts=3)).info()
    if isinstance(last, Exception):
        assert raised.value is last
    else:
        assert isinstance(raised.value, ServiceError)
        assert (raised.value.status, raised.value.detail) == (503, "Come back.")
    assert len(service.requests) == 3
    assert len(time.slept) == 2


def test_waits_grow_up_to_the_longest(make: Make) -> None:
    time, service = Time(), Service(busy())
    retries = Retries(attempts=7, first_wait=0.5, longest_wait=3)
    with pytest.raises(ServiceError):
        make(service, time, retries=retries).info()
    assert time.slept == [0.5, 1, 2, 3, 3, 3]


def test_waits_are_drawn_from_zero_to_the_bound(make: Make) -> None:
    time, service = Time(), Service(busy())
    with pytest.raises(ServiceError):
        make(service, time, jitter=random.Random(7).random).info()
    draws = random.Random(7)
    assert time.slept == [draws.random() * longest for longest in (0.1, 0.2, 0.4, 0.8)]


def test_wait_after_very_many_attempts_is_finite() -> None:
    assert Retries(attempts=10**9).wait(10**9, 1.0) == 10


@pytest.mark.parametrize(
    ("value", "seconds"),
    [
        ("7", 7),
        (" 12 ", 12),
        ("0", 0),
        ("Wed, 21 Oct 2026 07:28:10 GMT", 10),
        ("Wed, 21 Oct 2026 07:27:10 GMT", 0),
        ("Wednesday, 21-Oct-26 07:28:10 GMT", 10),
        ("Wed, 21 Oct 2026 07:28:10 -0000", 10),
    ],
)
def test_retry_after_is_the_shortest_wait(make: Make, value: str, seconds: float) -> None:
    # The date is relative to the service's clock; the robot's clock may be wrong.
    time = Time()
    service = Service(after(value, Date="Wed, 21 Oct 2026 07:28:00 GMT"), OK)
    make(service, time).info()
    assert time.slept == [pytest.approx(seconds + 0.1)]


def test_retry_after_date_uses_the_robots_clock_without_a_date_header(make: Make) -> None:
    time = Time()
    make(Service(after("Wed, 21 Oct 2015 07:28:00 GMT"), OK), time).info()
    assert time.slept == [0.1]
    with pytest.raises(ServiceError) as raised:
        make(Service(after("Fri, 21 Oct 2250 07:28:00 GMT"), OK), time).info()
    assert raised.value.retry_after is not None
    assert raised.value.retry_after > 86400


@pytest.mark.parametrize("value", ["", "soon", "-1", "1.5", "1e3", "9" * 5000, "Wed, 99 Oct 2026"])
def test_invalid_retry_after_is_ignored(make: Make, value: str) -> None:
    time = Time()
    make(Service(after(value), OK), time).info()
    assert time.slept == [0.1]


def test_wait_beyond_the_deadline_is_not_started(make: Make) -> None:
    time, service = Time(), Service(after("31"))
    with pytest.raises(ServiceError) as raised:
        make(service, time, timeout=30).info()
    assert raised.value.retry_after == 31
    assert not time.slept
    time, service = Time(), Service(after("10"))
    with pytest.raises(ServiceError):
        make(service, time, timeout=30).info()
    assert len(service.requests) == 3
    assert sum(time.slept) < 30


def test_too_long_sleep_ends_the_call(make: Make) -> None:
    service = Service(busy())

    class Slow(Time):
        def sleep(self, seconds: float) -> None:
            super().sleep(seconds + 60)

    with pytest.raises(ServiceError, match="Come back"):
        make(service, Slow(), timeout=30).info()
    assert len(service.requests) == 1


def test_attempts_send_their_timeout(make: Make) -> None:
    time, service = Time(), Service(after("4"), after("20"), OK)
    make(service, time, timeout=30).info()
    assert service.sent("Placecell-Timeout") == ["30.000", "25.900", "5.700"]
    allowed = [request.extensions["timeout"]["read"] for request in service.requests]
    assert allowed == pytest.approx([30, 25.9, 5.7])


def test_attempts_may_be_shorter_than_the_call(make: Make) -> None:
    time, service = Time(), Service(after("28"), OK)
    make(service, time, timeout=30, retries=Retries(longest_attempt=5)).info()
    assert service.sent("Placecell-Timeout") == ["5.000", "1.900"]


def test_each_step_of_httpx_gets_the_remaining_time(make: Make) -> None:
    time = Time()
    left = []

    def answer(request: httpx.Request) -> httpx.Response:
        timeouts = request.extensions["timeout"]
        for step in ("connect", "write", "read"):
            left.append(timeouts.get(step))
            time.now += 9
        return OK

    assert make(answer, time, timeout=30).info()
    assert left == [30, 21, 12]


def test_body_is_sent_until_the_deadline() -> None:
    time = Time()
    parts = Attempt("PUT", "/maps/yard", {}, bytes(200_000), Deadline(1, time.clock)).parts()
    assert parts is not None
    sent = len(next(parts))
    time.now += 0.9
    sent += len(next(parts))
    assert 0 < sent < 200_000
    time.now += 0.2
    with pytest.raises(httpx.WriteTimeout):
        next(parts)


def test_all_attempts_of_a_call_have_the_same_id(make: Make) -> None:
    service = Service(busy(), httpx.ConnectError("refused"), busy(500))
    client = make(service)
    with pytest.raises(ServiceError) as raised:
        client.info()
    ids = service.sent("X-Request-Id")
    assert ids == [raised.value.request_id] * 3
    assert len(ids[0]) == 32
    with pytest.raises(ServiceError) as again:
        client.info()
    assert again.value.request_id not in ids


def test_connection_errors_end_with_the_request_id(make: Make) -> None:
    service = Service(*[httpx.ConnectError("refused")] * 9)
    with pytest.raises(httpx.ConnectError) as raised:
        make(service).info()
    (request_id,) = set(service.sent("X-Request-Id"))
    assert str(raised.value).endswith(f" (request {request_id})")


@pytest.mark.parametrize("compress", [False, True])
def test_repeated_uploads_are_the_same_bytes(make: Make, compress: bool) -> None:
    stored = httpx.Response(200, json=SUMMARY)
    service = Service(httpx.ReadError("reset"), busy(), stored)
    assert make(service, compress=compress).put_map("yard", random_map()).name == "yard"
    assert len(service.requests) == 3
    assert len({request.content for request in service.requests}) == 1
    content = service.requests[0].content
    assert service.sent("Content-Length") == [str(len(content))] * 3
    assert all("Transfer-Encoding" not in request.headers for request in service.requests)


def test_repeated_delete_with_404_succeeds(make: Make) -> None:
    unknown = busy(404)
    make(Service(httpx.ReadTimeout("lost"), unknown)).delete_map("yard", "e-3")
    make(Service(httpx.ReadTimeout("lost"), busy(429), unknown)).delete_map("yard", "e-3")
    for before in ([], [httpx.ConnectError("refused")], [busy(429)]):
        # The service has received no DELETE before this one.
        with pytest.raises(ServiceError) as raised:
            make(Service(*before, unknown)).delete_map("yard", "e-3")
        assert raised.value.status == 404
    with pytest.raises(ServiceError) as raised:
        make(Service(httpx.ReadTimeout("lost"), unknown)).get_map("yard")
    assert raised.value.status == 404


WRITTEN_OVER: dict[str, Callable[[Any], Any]] = {
    "restore": lambda client: client.restore_map("yard", 3),
    "restore any": lambda client: client.restore_map("yard", 3, "*"),
    "put": lambda client: client.put_map("yard", random_map(), if_match="*"),
    "edit": lambda client: client.edit_map("yard", EDIT, if_match="*"),
    "age": lambda client: client.prune_map("yard", 1.5),
    "merge": lambda client: client.merge_maps("site", ["yard"]),
    "merge into any": lambda client: client.merge_maps("site", ["yard"], if_match="*"),
    "compact": lambda client: client.compact_map("yard"),
    "delete": lambda client: client.delete_map("yard"),
}
"""Calls that would undo later writes of others if they were repeated."""
REPEATED: dict[str, Callable[[Any], Any]] = {
    "restore": lambda client: client.restore_map("yard", 3, "e-3"),
    "put": lambda client: client.put_map("yard", random_map(), if_match="e-3"),
    "put new": lambda client: client.put_map("yard", random_map()),
    "edit": lambda client: client.edit_map("yard", EDIT, if_match="e-3"),
    "edit own": lambda client: client.edit_map("yard", EDIT),
    "age": lambda client: client.prune_map("yard", 1.5, if_match="e-3"),
    "would age": lambda client: client.prune_map("yard", 1.5, dry_run=True),
    "delete": lambda client: client.delete_map("yard", "e-3"),
    "ids": lambda client: client.reserve_ids("yard", 3),
    "align": lambda client: client.align_maps("yard", "hall"),
    "merge": lambda client: client.merge_maps("site", ["yard"], if_match="e-3"),
    "would merge": lambda client: client.merge_maps("site", ["yard"], dry_run=True),
}
UNKNOWN: list[Outcome] = [
    busy(502), busy(503), busy(504), httpx.ReadTimeout("silent"), httpx.ReadError("reset"),
    httpx.WriteError("reset"), httpx.RemoteProtocolError("closed in the middle"),
]  # fmt: skip
UNDONE: list[Outcome] = [
    busy(429), httpx.ConnectError("refused"), httpx.ConnectTimeout("silent"),
    httpx.PoolTimeout("all are in use"),
]  # fmt: skip


@pytest.mark.parametrize("outcome", UNKNOWN, ids=repr)
@pytest.mark.parametrize("call", WRITTEN_OVER)
def test_unsafe_write_that_may_be_done_is_not_repeated(
    make: Make, call: str, outcome: Outcome
) -> None:
    time, service = Time(), Service(busy(429), outcome)
    with pytest.raises((ServiceError, httpx.TransportError)) as raised:
        WRITTEN_OVER[call](make(service, time))
    if isinstance(outcome, Exception):
        assert raised.value is outcome
    else:
        assert isinstance(raised.value, ServiceError)
        assert raised.value.status == outcome.status_code
    assert len(service.requests) == 2


@pytest.mark.parametrize("call", WRITTEN_OVER)
def test_unsafe_write_that_was_not_done_is_repeated(make: Make, call: str) -> None:
    service = Service(*UNDONE, busy(400))
    with pytest.raises(ServiceError) as raised:
        WRITTEN_OVER[call](make(service))
    assert raised.value.status == 400
    assert len(service.requests) == len(UNDONE) + 1


@pytest.mark.parametrize("call", REPEATED)
def test_safe_write_is_repeated(make: Make, call: str) -> None:
    service = Service(*UNKNOWN, busy(400))
    with pytest.raises(ServiceError) as raised:
        REPEATED[call](make(service, retries=Retries(attempts=9)))
    assert raised.value.status == 400
    assert len(service.requests) == len(UNKNOWN) + 1


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"attempts": 0}, "attempts"),
        ({"first_wait": -1}, "first_wait"),
        ({"longest_wait": float("nan")}, "longest_wait"),
        ({"longest_attempt": 0}, "longest_attempt"),
    ],
)
def test_invalid_retries_are_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Retries(**wrong)


@pytest.mark.parametrize("timeout", [0, -1, float("nan"), float("inf")])
def test_invalid_timeout_is_refused(make: Make, timeout: float) -> None:
    with pytest.raises(ValueError, match="timeout"):
        make(Service(OK), timeout=timeout).info()
