"""Routes of `/robots`: the last pose and state of each robot."""

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import JSON, read_json_body, render
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.openapi import json_body
from service.api.path_parameters import RobotName
from service.api.schemas.robots import RobotOut, RobotReportIn, RobotsResponse
from service.core.problems import invalid_value
from service.live.robots import RobotPose, RobotReport, RobotStatus

router = APIRouter(tags=["robots"])


@router.put(
    "/robots/{robot}",
    summary="Report the pose of a robot",
    responses=documented(400, 401, 403, 408, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=json_body(RobotReportIn),
)
async def report_robot(
    robot: RobotName,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    timing: TimingOf,
) -> RobotOut:
    """Store the robot's pose and state in memory; they replace its last report.

    A key that is bound to a robot reports this robot; any other key needs write access. A report
    without a pose keeps the last pose, whose age then grows.
    """
    principal.check_reports(robot)
    async with state.lanes.reads.admit(request, (JSON,), timing) as body:
        asked = read_json_body(RobotReportIn, body.content)
        pose = None
        if asked.map is not None and asked.position is not None:
            principal.check_map(asked.map)
            if state.engine.maps.entry(asked.map) is None:
                detail = f"No map is named {asked.map!r:.80}. GET /maps lists the maps."
                raise invalid_value("/map", detail)
            rows = asked.covariance
            pose = RobotPose(
                map=asked.map,
                position=asked.position,
                orientation=asked.orientation,
                covariance=None if rows is None else tuple(map(tuple, rows)),
                probability=asked.probability,
            )
        report = RobotReport(robot, pose, asked.state, asked.reason, asked.time, "report")
        told = robot_of(state.engine.robots.report(report, principal))
        state.engine.events.publish("robot", told, told["map"], principal.name)
        return RobotOut(**told)


@router.get(
    "/robots",
    summary="List the robots",
    response_model=RobotsResponse,
    responses=documented(400, 401, 422, 429, 500, 503, 504),
)
async def list_robots(
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    limit: Annotated[
        int, Query(ge=1, le=1_000, description="Largest number of robots in the answer.")
    ] = 1_000,
    after: Annotated[
        str, Query(max_length=64, description="Name after which the answer begins.")
    ] = "",
) -> Response:
    """Return the last report of each robot whose map the key may read, by name.

    Reports are in memory: after a restart the list is empty until robots report again. A robot
    without a report for `limits.robot_seconds` is dropped.
    """
    async with state.lanes.reads.enter(request):
        found = [each for each in state.engine.robots.all(principal) if each.report.robot > after]
        content = {
            "robots": [robot_of(each) for each in found[:limit]],
            "next": found[limit - 1].report.robot if len(found) > limit else None,
        }
        return await state.answers.respond(render(content, JSON), client_of(request), JSON)


@router.get(
    "/robots/{robot}",
    summary="Read the pose of a robot",
    responses=documented(400, 401, 404, 422, 429, 500, 503, 504),
)
async def get_robot(
    robot: RobotName, request: Request, state: StateOf, principal: PrincipalOf
) -> RobotOut:
    """Return the last report of a robot, with its last pose."""
    async with state.lanes.reads.enter(request):
        return RobotOut(**robot_of(state.engine.robots.get(robot, principal)))


def robot_of(status: RobotStatus) -> dict[str, Any]:
    """Return a robot's status as a `RobotOut`."""
    report, pose = status.report, status.report.pose
    return {
        "robot": report.robot,
        "map": None if pose is None else pose.map,
        "position": None if pose is None else [*pose.position],
        "orientation": None if pose is None else [*pose.orientation],
        "covariance": None if pose is None else pose.covariance,
        "probability": None if pose is None else pose.probability,
        "state": report.state,
        "reason": report.reason,
        "time": report.time,
        "age": status.age,
        "pose_age": status.pose_age,
        "source": report.source,
    }
