"""Robots: their last reports, over HTTP and in memory."""

from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, Hints, NearHint, SensorPose, encode

from placecell.descriptors.manifest import Manifest
from service.core.auth import ANYONE, Key, Principal
from service.core.problems import Problem
from service.live.robots import RobotPose, RobotReport, Robots
from tests.service.core.test_auth import made
from tests.service.search.test_localize import TRUTH, by_codes, seen_in, street_map
from tests.service.service_builders import assert_problem, map_of, random_codes

POSE = {"map": "yard", "position": [1.0, 2.0, 0.5]}


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def report(robot: str = "ann", name: str | None = "yard", state: str = "localized") -> RobotReport:
    pose = None if name is None else RobotPose(name, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    return RobotReport(robot, pose, state, "", None, "report")


def principal(name: str, *maps: str, write: bool = True, robot: str | None = None) -> Principal:
    return Principal(name, Key(sha256="0" * 64, write=write, maps=maps or ("*",), robot=robot))


def test_report_without_pose_keeps_the_last_one() -> None:
    clock = Clock()
    robots = Robots(10, 60.0, clock)
    robots.report(report(), ANYONE)
    clock.now += 5.0
    told = robots.report(report(name=None, state="lost"), ANYONE)
    assert (told.report.state, told.age, told.pose_age) == ("lost", 0.0, 5.0)
    assert told.report.pose is not None
    assert told.report.pose.map == "yard"


def test_old_robots_are_dropped() -> None:
    clock = Clock()
    robots = Robots(10, 60.0, clock)
    robots.report(report("ann"), ANYONE)
    clock.now += 40.0
    robots.report(report("bob"), ANYONE)
    clock.now += 40.0
    assert [each.report.robot for each in robots.all(ANYONE)] == ["bob"]
    assert len(robots) == 1
    with pytest.raises(Problem, match="No robot 'ann'") as refused:
        robots.get("ann", ANYONE)
    assert refused.value.status == 404


def test_key_with_most_robots_loses_its_oldest() -> None:
    robots = Robots(3, 60.0)
    robots.report(report("own"), principal("small"))
    for number in range(5):
        robots.report(report(f"r{number}"), principal("large"))
    assert [each.report.robot for each in robots.all(ANYONE)] == ["own", "r3", "r4"]


def test_key_sees_robots_in_its_maps_and_its_own() -> None:
    robots = Robots(10, 60.0)
    robots.report(report("ann", "yard"), principal("a", "yard"))
    robots.report(report("bob", "hall"), principal("b", "hall"))
    robots.report(report("eve", None), principal("b", "hall"))

    def seen(who: Principal) -> list[str]:
        return [each.report.robot for each in robots.all(who)]

    assert seen(ANYONE) == ["ann", "bob", "eve"]
    assert seen(principal("a", "yard")) == ["ann"]
    assert seen(principal("b", "hall")) == ["bob", "eve"]
    assert seen(principal("c", "hall", write=False)) == ["bob"]
    with pytest.raises(Problem):
        robots.get("eve", principal("a", "yard"))


def test_key_cannot_take_over_a_robot_that_it_does_not_see() -> None:
    robots = Robots(10, 60.0)
    robots.report(report("ann", "yard"), principal("a", "yard"))
    with pytest.raises(Problem, match="Another key reports") as refused:
        robots.report(report("ann", "hall"), principal("b", "hall"))
    assert refused.value.status == 403
    told = robots.get("ann", principal("a", "yard")).report.pose
    assert told is not None
    assert told.map == "yard"


@pytest.mark.parametrize(
    ("who", "robot", "allowed"),
    [
        (principal("w"), "ann", True),
        (principal("r", write=False), "ann", False),
        (principal("bound", write=False, robot="ann"), "ann", True),
        (principal("bound", write=True, robot="ann"), "bob", False),
    ],
)
def test_keys_that_may_report(who: Principal, robot: str, allowed: bool) -> None:
    robots = Robots(10, 60.0)
    if allowed:
        robots.report(report(robot), who)
        return
    with pytest.raises(Problem) as refused:
        robots.report(report(robot), who)
    assert refused.value.status == 403


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    service.put("/maps/yard", content=encode(map_of(random_codes(3), manifest.model_id)))
    return service


@pytest.fixture
def client(stocked: Any) -> Client:
    def forward(request: httpx.Request) -> httpx.Response:
        told = stocked.request(
            request.method, str(request.url), content=request.content, headers=request.headers
        )
        return httpx.Response(told.status_code, content=told.content, headers=told.headers)

    return Client("http://127.0.0.1", transport=httpx.MockTransport(forward))


def test_reported_pose_is_listed(client: Client) -> None:
    assert client.robots() == ()
    quarter = [0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)]
    sent = client.report_pose(
        "ann", "yard", (1, 2, 3), quarter, np.eye(4), probability=0.99, time=1.7e9
    )
    (told,) = client.robots()
    assert (told.robot, told.map, told.state, told.source) == (
        "ann",
        "yard",
        "localized",
        "report",
    )
    assert told.position is not None
    assert told.position.tolist() == [1, 2, 3]
    assert told.orientation is not None
    np.testing.assert_allclose(told.orientation, quarter)
    assert told.covariance is not None
    np.testing.assert_array_equal(told.covariance, np.eye(4))
    assert (told.probability, told.time, sent.robot) == (0.99, 1.7e9, "ann")
    assert 0 <= told.age < 10
    lost = client.report_pose("ann", state="lost", reason="carried away")
    assert (lost.state, lost.reason, lost.map) == ("lost", "carried away", "yard")
    assert client.robot("ann").pose_age is not None


