"""Link through the HTTP client: which failures are worth another try."""

from dataclasses import replace

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import Client, MapCopy, ServiceError

from robot.core.link import FixRequest, LinkError, RefusedError
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus
from robot.service_link import ServiceLink, as_link_error, robot_client
from tests.client.client_fakes import Handler
from tests.robot.agent_fakes import at

REQUEST = FixRequest(
    time=0.0,
    meters=0.0,
    odom_pose=at(100.0),
    part=0,
    model_id="m",
    codes=np.ones((1, 2), np.int8),
    centroids=np.zeros((1, 3)),
    map="yard",
    session="one",
)


def link_of(handler: Handler) -> ServiceLink:
    client = robot_client("http://service", timeout=1.0)
    client._http = httpx.Client(transport=httpx.MockTransport(handler), base_url="http://service")
    return ServiceLink(client)


def refuses(status: int, kind: str = "some", **headers: str) -> Handler:
    def handler(request: httpx.Request) -> httpx.Response:
        content = {"type": f"urn:placecell:problem:{kind}", "title": "No", "detail": "not so"}
        return httpx.Response(
            status, json=content, headers={"content-type": "application/problem+json"} | headers
        )

    return handler


@pytest.mark.parametrize(
    ("status", "again"), [(429, True), (503, True), (504, True), (409, False), (404, False)]
)
def test_temporary_refusals_are_worth_another_try(status: int, again: bool) -> None:
    link = link_of(refuses(status, "other-frame", **{"Retry-After": "3"}))
    with pytest.raises(LinkError if again else RefusedError) as caught:
        link.upload("yard", b"delta", "ann", create=True)
    if isinstance(caught.value, LinkError):
        assert caught.value.was_reached
        assert caught.value.retry_after == 3.0
    else:
        assert isinstance(caught.value, RefusedError)
        assert (caught.value.status, caught.value.kind) == (status, "other-frame")


def test_request_states_the_classes_to_ignore_and_those_of_its_segments() -> None:
    sent: list[bytes] = []

    def handler(request: httpx.Request) -> httpx.Response:
        sent.append(request.content)
        return httpx.Response(503)

    asked = replace(
        REQUEST, classes=np.array([121], np.uint8), ignore=("movable",), heights=np.array([2.5])
    )
    for each in (asked, REQUEST):
        with pytest.raises(LinkError):
            link_of(handler).localize(each)
    body = msgpack.unpackb(sent[0])
    assert body["ignore"] == ["movable"]
    assert body["query_classes"] == b"y"
    assert body["heights"] == [2.5]
    assert {"ignore", "heights"}.isdisjoint(msgpack.unpackb(sent[1]))
    # From where the segments are seen, in the frame of the centroids.
    position = body["hints"]["sensor"]["position"]
    assert position == pytest.approx(REQUEST.odom_pose[:3, 3].tolist())


def test_unreachable_service_is_told_as_not_reached() -> None:
    def handler(request: httpx.Request) -> httpx.Response:
        raise httpx.ConnectError("no route")

    link = link_of(handler)
    calls = (
        lambda: link.upload("yard", b"", "ann", create=False),
        lambda: link.localize(REQUEST),
        lambda: link.pull(MapCopy("yard")),
        lambda: link.report("robot", AgentStatus(), None),
    )
    for call in calls:
        with pytest.raises(LinkError) as caught:
            call()
        assert not caught.value.was_reached


def test_unreadable_answer_is_worth_another_try() -> None:
    error = ServiceError(200, "Unreadable answer", "", "urn:placecell:problem:unreadable-answer")
    assert isinstance(as_link_error(error), LinkError)


def test_report_has_the_pose_and_the_state() -> None:
    sent: list[bytes] = []

    def handler(request: httpx.Request) -> httpx.Response:
        sent.append(request.content)
        return httpx.Response(503)

    link = link_of(handler)
    pose = MapToOdom(at(7.0), np.eye(6), "yard", 1.0)
    with pytest.raises(LinkError):
        link.report("robot", AgentStatus(time=1.0), pose)
    assert b"yard" in sent[0]
    assert b"starting" in sent[0]
    link.close()


def test_client_of_a_robot_tries_once() -> None:
    client = robot_client("http://service")
    assert isinstance(client, Client)
    client.close()
