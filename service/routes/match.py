"""`/match`: queries in, candidates out."""

import numpy as np
from fastapi import APIRouter, Request, Response

from segments.types import Int8
from service.bodies import JSON, parse, read_body
from service.matching import candidates_of, scope_of
from service.openapi import json_body
from service.problems import Problem, ProblemError, documented
from service.schemas import Failed, MatchRequest, MatchResponse, SkippedOut
from service.state import State, StateOf

router = APIRouter(tags=["recognition"])


@router.post(
    "/match",
    summary="The nearest segments of one map, some, or all",
    response_model=MatchResponse,
    responses=documented(400, 404, 409, 413, 415, 422),
    openapi_extra=json_body(MatchRequest),
)
async def match(request: Request, state: StateOf) -> Response:
    """One result a query, in order: its candidates, nearest first, or why it could not be used.

    Queries are rounded to codes before the search, as the maps' descriptors are. Maps of other
    models are skipped, and listed; a 409 if the request names one.
    """
    body = await read_body(request, {JSON})
    return Response(await state.compute(_match, state, body), media_type=JSON)


def _match(state: State, body: bytes) -> str:
    query = parse(MatchRequest, body, state.settings.limits)
    limit = state.settings.limits.k
    if query.k > limit:
        detail = f"k is {query.k}; the limit is {limit}."
        raise Problem(422, "invalid-request", detail, [ProblemError(pointer="/k", detail=detail)])
    scope = scope_of(state.maps, query.maps, state.model_id)
    rows: tuple[int | Failed, ...]
    if query.segments is not None:
        described = state.describer.describe(query.segments)
        codes, rows = described.codes, described.rows
    else:
        codes = _codes(state, query)
        rows = tuple(range(len(codes)))
    step = state.describer.manifest.quantiser.step
    found = candidates_of(codes, scope.searched, query.k, step, state.classifier)
    response = MatchResponse(
        model_id=state.model_id,
        queries=[found[row] if isinstance(row, int) else row for row in rows],
        searched=[stored.name for stored in scope.searched],
        skipped=[
            SkippedOut(map=stored.name, model_id=stored.content.model_id)
            for stored in scope.skipped
        ],
    )
    return response.model_dump_json()


def _codes(state: State, query: MatchRequest) -> Int8:
    """The request's own codes, int8 (q, d), if they are of the loaded model."""
    if query.model_id != state.model_id:
        raise Problem(
            409,
            "other-model",
            f"The codes were made by model {query.model_id!r:.100}; loaded is {state.model_id!r}.",
        )
    codes = query.codes or []
    limit = state.settings.limits.segments
    if len(codes) > limit:
        raise Problem(
            413, "too-many-segments", f"{len(codes)} queries in a request; the limit is {limit}."
        )
    dimension = state.describer.manifest.dimension
    for index, row in enumerate(codes):
        if len(row) != dimension:
            detail = f"{len(row)} codes; the model's descriptors have {dimension}."
            pointer = f"/codes/{index}"
            raise Problem(
                422,
                "invalid-request",
                f"{pointer}: {detail}",
                [ProblemError(pointer=pointer, detail=detail)],
            )
    return np.array(codes, dtype=np.int8)
