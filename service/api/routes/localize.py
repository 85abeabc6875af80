"""`/localize`: segments in, the robot's place out."""

from typing import Any

import numpy as np
from fastapi import APIRouter, Request, Response

from placecell.localization import Hypothesis, LocalizationParameters
from placecell.localization.evidence import Evidence, middle_of
from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, Body, answer_type, parse, render
from service.api.body.problem_json import documented
from service.api.openapi import body_of, packed_response
from service.api.query_parsing import Asked, Queries, read_query
from service.api.responses import pose_of
from service.api.schemas.localization import LocalizeQuery, LocalizeRequest, LocalizeResponse
from service.api.schemas.msgpack import PackedLocalizeRequest
from service.api.schemas.recognition import Failed
from service.api.state import HolderOf, State, StateOf, TimingOf
from service.core.auth import Holder
from service.core.timing import Timing
from service.maps.shared_index import Part
from service.maps.snapshot import MapSnapshot
from service.search.localization import Group, InMap, localize_among
from service.search.matching import parts_of
from service.search.sessions import SessionKey

router = APIRouter(tags=["recognition"])

Query = LocalizeQuery[Any, Any, Any]
Told = dict[str, Any]
"""As `LocalizationOut` says."""


@router.post(
    "/localize",
    summary="Where in one map, some, or all the robot is",
    response_model=LocalizeResponse,
    responses=packed_response(LocalizeResponse)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=body_of(LocalizeRequest, PackedLocalizeRequest),
)
async def localize(
    request: Request, state: StateOf, holder: HolderOf, timing: TimingOf
) -> Response:
    """Return the robot's pose in each map's frame, or the reason for none; most probable first.

    Send all segments around the robot, in one frame. Candidates of all segments are searched in
    all maps at once, and those that agree with each other give the pose. The maps are judged
    together: a place that fits nearly as well as the best one makes the answer *ambiguous*, also
    if it is in another map. `rival` then names that map and its pose. A merged map and its sources
    are one place. At most eight maps, those in which most segments agree, are searched in full;
    `detail` says where a map was not.
    """
    answer = answer_type(request)
    async with state.recognition.admit(request, ENCODINGS, timing) as body:
        query, asked = await state.compute(_read, state, holder, body, timing)
        request.state.model_id = asked.model_id
        queries = await asked.queries(timing)
        content = await state.compute(
            _answered, state, holder, query, asked, queries, answer, timing
        )
    return await state.answers.respond(content, client_of(request), answer)


def _read(state: State, holder: Holder, body: Body, timing: Timing) -> tuple[Query, Asked]:
    timing.lap("queue")
    query = parse(LocalizeRequest, PackedLocalizeRequest, body, state.settings.limits)
    centroids = None if query.centroids is None else np.array(query.centroids, np.float64)
    return query, read_query(state, holder, query, timing, centroids)


def _session_key(holder: Holder, query: Query, stored: MapSnapshot) -> SessionKey | None:
    if not query.session:
        return None
    return SessionKey(holder.name, query.session, stored.head.uid, stored.frame_since)


def _answered(
    state: State,
    holder: Holder,
    query: Query,
    asked: Asked,
    queries: list[Queries],
    answer: str,
    timing: Timing,
) -> bytes:
    timing.lap("queue")
    groups, middles = [], []
    for (model, searched), own in zip(asked.scope.searched, queries, strict=True):
        assert own.centroids is not None
        groups.append(Group(model, searched, own.codes, own.centroids))
        middles.append(middle_of(own.centroids))
    middle_in = {
        stored.head.uid: middle
        for group, middle in zip(groups, middles, strict=True)
        for stored in group.searched
    }

    def evidence(stored: MapSnapshot) -> Evidence | None:
        key = _session_key(holder, query, stored)
        return state.sessions.evidence(key, middle_in[stored.head.uid]) if key else None

    def parts(group: Group) -> list[Part]:
        return parts_of(state.maps, group.model, group.searched, state.keys.patterns)

    parameters = LocalizationParameters(model=query.motion)
    found = localize_among(groups, query.k, parameters, timing, parts, evidence)
    for each in found:
        key = _session_key(holder, query, each.stored)
        if key and each.is_full:
            hypotheses = each.judged.localization.hypotheses
            state.sessions.remember(key, middles[each.group], hypotheses)
    told = [_told(each, queries[each.group]) for each in found]
    return _written(asked, queries, told, answer, timing)


def _told(answer: InMap, own: Queries) -> Told:
    """What one map says."""
    found, stored, rival = answer.judged.localization, answer.stored, answer.judged.rival
    best, pose = found.best, found.pose
    inliers: list[Told] = []
    if best is not None and pose is not None:
        places = np.flatnonzero([isinstance(row, int) for row in own.rows])[best.queries]
        ids = stored.layers.column("ids", best.rows)
        inliers = [
            {"query": query, "id": id_, "residual": residual}
            for query, id_, residual in zip(
                places.tolist(), ids.tolist(), best.residuals.tolist(), strict=True
            )
        ]
    others = [found.second] if pose is not None else [best, found.second]
    return {
        "map": stored.name,
        "frame": stored.frame,
        "localised": pose is not None,
        "reason": found.reason,
        "detail": found.detail,
        "probability": found.probability,
        "pose": None if pose is None else pose_of(pose),
        "covariance": None if pose is None or best is None else best.covariance.tolist(),
        "score": 0.0 if best is None else best.score,
        "inliers": inliers,
        "others": [_other(each) for each in others if each is not None],
        "rival": None
        if rival is None or answer.rival is None
        else {"map": answer.rival.name, "frame": answer.rival.frame} | _other(rival.hypothesis),
    }


def _other(hypothesis: Hypothesis) -> Told:
    return {
        "pose": pose_of(hypothesis.pose),
        "score": hypothesis.score,
        "inliers": len(hypothesis),
    }


def _written(
    asked: Asked, queries: list[Queries], told: list[Told], answer: str, timing: Timing
) -> bytes:
    # What `LocalizeResponse` says, without its checks: the values are our own.
    response = {
        "model_id": asked.model_id,
        "localisations": told,
        "unusable": [{"query": query, **failed.model_dump()} for query, failed in _failed(queries)],
        "dropped_points": asked.dropped_points,
        "skipped": [
            {"map": stored.name, "model_id": stored.model_id} for stored in asked.scope.skipped
        ],
    }
    content = render(response, answer)
    timing.lap("encode")
    return content


def _failed(queries: list[Queries]) -> list[tuple[int, Failed]]:
    """The segments that no model could use."""
    by_query = enumerate(zip(*(own.rows for own in queries), strict=True))
    return [
        (query, rows[0])
        for query, rows in by_query
        if isinstance(rows[0], Failed) and all(isinstance(row, Failed) for row in rows)
    ]
