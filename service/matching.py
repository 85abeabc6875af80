"""From queries to candidates in one map, some, or all."""

from dataclasses import dataclass

import numpy as np

from segments.types import Int8, Int64
from service.keys import Holder
from service.maps import Maps, StoredMap
from service.models import Model, Models
from service.problems import Problem
from service.schemas import CandidateOut


@dataclass(frozen=True, slots=True)
class Scope:
    """Which maps are searched, with the models that made them, and which are not.

    Attributes:
        searched: by model; each has an index.
        skipped: their models are not loaded, or not those of the codes.
    """

    searched: tuple[tuple[Model, tuple[StoredMap, ...]], ...]
    skipped: tuple[StoredMap, ...]

    @property
    def maps(self) -> list[StoredMap]:
        """All that are searched, by name."""
        every = [stored for _, group in self.searched for stored in group]
        return sorted(every, key=lambda stored: stored.name)


def scope_of(
    maps: Maps, models: Models, names: list[str] | None, only: Model | None, holder: Holder
) -> Scope:
    """The maps of these names, or all that the key opens.

    Args:
        only: the model that made the codes; None: segments are described by any model.

    Raises:
        Problem: 403 if a name is not for this key, 404 if it is unknown, 409 if the map's model is
            not loaded or not that of the codes.
    """
    if names is None:
        chosen = [stored for stored in maps.all() if holder.opens(stored.name)]
    else:
        for name in names:
            holder.check_map(name)
        chosen = [maps.get(name) for name in sorted(set(names))]
    groups: dict[str, list[StoredMap]] = {}
    skipped = []
    for stored in chosen:
        made_by = stored.content.model_id
        if stored.index is not None and only in (None, models.find(made_by)):
            groups.setdefault(made_by, []).append(stored)
        elif names is None:
            skipped.append(stored)
        else:
            there = only.id if only is not None else ", ".join(each.id for each in models.all())
            raise Problem(
                409,
                "other-model",
                f"Map {stored.name!r} was made by model {made_by!r}; there is {there}.",
            )
    searched = [(models.named(made_by), tuple(group)) for made_by, group in groups.items()]
    return Scope(tuple(searched), tuple(skipped))


def candidates_of(
    codes: Int8, model: Model, searched: tuple[StoredMap, ...], k: int
) -> list[list[CandidateOut]]:
    """The k nearest over all maps, nearest first; ties by map, then id.

    Args:
        codes: int8 (q, code bytes), the queries.
        model: that made them and the maps.
        searched: maps with an index.
        k: candidates a query, at most.
    """
    found = np.zeros((len(codes), 0)), *np.zeros((2, len(codes), 0), dtype=np.int64)
    for place, stored in enumerate(searched):
        assert stored.index is not None
        distances, rows = stored.index.search(codes, k)
        here = distances, np.full_like(rows, place), rows
        found = tuple(np.concatenate(both, axis=1) for both in zip(found, here, strict=True))
        # By distance in steps, map, row (rows of a map are sorted by id). Never more than of two
        # maps at once, however many there are.
        order = np.lexsort(found[::-1], axis=1)[:, :k]
        found = tuple(np.take_along_axis(each, order, axis=1) for each in found)
    distances, places, rows = found
    probabilities = _probabilities(codes, model, searched, places, rows)
    lengths = distances * model.manifest.quantiser.step
    return [
        [
            _candidate(searched[place], row, length, probability)
            for place, row, length, probability in zip(*query, strict=True)
        ]
        for query in zip(
            places.tolist(), rows.tolist(), lengths.tolist(), probabilities, strict=True
        )
    ]


def merged(by_model: list[list[CandidateOut]], k: int) -> list[CandidateOut]:
    """One query's candidates of several models: the likeliest, for their distances do not compare.

    Of models without a probability they come last.
    """
    if len(by_model) == 1:
        return by_model[0]
    every = [candidate for candidates in by_model for candidate in candidates]
    return sorted(every, key=lambda one: -(one.probability or 0.0))[:k]


def _probabilities(
    codes: Int8, model: Model, searched: tuple[StoredMap, ...], places: Int64, rows: Int64
) -> list[list[float | None]]:
    """Of each candidate of each query, (q, k); all at once: a call costs more than a row."""
    queries, k = rows.shape
    if model.classifier is None or not rows.size:
        return [[None] * k for _ in range(queries)]
    found = np.empty((queries, k, codes.shape[1]), dtype=np.int8)
    for place, stored in enumerate(searched):
        here = places == place
        found[here] = stored.content.codes[rows[here]]
    asked = np.repeat(codes, k, axis=0)
    stated = model.classifier.probabilities(asked, found.reshape(asked.shape))
    return [list(row) for row in np.asarray(stated, np.float64).reshape(queries, k).tolist()]


def _candidate(
    stored: StoredMap, row: int, distance: float, probability: float | None
) -> CandidateOut:
    content = stored.content
    x, y, z = content.centroids[row].tolist()
    # Not validated: the values are our own, and there are hundreds a request.
    return CandidateOut.model_construct(
        map=stored.name,
        id=int(content.ids[row]),
        robot=content.robots[content.robot[row]],
        distance=distance,
        probability=probability,
        centroid=(x, y, z),
        frame=content.frame,
    )
