"""`/match`: queries in, candidates out."""

import numpy as np
from fastapi import APIRouter, Request, Response

from segments.types import Int8
from service.bodies import ENCODINGS, Body, answer_type, parse, read_body, render
from service.describer import Scan
from service.matching import candidates_of, scope_of
from service.openapi import body_of, packed_response
from service.packed_schemas import PackedMatchRequest
from service.problems import Problem, ProblemError, documented
from service.schemas import Failed, MatchRequest, MatchResponse, SkippedOut
from service.state import State, StateOf

router = APIRouter(tags=["recognition"])


@router.post(
    "/match",
    summary="The nearest segments of one map, some, or all",
    response_model=MatchResponse,
    responses=packed_response(MatchResponse) | documented(400, 404, 406, 409, 413, 415, 422),
    openapi_extra=body_of(MatchRequest, PackedMatchRequest),
)
async def match(request: Request, state: StateOf) -> Response:
    """One result a query, in order: its candidates, nearest first, or why it could not be used.

    Queries are rounded to codes before the search, as the maps' descriptors are. Maps of other
    models are skipped, and listed; a 409 if the request names one.
    """
    answer = answer_type(request)
    body = await read_body(request, ENCODINGS)
    return Response(await state.compute(_match, state, body, answer), media_type=answer)


def _match(state: State, body: Body, answer: str) -> bytes:
    query = parse(MatchRequest, PackedMatchRequest, body, state.settings.limits)
    limit = state.settings.limits.k
    if query.k > limit:
        detail = f"k is {query.k}; the limit is {limit}."
        raise _invalid("/k", detail)
    scope = scope_of(state.maps, query.maps, state.model_id)
    rows: tuple[int | Failed, ...]
    if query.segments is not None:
        described = state.describer.describe(Scan.of(query.segments, query.origin))
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
    return render(response, answer)


def _codes(state: State, query: MatchRequest | PackedMatchRequest) -> Int8:
    """The request's own codes, int8 (q, code bytes), if they are of the loaded model."""
    if query.model_id != state.model_id:
        raise Problem(
            409,
            "other-model",
            f"The codes were made by model {query.model_id!r:.100}; loaded is {state.model_id!r}.",
        )
    codes = _rows(query, state.describer.manifest.code_bytes)
    limit = state.settings.limits.segments
    if len(codes) > limit:
        raise Problem(
            413, "too-many-segments", f"{len(codes)} queries in a request; the limit is {limit}."
        )
    return codes


def _rows(query: MatchRequest | PackedMatchRequest, code_bytes: int) -> Int8:
    """The codes by query, int8 (q, code bytes)."""
    if isinstance(query, PackedMatchRequest):
        blob = query.codes
        assert blob is not None
        if len(blob) % code_bytes:
            detail = f"{len(blob)} bytes; the model's codes have {code_bytes} each."
            raise _invalid("/codes", detail)
        return blob.reshape(-1, code_bytes)
    codes = query.codes or []
    for index, row in enumerate(codes):
        if len(row) != code_bytes:
            detail = f"{len(row)} bytes; the model's codes have {code_bytes}."
            raise _invalid(f"/codes/{index}", detail)
    return np.array(codes, dtype=np.int8)


def _invalid(pointer: str, detail: str) -> Problem:
    return Problem(
        422,
        "invalid-request",
        f"{pointer}: {detail}",
        [ProblemError(pointer=pointer, detail=detail)],
    )
