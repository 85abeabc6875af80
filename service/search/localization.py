"""Localization of a robot in one map or in many maps."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64, Int8, Int64
from placecell.localization import Candidates, Localization, LocalizationParameters, localize
from placecell.localization.evidence import Evidence
from placecell.localization.joint import Judged, MapQuery, localize_jointly
from placecell.localization.localize import unknown
from service.core.timing import Timing
from service.inference.match_probability import likely
from service.inference.model_registry import Model
from service.maps.shared_index import Part
from service.maps.snapshot import MapSnapshot
from service.search.links import pose_between
from service.search.matching import found_in
from service.search.ranking import FULL, best_of, votes_of


class MapSurroundings:
    """`Surroundings` of a stored map."""

    def __init__(self, codes: Int8, model: Model, stored: MapSnapshot) -> None:
        """For queries of these codes, int8 (q, code bytes), of the model that made the map."""
        self._codes = codes
        self._model = model
        self._layers = stored.layers

    def about(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Rows about places, and their centroids."""
        rows = self._layers.rows_near(places, meters)
        return rows, self._layers.column("centroids", rows)

    def likely(self, queries: Int64, rows: Int64) -> Float64:
        """How likely each query and row are the same."""
        return likely(self._model, self._codes[queries], self._layers.column("codes", rows))


def localize_in(
    codes: Int8,
    centroids: Float64,
    model: Model,
    stored: MapSnapshot,
    k: int,
    parameters: LocalizationParameters,
    timing: Timing,
    evidence: Evidence | None = None,
) -> Localization:
    """Where in a map the robot is.

    Args:
        codes: int8 (q, code bytes), of the segments around the robot.
        centroids: float64 (q, 3), theirs, metres, in the robot's frame.
        model: that made them and the map.
        stored: with an index.
        k: candidates a segment, at most.
        evidence: of the robot's earlier requests.
    """
    query = query_in(codes, centroids, model, stored, k, evidence)
    timing.lap("search")
    localization = localize(
        query.candidates, parameters, query.confidence, query.evidence, query.there
    )
    timing.lap("verify")
    return localization


def query_in(
    codes: Int8,
    centroids: Float64,
    model: Model,
    stored: MapSnapshot,
    k: int,
    evidence: Evidence | None = None,
) -> MapQuery:
    """Look up the candidates in one map; arguments as of `localize_in`."""
    found = found_in(codes, model, (stored,), k)
    there = MapSurroundings(codes, model, stored)
    probabilities = found.probabilities
    if probabilities is None:
        queries = np.repeat(np.arange(len(codes)), found.rows.shape[1])
        probabilities = there.likely(queries, found.rows.ravel()).reshape(found.rows.shape)
    places = stored.layers.column("centroids", found.rows)
    candidates = Candidates(centroids, found.rows, places, probabilities)
    return MapQuery(stored.name, model.id, candidates, there, model.confidence, evidence)


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """Maps of one model, with the query as that model describes it.

    Attributes:
        model: that made the maps.
        searched: the maps, each with an index.
        codes: int8 (q, code bytes), of the segments around the robot.
        centroids: float64 (q, 3), theirs, metres, in the robot's frame.
    """

    model: Model
    searched: tuple[MapSnapshot, ...]
    codes: Int8
    centroids: Float64


@dataclass(frozen=True, slots=True, eq=False)
class InMap:
    """Answer for one map.

    Attributes:
        stored: the map.
        group: index of its group.
        judged: where in it the robot is.
        is_full: whether the map was searched in full; only then is there anything to remember.
        rival: the map of `judged.rival`.
    """

    stored: MapSnapshot
    group: int
    judged: Judged
    is_full: bool
    rival: MapSnapshot | None = None


def localize_among(
    groups: Sequence[Group],
    k: int,
    parameters: LocalizationParameters,
    timing: Timing,
    parts: Callable[[Group], list[Part]],
    evidence: Callable[[MapSnapshot], Evidence | None],
) -> list[InMap]:
    """Localize the robot in any of the maps, the most probable first.

    All maps are searched at once where there are more than a few, and those in which most segments
    agree are searched in full and judged together. The work is bounded, however many maps there
    are.

    Args:
        k: candidates a segment and map, at most.
        parts: how a group's maps are searched at once.
        evidence: what the robot's earlier requests found in a map.
    """
    past = {
        (number, place): evidence(stored)
        for number, group in enumerate(groups)
        for place, stored in enumerate(group.searched)
    }
    chosen = _chosen(groups, past, parameters, parts)
    queries = []
    for number, place in chosen:
        current().check()
        group = groups[number]
        stored = group.searched[place]
        queries.append(
            query_in(group.codes, group.centroids, group.model, stored, k, past[number, place])
        )
    timing.lap("search")
    maps = [groups[number].searched[place] for number, place in chosen]
    judged = localize_jointly(
        queries, parameters, lambda one, other: pose_between(maps[one], maps[other])
    )
    full = dict(zip(chosen, judged, strict=True))
    answers = []
    for number, group in enumerate(groups):
        for place, stored in enumerate(group.searched):
            of_map = full.get((number, place))
            if of_map is None:
                usable = len(group.codes) if len(stored) else 0
                of_map = Judged(not_searched(usable, parameters, len(chosen)), 0.0)
            rival = None if of_map.rival is None else maps[of_map.rival.map]
            answers.append(InMap(stored, number, of_map, (number, place) in full, rival))
    timing.lap("verify")
    return sorted(answers, key=_rank)


def not_searched(usable: int, parameters: LocalizationParameters, full: int) -> Localization:
    """Return the localization of a map that was not searched in full."""
    told = unknown(usable, parameters)
    if told.reason != "inconsistent" or not full:
        return told
    detail = (
        f"Fewer segments agree than in the {full} best maps, which were searched in full. "
        "Name this map in 'maps' to search it in full."
    )
    return replace(told, detail=detail)


def _rank(answer: InMap) -> tuple[bool, float, float, str]:
    """Return the sort key of an answer: localized first, by probability, then by score.

    The name orders what is equal in all, such as maps without any candidate.
    """
    found = answer.judged.localization
    return (
        found.pose is None,
        -found.probability,
        -answer.judged.total,
        answer.stored.name,
    )


def _chosen(
    groups: Sequence[Group],
    past: dict[tuple[int, int], Evidence | None],
    parameters: LocalizationParameters,
    parts: Callable[[Group], list[Part]],
) -> list[tuple[int, int]]:
    """Choose the maps to search in full, by group and index."""
    every = list(past)
    if len(every) <= FULL:
        return every
    votes = np.concatenate(
        [
            votes_of(group.codes, group.centroids, group.searched, parts(group), parameters)
            for group in groups
        ]
    )
    known = [index for index, each in enumerate(every) if (before := past[each]) and before.past]
    known.sort(key=lambda index: -votes[index])
    return [every[index] for index in best_of(votes, parameters.least_segments, known)]
