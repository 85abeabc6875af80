"""`/coverage`: how much of what a robot sees each map knows."""

from collections.abc import Sequence
from dataclasses import asdict

from fastapi import APIRouter, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, answer_type, render
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.openapi import body_of, packed_response
from service.api.responses import skipped_maps
from service.api.routes.match import read_match
from service.api.schemas.msgpack import PackedMatchRequest
from service.api.schemas.recognition import CoverageResponse, MatchRequest
from service.api.state import State
from service.core.timing import Timing
from service.inference.describer import Descriptors
from service.search.coverage import coverage_of
from service.search.query import Query

router = APIRouter(tags=["recognition"])


@router.post(
    "/coverage",
    summary="Ask how much of this area the maps know",
    response_model=CoverageResponse,
    responses=packed_response(CoverageResponse)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=body_of(MatchRequest, PackedMatchRequest),
)
async def coverage(
    request: Request, state: StateOf, principal: PrincipalOf, timing: TimingOf
) -> Response:
    """Return the share of the segments that each map knows, the largest first.

    This is `/match` with the same body, summarized: a segment is known if its best candidate in the
    map is more likely right than wrong, with the support of its neighbors. It costs no more than
    `/match` and gives no pose: segments may look alike elsewhere.
    """
    answer = answer_type(request)
    async with state.lanes.recognition.admit(request, ENCODINGS, timing) as body:
        query = await state.run(read_match, state, principal, body, timing)
        request.state.model_id = query.model_id
        descriptors = await query.describe(timing)
        content = await state.run(_search, state, query, descriptors, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def _search(
    state: State, query: Query, descriptors: Sequence[Descriptors], answer: str, timing: Timing
) -> bytes:
    timing.lap("queue")
    result = state.engine.matches(query, descriptors)
    segments, maps = coverage_of(result)
    timing.lap("search")
    content = render(
        {
            "model_id": result.model_id,
            "segments": segments,
            "maps": [asdict(each) for each in maps],
            "dropped_points": result.dropped_points,
            "skipped": skipped_maps(result.selection),
        },
        answer,
    )
    timing.lap("encode")
    return content
