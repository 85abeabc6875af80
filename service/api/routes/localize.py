"""`/localize`: segments in, the robot's pose out."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from fastapi import APIRouter, Request, Response

from placecell.core.types import Float64
from placecell.localization import Hypothesis, LocalizationParameters
from placecell.localization.advice import advice_of
from placecell.localization.localize import places_of
from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, Body, answer_type, parse, render
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.geoposes import MEDIA_TYPE as GEOPOSE
from service.api.geoposes import geopose_of
from service.api.openapi import body_of, packed_response
from service.api.query_parsing import read_query
from service.api.responses import pose_of, segment_error, skipped_maps
from service.api.schemas.anchors import GeoPose
from service.api.schemas.localization import LocalizeQuery, LocalizeRequest, LocalizeResponse
from service.api.schemas.msgpack import PackedLocalizeRequest
from service.api.state import State
from service.core.auth import Principal
from service.core.problems import Problem
from service.core.timing import Timing
from service.inference.describer import Descriptors
from service.live.robots import RobotReport
from service.maps.snapshot import MapSnapshot
from service.search.hints import AnchorOf
from service.search.localization import LocalizationResult, MapLocalization, report_of
from service.search.query import Query

INLIERS = 200
"""Largest number of inliers in an event: a page draws them."""

router = APIRouter(tags=["recognition"])

LocalizeBody = LocalizeQuery[Any, Any, Any, Any]


@router.post(
    "/localize",
    summary="Localize a robot in maps",
    response_model=LocalizeResponse,
    responses=packed_response(LocalizeResponse, GEOPOSE, GeoPose)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=body_of(LocalizeRequest, PackedLocalizeRequest),
)
async def localize(
    request: Request, state: StateOf, principal: PrincipalOf, timing: TimingOf
) -> Response:
    """Return the robot's pose in each map's frame, or the reason for none; most probable first.

    Send all segments around the robot, in one frame. Candidates of all segments are searched in
    all maps at once, and those that agree with each other give the pose. The maps are judged
    together: a place that fits nearly as well as the best one makes the answer *ambiguous*, also
    if it is in another map. `rival` then names that map and its pose. A merged map and its sources
    are one place. At most eight maps, those in which most segments agree, are searched in full;
    `detail` says where a map was not.
    """
    answer = answer_type(request, (*ENCODINGS, GEOPOSE))
    async with state.lanes.recognition.admit(request, ENCODINGS, timing) as body:
        asked, query = await state.run(_read, state, principal, body, timing)
        request.state.model_id = query.model_id
        descriptors = await query.describe(timing)
        content = await state.run(
            _search, state, principal, asked, query, descriptors, answer, timing
        )
    return await state.answers.respond(content, client_of(request), answer)


def _read(
    state: State, principal: Principal, body: Body, timing: Timing
) -> tuple[LocalizeBody, Query]:
    timing.lap("queue")
    request = parse(LocalizeRequest, PackedLocalizeRequest, body, state.settings.limits)
    if request.robot is not None:
        principal.check_reports(request.robot)
    return request, read_query(state, principal, request, timing)


def _search(
    state: State,
    principal: Principal,
    request: LocalizeBody,
    query: Query,
    descriptors: Sequence[Descriptors],
    answer: str,
    timing: Timing,
) -> bytes:
    timing.lap("queue")
    result = state.engine.poses(
        query=query,
        descriptors=descriptors,
        timing=timing,
        parameters=LocalizationParameters(
            model=request.motion, max_false_acceptance=request.max_false_acceptance
        ),
        session=request.session,
        principal=principal,
        hints=None if request.hints is None else request.hints.hints(),
    )
    robot = request.robot or principal.key.robot
    if robot is not None or request.session is not None:
        report = report_of(robot or "", result)
        if robot is not None:
            state.engine.robots.report(report, principal)
        _publish(state, principal, robot, request.session, report, result)
    anchor_of = state.engine.annotations.geo_anchor
    content = render(
        _geopose(result, anchor_of) if answer == GEOPOSE else _response(result, anchor_of), answer
    )
    timing.lap("encode")
    return content


def _publish(
    state: State,
    principal: Principal,
    robot: str | None,
    session: str | None,
    report: RobotReport,
    result: LocalizationResult,
) -> None:
    """Publish the answer to a robot or a session as an event."""
    who = {"robot": robot, "session": session}
    pose = report.pose
    if pose is None:
        told = who | {"reason": report.reason}
        state.engine.events.publish("no-fix", told, None, principal.name)
    else:
        told = who | asdict(pose) | {"inliers": _inlier_ids(result)}
        state.engine.events.publish("fix", told, pose.map, principal.name)


def _inlier_ids(result: LocalizationResult) -> list[int]:
    """Return the ids of the map's segments that agree with the best pose, at most `INLIERS`."""
    best = result[0].localization.best
    assert best is not None  # the robot has a pose
    ids = result[0].snapshot.layers.column("ids", best.rows[:INLIERS])
    return [int(id_) for id_ in ids]


