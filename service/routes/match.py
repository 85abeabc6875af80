"""`/match`: queries in, candidates out."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from fastapi import APIRouter, Request, Response

from segments.types import Int8
from service.bodies import ENCODINGS, Body, answer_type, parse, render
from service.describer import Prepared, Scan
from service.keys import Holder
from service.matching import Candidate, Scope, found_in, merged, scope_of
from service.models import Model
from service.openapi import body_of, packed_response
from service.packed_schemas import PackedMatchRequest
from service.problems import Problem, ProblemError, documented
from service.schemas import Failed, MatchRequest, MatchResponse
from service.state import HolderOf, State, StateOf, TimingOf
from service.timing import Timing

router = APIRouter(tags=["recognition"])

Rows = tuple[int | Failed, ...]
"""Of each query its row among the codes, or why it has none."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A request that was read and found good.

    Attributes:
        model_id: that the answer names: of the codes, or the default.
        scope: where to look.
        k: candidates a query.
        codes: with their rows, if the request has its own.
        prepared: the request's segments, for each model that will look.
    """

    model_id: str
    scope: Scope
    k: int
    codes: tuple[Int8, Rows] | None
    prepared: list[Prepared]


@router.post(
    "/match",
    summary="The nearest segments of one map, some, or all",
    response_model=MatchResponse,
    responses=packed_response(MatchResponse)
    | documented(400, 401, 403, 404, 406, 408, 409, 413, 415, 422, 429, 500, 504),
    openapi_extra=body_of(MatchRequest, PackedMatchRequest),
)
async def match(request: Request, state: StateOf, holder: HolderOf, timing: TimingOf) -> Response:
    """One result a query, in order: its candidates, nearest first, or why it could not be used.

    Queries are rounded to codes before the search, as the maps' descriptors are. Each map is
    searched with the model that made it. Maps whose model is not loaded are skipped, and listed; a
    409 if the request names one. Candidates of several models are sorted by probability.
    """
    answer = answer_type(request)
    async with state.desk.admit(request, ENCODINGS, timing) as body:
        asked = await state.compute(_read, state, holder, body, timing)
        request.state.model_id = asked.model_id
        queries = []
        for (model, _), prepared in zip(asked.scope.searched, asked.prepared, strict=False):
            described = await model.describer.describe(prepared, timing)
            queries.append((described.codes, described.rows))
        content = await state.compute(_search, asked, queries, answer, timing)
    return Response(content, media_type=answer)


def _read(state: State, holder: Holder, body: Body, timing: Timing) -> Asked:
    timing.lap("queue")
    query = parse(MatchRequest, PackedMatchRequest, body, state.settings.limits)
    limit = state.settings.limits.k
    if query.k > limit:
        raise _invalid("/k", f"k is {query.k}; the limit is {limit}.")
    own = None if query.model_id is None else state.models.named(query.model_id)
    codes = None if own is None else _codes(state, query, own)
    scope = scope_of(state.maps, state.models, query.maps, own, holder)
    if query.segments is None:
        assert own is not None
        assert codes is not None
        timing.lap("decode")
        return Asked(own.id, scope, query.k, (codes, tuple(range(len(codes)))), [])
    scan, default = Scan.of(query.segments, query.origin), state.models.default
    if not scope.searched:
        # Nobody will look; but what is wrong with the segments is told all the same.
        scope = Scope(((default, ()),), scope.skipped)
    prepared = [model.describer.prepare(scan, timing) for model, _ in scope.searched]
    return Asked(default.id, scope, query.k, None, prepared)


def _search(asked: Asked, queries: list[tuple[Int8, Rows]], answer: str, timing: Timing) -> bytes:
    timing.lap("queue")
    if asked.codes is not None:
        queries = [asked.codes] * len(asked.scope.searched)
    found = [
        [candidates[row] if isinstance(row, int) else row for row in rows]
        for (model, searched), (codes, rows) in zip(asked.scope.searched, queries, strict=True)
        for candidates in [found_in(codes, model, searched, asked.k).candidates()]
    ]
    if not found:
        assert asked.codes is not None
        found = [[[] for _ in asked.codes[0]]]
    timing.lap("search")
    # What `MatchResponse` says, without its checks: the values are our own.
    response = {
        "model_id": asked.model_id,
        "queries": [_one(list(by_model), asked.k) for by_model in zip(*found, strict=True)],
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


def _codes(state: State, query: MatchRequest | PackedMatchRequest, model: Model) -> Int8:
    """The request's own codes, int8 (q, code bytes)."""
    codes = _rows(query, model.manifest.code_bytes)
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
