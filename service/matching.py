"""From queries to candidates in one map, some, or all."""

from dataclasses import dataclass

import numpy as np

from segments.pairs import PairClassifier
from segments.types import Int8
from service.maps import Maps, StoredMap
from service.problems import Problem
from service.schemas import CandidateOut, CandidatesOut


@dataclass(frozen=True, slots=True)
class Scope:
    """Which maps are searched, and which are not because another model made them."""

    searched: tuple[StoredMap, ...]
    skipped: tuple[StoredMap, ...]


def scope_of(maps: Maps, names: list[str] | None, model_id: str) -> Scope:
    """The maps of these names, or all.

    Raises:
        Problem: 404 if a name is unknown, 409 if another model made a named map.
    """
    if names is None:
        everything = maps.all()
        return Scope(
            searched=tuple(stored for stored in everything if stored.index is not None),
            skipped=tuple(stored for stored in everything if stored.index is None),
        )
    named = tuple(maps.get(name) for name in sorted(set(names)))
    for stored in named:
        if stored.index is None:
            raise Problem(
                409,
                "other-model",
                f"Map {stored.name!r} was made by model {stored.content.model_id!r}; "
                f"loaded is {model_id!r}.",
            )
    return Scope(named, ())


def candidates_of(
    codes: Int8,
    searched: tuple[StoredMap, ...],
    k: int,
    step: float,
    classifier: PairClassifier | None,
) -> list[CandidatesOut]:
    """The k nearest over all maps, nearest first; ties by map, then id.

    Args:
        codes: int8 (q, code bytes), the queries.
        searched: maps with an index.
        k: candidates a query, at most.
        step: of the quantiser, so that distances are in the descriptor's unit.
        classifier: for the probability of a match; None leaves it out.
    """
    # Distance in steps, map, row (rows of a map are sorted by id): sorts as wanted.
    found: list[list[tuple[float, int, int]]] = [[] for _ in codes]
    for place, stored in enumerate(searched):
        if stored.index is None:
            continue
        distances, rows = stored.index.search(codes, k)
        for hits, query_distances, query_rows in zip(
            found, distances.tolist(), rows.tolist(), strict=True
        ):
            hits.extend(
                (distance, place, row)
                for distance, row in zip(query_distances, query_rows, strict=True)
            )
    nearest = [sorted(hits)[:k] for hits in found]
    probabilities = iter(_probabilities(codes, searched, nearest, classifier))
    return [
        CandidatesOut(
            candidates=[
                _candidate(searched[place], row, distance * step, next(probabilities))
                for distance, place, row in hits
            ]
        )
        for hits in nearest
    ]


def _probabilities(
    codes: Int8,
    searched: tuple[StoredMap, ...],
    nearest: list[list[tuple[float, int, int]]],
    classifier: PairClassifier | None,
) -> list[float] | list[None]:
    """Of each candidate of each query, in order; all at once: a call costs more than a row."""
    pairs = [
        (query, searched[place].content.codes[row])
        for query, hits in zip(codes, nearest, strict=True)
        for _, place, row in hits
    ]
    if classifier is None or not pairs:
        return [None] * len(pairs)
    a, b = (np.stack(side) for side in zip(*pairs, strict=True))
    return [float(value) for value in classifier.probabilities(a, b)]


def _candidate(
    stored: StoredMap, row: int, distance: float, probability: float | None
) -> CandidateOut:
    content = stored.content
    x, y, z = content.centroids[row].tolist()
    return CandidateOut(
        map=stored.name,
        id=int(content.ids[row]),
        robot=content.robots[content.robot[row]],
        distance=distance,
        probability=probability,
        centroid=(x, y, z),
        frame=content.frame,
    )