def _geopose(result: LocalizationResult, anchor_of: AnchorOf) -> dict[str, Any]:
    """Return the most probable pose as a `GeoPose`.

    Raises:
        Problem: 409 if the robot is not localized, or in no map with a WGS 84 anchor.
    """
    found = [each for each in result.maps if each.localization.pose is not None]
    for each in found:
        assert each.localization.pose is not None
        geopose = geopose_of(each.localization.pose, anchor_of(each.snapshot))
        if geopose is not None:
            return geopose
    if found:
        raise Problem(
            409,
            "no-anchor",
            f"The robot is in map {found[0].snapshot.name!r:.80}, which has no WGS 84 anchor, or "
            "is too far from it. Set one: PUT /maps/{map}/anchor.",
        )
    best = result[0] if len(result) else None
    if best is None:
        raise Problem(409, "not-localized", "No map was searched. GET /maps lists the maps.")
    told = best.localization
    raise Problem(
        409,
        "not-localized",
        f"The robot is not localized ({told.reason}). {told.detail} {advice_of(told).text}",
    )


def _response(result: LocalizationResult, anchor_of: AnchorOf) -> dict[str, Any]:
    """Return the same as a `LocalizeResponse`, without its checks: the values are our own."""
    return {
        "model_id": result.model_id,
        "localizations": [_localization(each, anchor_of) for each in result.maps],
        "unusable": [
            {"query": index, **segment_error(error)} for index, error in result.errors.items()
        ],
        "dropped_points": result.dropped_points,
        "skipped": skipped_maps(result.selection),
        "hints": None if result.hints is None else asdict(result.hints),
    }


def _localization(answer: MapLocalization, anchor_of: AnchorOf) -> dict[str, Any]:
    """Return the localization in one map, as a `LocalizationOut`."""
    found, snapshot, rival = answer.localization, answer.snapshot, answer.judged.rival
    best, pose = found.best, found.pose
    inliers: list[dict[str, Any]] = []
    if best is not None and pose is not None:
        queries = answer.segments[best.queries]
        ids = snapshot.layers.column("ids", best.rows)
        inliers = [
            {"query": query, "id": id_, "residual": residual}
            for query, id_, residual in zip(
                queries.tolist(), ids.tolist(), best.residuals.tolist(), strict=True
            )
        ]
    others = [found.second] if pose is not None else [best, found.second]
    return {
        "map": snapshot.name,
        "frame": snapshot.frame,
        "localized": pose is not None,
        "reason": found.reason,
        "detail": found.detail,
        **_advice(answer),
        "probability": found.probability,
        "threshold": found.threshold,
        "max_false_acceptance": found.risk,
        "pose": None if pose is None else pose_of(pose),
        "geopose": None if pose is None else geopose_of(pose, anchor_of(snapshot)),
        "covariance": None if pose is None or best is None else best.covariance.tolist(),
        "score": 0.0 if best is None else best.score,
        "inliers": inliers,
        "others": [_hypothesis(each) for each in others if each is not None],
        "rival": None
        if rival is None or answer.rival is None
        else {"map": answer.rival.name, "frame": answer.rival.frame}
        | _hypothesis(rival.hypothesis),
    }


def _advice(answer: MapLocalization) -> dict[str, Any]:
    """Return what helps a robot that is not localized."""
    found, snapshot, rival = answer.localization, answer.snapshot, answer.judged.rival
    advice = advice_of(found)
    places: list[dict[str, Any]] = []
    apart = None
    if found.reason == "ambiguous" and found.best is not None:
        other, hypothesis = snapshot, found.second
        if answer.judged.is_between_maps and answer.rival is not None and rival is not None:
            other, hypothesis = answer.rival, rival.hypothesis
        assert hypothesis is not None  # an ambiguous pose has a second one
        here, there = places_of(found.best, hypothesis)
        places = [_place(snapshot, found.best, here), _place(other, hypothesis, there)]
        if other is snapshot:
            apart = float(np.linalg.norm(here - there))
    return {
        "advice": advice.text,
        "meters_to_drive": advice.meters,
        "places": places,
        "places_apart": apart,
    }


def _place(snapshot: MapSnapshot, hypothesis: Hypothesis, position: Float64) -> dict[str, Any]:
    return {
        "map": snapshot.name,
        "frame": snapshot.frame,
        "position": position.tolist(),
        "yaw": hypothesis.pose.yaw,
        "score": hypothesis.score,
    }


def _hypothesis(hypothesis: Hypothesis) -> dict[str, Any]:
    return {
        "pose": pose_of(hypothesis.pose),
        "score": hypothesis.score,
        "inliers": len(hypothesis),
    }
