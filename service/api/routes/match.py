"""`/match`: queries in, candidates out."""

from typing import Any

from fastapi import APIRouter, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, Body, answer_type, parse, render
from service.api.body.msgpack_codec import Items
from service.api.body.problem_json import documented
from service.api.openapi import body_of, packed_response
from service.api.query_parsing import Asked, Queries, read_query
from service.api.schemas.msgpack import PackedMatchRequest
from service.api.schemas.recognition import Failed, MatchRequest, MatchResponse
from service.api.state import HolderOf, State, StateOf, TimingOf
from service.core.auth import Holder
from service.core.timing import Timing
from service.search.matching import Candidate, found_in, merged, parts_of

router = APIRouter(tags=["recognition"])


@router.post(
    "/match",
    summary="The nearest segments of one map, some, or all",
    response_model=MatchResponse,
    responses=packed_response(MatchResponse)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 503, 504),
    openapi_extra=body_of(MatchRequest, PackedMatchRequest),
)
async def match(request: Request, state: StateOf, holder: HolderOf, timing: TimingOf) -> Response:
    """Return one result per query, in order: its candidates, nearest first, or its error.

    Queries are rounded to codes before the search, as the maps' descriptors are. Each map is
    searched with the model that made it. Maps whose model is not loaded are listed as skipped; a
    request that names one gets a 409. Candidates of several models are sorted by probability. The
    model named by `model_id` gives a candidate's probability; probabilities of different models
    are not calibrated against each other.
    """
    answer = answer_type(request)
    async with state.recognition.admit(request, ENCODINGS, timing) as body:
        asked = await state.compute(_read, state, holder, body, timing)
        request.state.model_id = asked.model_id
        queries = await asked.queries(timing)
        content = await state.compute(_search, state, asked, queries, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def _read(state: State, holder: Holder, body: Body, timing: Timing) -> Asked:
    timing.lap("queue")
    query = parse(MatchRequest, PackedMatchRequest, body, state.settings.limits)
    return read_query(state, holder, query, timing)


def _search(
    state: State, asked: Asked, queries: list[Queries], answer: str, timing: Timing
) -> bytes:
    timing.lap("queue")
    found = [
        (found_in(own.codes, model, searched, asked.k, parts).candidates(), own.rows)
        for (model, searched), own in zip(asked.scope.searched, queries, strict=True)
        for parts in [parts_of(state.maps, model, searched, state.keys.patterns)]
    ]
    if not found:
        assert asked.own is not None
        found = [(lambda _: [], asked.own.rows)]
    count = len(found[0][1])

    def one(query: int) -> dict[str, Any]:
        by_row = [(candidates, rows[query]) for candidates, rows in found]
        return _one([at(row) if isinstance(row, int) else row for at, row in by_row], asked.k)

    timing.lap("search")
    # What `MatchResponse` says, without its checks: the values are our own.
    response = {
        "model_id": asked.model_id,
        "queries": Items(count, map(one, range(count))),
        "dropped_points": asked.dropped_points,
        "searched": [stored.name for stored in asked.scope.maps],
        "skipped": [
            {"map": stored.name, "model_id": stored.model_id} for stored in asked.scope.skipped
        ],
    }
    content = render(response, answer)
    timing.lap("encode")
    return content


def _one(by_model: list[list[Candidate] | Failed], k: int) -> dict[str, Any]:
    """One query's result: what any model found, or why none could look."""
    found = [candidates for candidates in by_model if not isinstance(candidates, Failed)]
    if found:
        return {"candidates": merged(found, k)}
    failed = by_model[0]
    assert isinstance(failed, Failed)
    return failed.model_dump()
