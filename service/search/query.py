"""Query: the segments that a request searches for, and the maps that it searches."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float64
from placecell.descriptors.reranking import CANDIDATES
from service.core.auth import Principal
from service.core.cost import Cost, check_cost, cost_of_search
from service.core.problems import Problem
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.describer import Descriptors, PreparedScan
from service.inference.model_registry import Model, Models
from service.inference.scan import Scan
from service.maps.repository import MapRepository
from service.maps.snapshot import MapEntry, MapSnapshot


@dataclass(frozen=True, slots=True)
class MapSelection:
    """Maps to search, grouped by the model that made them, and maps that are skipped.

    Attributes:
        searched: models with their maps, which have an index; one group at least. Where no map can
            be searched, it is the request's own model without a map.
        skipped: maps whose model is not loaded, or is not the model of the codes.
    """

    searched: tuple[tuple[Model, tuple[MapSnapshot, ...]], ...]
    skipped: tuple[MapEntry, ...]

    @property
    def maps(self) -> list[MapSnapshot]:
        """Return all maps to search, by name."""
        maps = [snapshot for _, group in self.searched for snapshot in group]
        return sorted(maps, key=lambda snapshot: snapshot.name)

    @property
    def segments(self) -> int:
        """Return the number of segments of all maps to search."""
        return sum(len(snapshot) for _, group in self.searched for snapshot in group)


@dataclass(frozen=True, slots=True)
class Query:
    """Segments to search for, and the maps to search.

    Attributes:
        model_id: id of the model that the answer names: that of the codes, or the default.
        selection: the maps.
        k: largest number of candidates of a segment.
        given: the request's own descriptors; None if it has segments.
        prepared: the request's scan, prepared for each model of the selection.
        searched_k: number of candidates of a segment that are searched: k, or more to re-rank them.
        is_reranked: whether the candidates of `/match` are re-ranked.
        sensor: median sensor position of the request's scan, float64 (3,), meters; None if the
            request has descriptors.
        wanted: filter of the segments by class, of the maps and of the request; None: all.
    """

    model_id: str
    selection: MapSelection
    k: int
    given: Descriptors | None
    prepared: tuple[PreparedScan, ...]
    searched_k: int
    is_reranked: bool
    sensor: Float64 | None = None
    wanted: ClassFilter | None = None

    async def describe(self, timing: Timing) -> list[Descriptors]:
        """Return the descriptors by each model of the selection, computed in batches."""
        if self.given is not None:
            return [self.given.searched(self.wanted)]
        return [
            (await model.describer.describe(prepared, timing)).searched(self.wanted)
            for (model, _), prepared in zip(self.selection.searched, self.prepared, strict=True)
        ]

    def describe_alone(self) -> list[Descriptors]:
        """Return the descriptors as `describe` does, without an event loop."""
        if self.given is not None:
            return [self.given.searched(self.wanted)]
        return [
            model.describer.describe_alone(prepared).searched(self.wanted)
            for (model, _), prepared in zip(self.selection.searched, self.prepared, strict=True)
        ]


def select_maps(
    maps: MapRepository,
    models: Models,
    names: Sequence[str] | None,
    only: Model | None,
    principal: Principal,
    wanted: Callable[[MapEntry], bool] = lambda _: True,
) -> MapSelection:
    """Select the maps to search.

    Args:
        maps: all maps.
        models: loaded models.
        names: names of the maps; None: all maps in the scope of the key.
        only: model that made the codes; None: each model describes the segments itself.
        principal: principal.
        wanted: returns whether to search a map, such as by its tags.

    Maps that are not in memory are loaded.

    Raises:
        Problem: 403 if a named map is outside the scope of the key, 404 if it does not exist, 409
            if its model is not loaded or is not the model of the codes, 413 if the maps do not fit
            into the memory together.
    """
    if names is None:
        chosen = [entry for entry in maps.entries() if principal.covers(entry.name)]
    else:
        for name in names:
            principal.check_map(name)
        chosen = [maps.named(name) for name in sorted(set(names))]
    chosen = [entry for entry in chosen if wanted(entry)]
    usable = [
        entry
        for entry in chosen
        if (made_by := models.find(entry.model_id)) is not None and only in (None, made_by)
    ]
    maps.check_fits(usable)
    loaded = {entry.name: maps.find(entry.name) for entry in usable}
    groups: dict[str, list[MapSnapshot]] = {}
    skipped = []
    for entry in chosen:
        snapshot = loaded.get(entry.name)
        if snapshot is not None and snapshot.index is not None:
            groups.setdefault(snapshot.model_id, []).append(snapshot)
        elif names is None:
            skipped.append(entry)
        else:
            known = only.id if only is not None else ", ".join(each.id for each in models.all())
            raise Problem(
                409,
                "other-model",
                f"Map {entry.name!r} was made by model {entry.model_id!r}, but this request can "
                f"use only {known}.",
            )
    searched = [(models.named(made_by), tuple(group)) for made_by, group in groups.items()]
    # Without a map to search, the segments are checked and described all the same.
    return MapSelection(tuple(searched) or ((only or models.default, ()),), tuple(skipped))


def query_of_codes(
    given: Descriptors,
    selection: MapSelection,
    k: int,
    limits: Limits,
    timing: Timing,
    rerank: bool = False,
    wanted: ClassFilter | None = None,
) -> Query:
    """Build the query of a request that has descriptors.

    Args:
        given: the descriptors; without centroids they cannot be re-ranked.
        selection: the maps.
        k: largest number of candidates of a segment.
        limits: limits of the service.
        timing: stopwatch of the request.
        rerank: re-rank the candidates.
        wanted: filter of the segments by class.

    Raises:
        Problem: 413 if the search is too much work.
    """
    timing.lap("decode")
    is_reranked = rerank and given.centroids is not None
    searched_k = _searched_k(len(given), k, is_reranked)
    check_cost(_search_cost(len(given), selection, searched_k, is_reranked), limits.cost_seconds)
    return Query(given.model_id, selection, k, given, (), searched_k, is_reranked, wanted=wanted)


def query_of_scan(
    scan: Scan,
    default: Model,
    selection: MapSelection,
    k: int,
    timing: Timing,
    rerank: bool = False,
    wanted: ClassFilter | None = None,
) -> Query:
    """Build the query of a request that has segments: prepare them for each model.

    Args:
        scan: the segments.
        default: default model.
        selection: the maps.
        k: largest number of candidates of a segment.
        timing: stopwatch of the request.
        rerank: re-rank the candidates.
        wanted: filter of the segments by class.

    Raises:
        Problem: 413 if it is too much work, 422 if no segment can be described.
    """
    searched_k = _searched_k(len(scan), k, rerank)
    cost = _search_cost(len(scan), selection, searched_k, rerank)
    prepared = []
    for model, _ in selection.searched:
        # Only a filter reads the classes of a query.
        classified = wanted is not None
        one = model.describer.prepare(scan, timing, cost, classified)
        prepared.append(one)
        cost += one.cost
    return Query(
        model_id=default.id,
        selection=selection,
        k=k,
        given=None,
        prepared=tuple(prepared),
        searched_k=searched_k,
        is_reranked=rerank,
        sensor=np.median(scan.sensors, axis=0),
        wanted=wanted,
    )


def _searched_k(queries: int, k: int, is_reranked: bool) -> int:
    """Return the number of candidates to search; a single query has no neighbors."""
    return max(k, CANDIDATES) if is_reranked and queries > 1 else k


def _search_cost(queries: int, selection: MapSelection, k: int, is_reranked: bool) -> Cost:
    return cost_of_search(
        queries=queries,
        rows=selection.segments,
        k=k,
        models=len(selection.searched),
        is_reranked=is_reranked,
    )