def test_robots_are_listed_in_pages(stocked: Any, client: Client) -> None:
    for name in ("c", "a", "b"):
        client.report_pose(name, "yard", (0, 0, 0))
    page = stocked.get("/robots", params={"limit": 2}).json()
    assert [each["robot"] for each in page["robots"]] == ["a", "b"]
    assert page["next"] == "b"
    rest = stocked.get("/robots", params={"limit": 2, "after": "b"}).json()
    assert ([each["robot"] for each in rest["robots"]], rest["next"]) == (["c"], None)


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ({"map": "nowhere", "position": [0, 0, 0]}, "/map"),
        ({"map": "yard"}, ""),
        ({"position": [0, 0, 0]}, ""),
        (POSE | {"position": [0, 0]}, "/position"),
        (POSE | {"position": [0, 0, 1e300]}, "/position/2"),
        (POSE | {"orientation": [0, 0, 0, 0]}, ""),
        (POSE | {"covariance": [[1, 0, 0]] * 4}, ""),
        (POSE | {"covariance": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]}, ""),
        (POSE | {"covariance": [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}, ""),
        (POSE | {"covariance": [[1, 0, 0], [0, 1, 0], [0, 0, 1e300]]}, ""),
        (POSE | {"time": 1e300}, "/time"),
        (POSE | {"state": "<script>"}, "/state"),
        (POSE | {"reason": "x" * 201}, "/reason"),
        (POSE | {"probability": 1.5}, "/probability"),
        (POSE | {"speed": 3}, "/speed"),
    ],
)
def test_wrong_report_is_refused_with_its_place(
    stocked: Any, body: dict[str, Any], pointer: str
) -> None:
    response = stocked.put("/robots/ann", json=body)
    assert_problem(response, 422, "invalid-request")
    assert any(each["pointer"].startswith(pointer) for each in response.json()["errors"])
    assert stocked.get("/robots").json()["robots"] == []


def test_report_that_is_not_json_and_wrong_names_are_refused(stocked: Any) -> None:
    headers = {"Content-Type": "application/json"}
    assert_problem(stocked.put("/robots/ann", content=b"{", headers=headers), 400, "not-json")
    infinite = b'{"map": "yard", "position": [0, 0, Infinity]}'
    refused = stocked.put("/robots/ann", content=infinite, headers=headers)
    assert refused.status_code in {400, 422}
    assert_problem(stocked.put("/robots/a%20b", json=POSE), 422, "invalid-name")
    assert_problem(stocked.get("/robots/nobody"), 404, "unknown-robot")


def test_localization_with_a_robot_reports_the_pose_of_its_sensor(
    service: Any, manifest: Manifest
) -> None:
    content = street_map(manifest)
    service.put("/maps/street", content=encode(content))
    body = by_codes(manifest, *seen_in(content))
    sensor = SensorPose((3.0, 0.0, 1.0), 0.5)
    there = TRUTH.apply(np.array(sensor.position))
    hints = Hints(near=NearHint(there, 2.0), sensor=sensor).as_dict()
    service.post("/localize", json=body | {"robot": "ann", "hints": hints})
    told = service.get("/robots/ann").json()
    assert (told["map"], told["state"], told["source"]) == ("street", "localized", "localize")
    np.testing.assert_allclose(told["position"], there, atol=0.05)
    *_, k, w = told["orientation"]
    assert 2 * np.arctan2(k, w) == pytest.approx(TRUTH.yaw + 0.5, abs=0.01)
    assert told["probability"] > 0.9
    assert np.shape(told["covariance"]) == (4, 4)
    lost = by_codes(manifest, random_codes(40, 99), np.array(body["centroids"]))
    service.post("/localize", json=lost | {"robot": "ann"})
    told = service.get("/robots/ann").json()
    assert (told["state"], told["reason"], told["map"]) == (
        "not-localized",
        "too-few-segments",
        "street",
    )


def test_key_bound_to_a_robot_reports_it_by_localizing(
    start: Any, tmp_path: Path, manifest: Manifest
) -> None:
    file = tmp_path / "keys.toml"
    bound = made(file, "robot-7", "--robot", "seven")
    reader, writer = made(file, "reader"), made(file, "writer", "--write")
    content = street_map(manifest)
    body = by_codes(manifest, *seen_in(content))
    with start(keys_file=file) as service:
        service.put("/maps/street", content=encode(content), headers=writer)
        assert service.post("/localize", json=body, headers=bound).status_code == 200
        assert service.get("/robots/seven", headers=reader).json()["map"] == "street"
        other = body | {"robot": "eight"}
        for headers in (bound, reader):
            assert_problem(service.post("/localize", json=other, headers=headers), 403, "forbidden")
        assert service.post("/localize", json=other, headers=writer).status_code == 200
        listed = service.get("/robots", headers=reader).json()["robots"]
        assert [each["robot"] for each in listed] == ["eight", "seven"]
        assert "placecell_robots 2.0" in service.get("/metrics").text
