"""`/match`: query segments in, the nearest map segments out."""

from collections.abc import Sequence
from typing import Any

from fastapi import APIRouter, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, Body, answer_type, parse, render
from service.api.body.msgpack_codec import Items
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.openapi import body_of, packed_response
from service.api.query_parsing import read_query
from service.api.responses import segment_error, skipped_maps
from service.api.schemas.msgpack import PackedMatchRequest
from service.api.schemas.recognition import MatchRequest, MatchResponse
from service.api.state import State
from service.core.auth import Principal
from service.core.timing import Timing
from service.inference.describer import Descriptors, SegmentError
from service.search.matching import Candidate
from service.search.query import Query

router = APIRouter(tags=["recognition"])


@router.post(
    "/match",
    summary="Find the nearest segments of maps",
    response_model=MatchResponse,
    responses=packed_response(MatchResponse)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=body_of(MatchRequest, PackedMatchRequest),
)
async def match(
    request: Request, state: StateOf, principal: PrincipalOf, timing: TimingOf
) -> Response:
    """Return one result per query, in order: its candidates, best first, or its error.

    Queries are rounded to codes before the search, as the maps' descriptors are. Send all segments
    of a scan in one request: the 25 nearest candidates of each are then re-ranked by the other
    segments that support them, and the best k are returned. `rerank: false`, and codes without
    centroids, give the k nearest, in the order of their distances. Re-ranking changes neither
    `distance` nor `probability`.

    Each map is searched with the model that made it. Maps whose model is not loaded are listed as
    skipped; a request that names one gets a 409. Candidates of several models are sorted by
    probability and support. The model named by `model_id` gives a candidate's probability;
    probabilities of different models are not calibrated against each other.
    """
    answer = answer_type(request)
    async with state.lanes.recognition.admit(request, ENCODINGS, timing) as body:
        query = await state.run(read_match, state, principal, body, timing)
        request.state.model_id = query.model_id
        descriptors = await query.describe(timing)
        content = await state.run(_search, state, query, descriptors, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def read_match(state: State, principal: Principal, body: Body, timing: Timing) -> Query:
    """Parse the body of a match and build its query."""
    timing.lap("queue")
    request = parse(MatchRequest, PackedMatchRequest, body, state.settings.limits)
    return read_query(state, principal, request, timing, request.rerank)


def _search(
    state: State, query: Query, descriptors: Sequence[Descriptors], answer: str, timing: Timing
) -> bytes:
    timing.lap("queue")
    result = state.engine.matches(query, descriptors)
    timing.lap("search")
    # The same as a `MatchResponse`, without its checks: the values are our own.
    response = {
        "model_id": result.model_id,
        "queries": Items(len(result), map(_item, result)),
        "dropped_points": result.dropped_points,
        "searched": [snapshot.name for snapshot in result.selection.maps],
        "skipped": skipped_maps(result.selection),
    }
    content = render(response, answer)
    timing.lap("encode")
    return content


def _item(found: list[Candidate] | SegmentError) -> dict[str, Any]:
    """Return the result of one query."""
    return segment_error(found) if isinstance(found, SegmentError) else {"candidates": found}
