"""What `/match` and `/localize` are asked: segments or codes, and the maps to look in."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from placecell.core.types import Float64, Int8
from service.api.schemas.recognition import Failed, QueryRequest
from service.api.state import State
from service.core.auth import Holder
from service.core.cost import Cost, check_cost, cost_of_search
from service.core.problems import Problem, ProblemError
from service.core.timing import Timing
from service.inference.describer import Prepared
from service.inference.model_registry import Model
from service.inference.scan import Scan
from service.search.matching import Scope, scope_of

Rows = tuple[int | Failed, ...]
"""Of each query its row among the codes, or why it has none."""


@dataclass(frozen=True, slots=True)
class Queries:
    """The queries by one model.

    Attributes:
        codes: int8 (rows, code bytes).
        rows: of each query.
        centroids: float64 (rows, 3), metres, in the request's frame; None if the request has codes
            alone.
    """

    codes: Int8
    rows: Rows
    centroids: Float64 | None


@dataclass(frozen=True, slots=True)
class Asked:
    """A request that was read and found good.

    Attributes:
        model_id: that the answer names: of the codes, or the default.
        scope: where to look.
        k: candidates a query.
        own: the request's own codes, if it has any.
        prepared: the request's segments, for each model that will look.
    """

    model_id: str
    scope: Scope
    k: int
    own: Queries | None
    prepared: list[Prepared]

    @property
    def dropped_points(self) -> int:
        """Return the number of the request's points that were not finite and were left out."""
        return self.prepared[0].dropped_points if self.prepared else 0

    async def queries(self, timing: Timing) -> list[Queries]:
        """The queries for each model of the scope, in its order."""
        if self.own is not None:
            return [self.own] * len(self.scope.searched)
        told = []
        for (model, _), prepared in zip(self.scope.searched, self.prepared, strict=True):
            described = await model.describer.describe(prepared, timing)
            told.append(Queries(described.codes, described.rows, described.centroids))
        return told


def read_query(
    state: State,
    holder: Holder,
    query: QueryRequest[Any, Any],
    timing: Timing,
    centroids: Float64 | None = None,
) -> Asked:
    """See that a request can be answered, and prepare its segments.

    Args:
        centroids: of the request's own codes.

    Raises:
        Problem: as `scope_of`; 413 or 422 if the queries cannot be used, 409 if their model is not
            loaded.
    """
    limit = state.settings.limits.k
    if query.k > limit:
        raise invalid("/k", f"k is {query.k}; the limit is {limit}.")
    named = state.settings.limits.named_maps
    if query.maps is not None and len(query.maps) > named:
        raise invalid("/maps", f"The request names {len(query.maps)} maps; the limit is {named}.")
    own = None if query.model_id is None else state.models.named(query.model_id)
    codes = None if own is None else _codes(state, query.codes, own)
    scope = scope_of(state.maps, state.models, query.maps, own, holder)
    if own is not None and codes is not None:
        if centroids is not None and len(centroids) != len(codes):
            raise invalid("/centroids", f"{len(centroids)} of them for {len(codes)} codes.")
        timing.lap("decode")
        check_cost(_search_cost(len(codes), scope, query.k), state.settings.limits.cost_seconds)
        rows = tuple(range(len(codes)))
        return Asked(own.id, scope, query.k, Queries(codes, rows, centroids), [])
    assert query.segments is not None
    scan, default = Scan.of(query.segments, query.origin), state.models.default
    if not scope.searched:
        # Nobody will look; but what is wrong with the segments is told all the same.
        scope = Scope(((default, ()),), scope.skipped)
    cost = _search_cost(len(scan), scope, query.k)
    prepared = []
    for model, _ in scope.searched:
        one = model.describer.prepare(scan, timing, cost)
        prepared.append(one)
        cost += one.cost
    return Asked(default.id, scope, query.k, None, prepared)


def _search_cost(queries: int, scope: Scope, k: int) -> Cost:
    rows = sum(len(stored) for _, group in scope.searched for stored in group)
    return cost_of_search(queries, rows, k, len(scope.searched))


def invalid(pointer: str, detail: str) -> Problem:
    """The problem of a value that is wrong, told where it stands."""
    return Problem(
        422,
        "invalid-request",
        f"{pointer}: {detail}",
        [ProblemError(pointer=pointer, detail=detail)],
    )


def _codes(state: State, given: Int8 | list[list[int]] | None, model: Model) -> Int8:
    """The request's own codes, int8 (q, code bytes)."""
    assert given is not None  # as the schema has seen
    codes = _rows(given, model.manifest.code_bytes)
    limit = state.settings.limits.segments
    if len(codes) > limit:
        raise Problem(
            413, "too-many-segments", f"{len(codes)} queries in a request; the limit is {limit}."
        )
    return codes


def _rows(given: Int8 | list[list[int]], code_bytes: int) -> Int8:
    """Return the codes by query, int8 (q, code bytes), from a blob or from rows."""
    if isinstance(given, np.ndarray) and given.ndim == 1:
        if len(given) % code_bytes:
            detail = f"{len(given)} bytes; the model's codes have {code_bytes} each."
            raise invalid("/codes", detail)
        return given.reshape(-1, code_bytes)
    for index, row in enumerate(given):
        if len(row) != code_bytes:
            detail = f"{len(row)} bytes; the model's codes have {code_bytes}."
            raise invalid(f"/codes/{index}", detail)
    return np.asarray(given, dtype=np.int8)
