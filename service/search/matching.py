"""From queries to candidates in one map, some, or all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64, Int8, Int64
from service.core.auth import Holder
from service.core.problems import Problem
from service.inference.model_registry import Model, Models
from service.maps.repository import MapRepository
from service.maps.shared_index import Part, Patterns
from service.maps.snapshot import MapSnapshot

Candidate = dict[str, Any]
"""As `CandidateOut` says; not made of it, for there are hundreds a request."""


@dataclass(frozen=True, slots=True)
class Scope:
    """Which maps are searched, with the models that made them, and which are not.

    Attributes:
        searched: by model; each has an index.
        skipped: their models are not loaded, or not those of the codes.
    """

    searched: tuple[tuple[Model, tuple[MapSnapshot, ...]], ...]
    skipped: tuple[MapSnapshot, ...]

    @property
    def maps(self) -> list[MapSnapshot]:
        """All that are searched, by name."""
        every = [stored for _, group in self.searched for stored in group]
        return sorted(every, key=lambda stored: stored.name)


def scope_of(
    maps: MapRepository, models: Models, names: list[str] | None, only: Model | None, holder: Holder
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
    groups: dict[str, list[MapSnapshot]] = {}
    skipped = []
    for stored in chosen:
        made_by = stored.model_id
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


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The nearest segments to each query, nearest first; ties by map, then id.

    Attributes:
        searched: the maps.
        places: int64 (q, k), indices into them.
        rows: int64 (q, k), of each segment in its map's layers.
        distances: float64 (q, k), in the descriptors' unit.
        probabilities: of a match, float64 (q, k); None if the model has no classifier.
    """

    searched: tuple[MapSnapshot, ...]
    places: Int64
    rows: Int64
    distances: Float64
    probabilities: Float64 | None

    def candidates(self) -> Callable[[int], list[Candidate]]:
        """Return a function from a query's row to its candidates, as `CandidateOut` has them.

        They are made when they are asked for: those of all queries at once take many times the room
        of their answer.
        """
        ids = np.zeros(self.rows.shape, dtype=np.int64)
        centroids = np.zeros((*self.rows.shape, 3))
        robots = np.full(self.rows.shape, "", dtype=object)
        for place, stored in enumerate(self.searched):
            here = self.places == place
            rows, layers = self.rows[here], stored.layers
            ids[here] = layers.column("ids", rows)
            centroids[here] = layers.column("centroids", rows)
            robots[here] = layers.robot_names(rows)
        names = [(stored.name, stored.frame, stored.model_id) for stored in self.searched]
        stated = (
            np.full(self.rows.shape, None) if self.probabilities is None else self.probabilities
        )
        columns = self.places, ids, robots, self.distances, stated, centroids

        def of_query(row: int) -> list[Candidate]:
            return [
                {
                    "map": names[place][0],
                    "id": id_,
                    "robot": robot,
                    "distance": distance,
                    "probability": probability,
                    "centroid": centroid,
                    "frame": names[place][1],
                    "model_id": names[place][2],
                }
                for place, id_, robot, distance, probability, centroid in zip(
                    *(column[row].tolist() for column in columns), strict=True
                )
            ]

        return of_query


def found_in(
    codes: Int8,
    model: Model,
    searched: tuple[MapSnapshot, ...],
    k: int,
    parts: Sequence[Part] | None = None,
) -> Found:
    """Return the k nearest candidates over all maps.

    Args:
        codes: int8 (q, code bytes), the queries.
        model: that made them and the maps.
        searched: maps with an index, by name.
        k: candidates a query, at most.
        parts: that cover the maps, to search several at once; None: each by itself.
    """
    token = current()
    if parts is None:
        parts = [Part(np.array([place]), None) for place in range(len(searched))]
    found = np.zeros((len(codes), 0)), *np.zeros((2, len(codes), 0), dtype=np.int64)
    for part in parts:
        token.check()
        here = _nearest(codes, searched, part, k)
        found = tuple(np.concatenate(both, axis=1) for both in zip(found, here, strict=True))
        if len(parts) > 1:
            # By distance in steps, then map; those of a map are in the order of their ids, and stay
            # so. Never more than of two parts at once, however many there are.
            order = np.lexsort(found[1::-1], axis=1)[:, :k]
            found = tuple(np.take_along_axis(each, order, axis=1) for each in found)
    distances, places, rows = found
    probabilities = _probabilities(codes, model, searched, places, rows)
    lengths = distances * model.manifest.quantizer.step
    return Found(searched, places, rows, lengths, probabilities)


def _nearest(
    codes: Int8, searched: tuple[MapSnapshot, ...], part: Part, k: int
) -> tuple[Float64, Int64, Int64]:
    """Search one part: distances in steps, places and rows of the k nearest, (q, up to k) each."""
    if part.shared is None:
        place = int(part.places[0])
        stored = searched[place]
        assert stored.index is not None
        distances, rows = stored.index.search(stored.layers, codes, k)
        return distances, np.full_like(rows, place), rows
    shared = part.shared
    distances, found = shared.index.search(codes, k, part.hidden)
    members = np.searchsorted(shared.starts, found, side="right") - 1
    return distances, part.places[members], shared.rows[found]


def parts_of(
    maps: MapRepository, model: Model, searched: Sequence[MapSnapshot], patterns: Patterns
) -> list[Part]:
    """Return the parts to search for these maps of one model.

    Args:
        patterns: what keys open; maps that are searched together are opened by the same keys.
    """
    quantizer = model.manifest.quantizer
    return maps.shared.parts(searched, maps.all(), model.id, quantizer, patterns)


def merged(by_model: list[list[Candidate]], k: int) -> list[Candidate]:
    """Merge one query's candidates of several models, the most probable first.

    Distances of two models do not compare. Each probability is calibrated, but on its own model's
    pairs; so equal ones, such as those at a cap, are in the order of their ranks among their own
    model's candidates, then by map and id. Candidates of models without a probability come last.
    """
    if len(by_model) == 1:
        return by_model[0]
    every = [(rank, each) for candidates in by_model for rank, each in enumerate(candidates)]
    every.sort(key=lambda one: _standing(*one))
    return [candidate for _, candidate in every[:k]]


def _standing(rank: int, candidate: Candidate) -> tuple[bool, float, int, str, int]:
    """Return a candidate's sort key among those of several models."""
    probability = candidate["probability"]
    stated = 0.0 if probability is None else probability
    return probability is None, -stated, rank, candidate["map"], candidate["id"]


def _probabilities(
    codes: Int8, model: Model, searched: tuple[MapSnapshot, ...], places: Int64, rows: Int64
) -> Float64 | None:
    """Return the probability of each candidate of each query, (q, k)."""
    if model.classifier is None:
        return None
    found = np.empty((*rows.shape, codes.shape[1]), dtype=np.int8)
    for place, stored in enumerate(searched):
        here = places == place
        found[here] = stored.layers.column("codes", rows[here])
    asked = np.repeat(codes, rows.shape[1], axis=0)
    stated = model.classifier.probabilities(asked, found.reshape(asked.shape))
    return stated.reshape(rows.shape)
