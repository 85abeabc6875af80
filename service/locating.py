"""From queries to the robot's place in one map."""

import numpy as np

from segments.localisation import Candidates, Localisation, LocalisationParameters, localise
from segments.localisation.evidence import Evidence
from segments.types import Float64, Int8, Int64
from service.likeness import likely
from service.matching import found_in
from service.models import Model
from service.stored_map import StoredMap
from service.timing import Timing


class MapSurroundings:
    """`Surroundings` of a stored map."""

    def __init__(self, codes: Int8, model: Model, stored: StoredMap) -> None:
        """For queries of these codes, int8 (q, code bytes), of the model that made the map."""
        self._codes = codes
        self._model = model
        self._layers = stored.layers

    def about(self, places: Float64, metres: float) -> tuple[Int64, Float64]:
        """Rows about places, and their centroids."""
        rows = self._layers.rows_about(places, metres)
        return rows, self._layers.column("centroids", rows)

    def likely(self, queries: Int64, rows: Int64) -> Float64:
        """How likely each query and row are the same."""
        return likely(self._model, self._codes[queries], self._layers.column("codes", rows))


def localise_in(
    codes: Int8,
    centroids: Float64,
    model: Model,
    stored: StoredMap,
    k: int,
    parameters: LocalisationParameters,
    timing: Timing,
    evidence: Evidence | None = None,
) -> Localisation:
    """Where in a map the robot is.

    Args:
        codes: int8 (q, code bytes), of the segments around the robot.
        centroids: float64 (q, 3), theirs, metres, in the robot's frame.
        model: that made them and the map.
        stored: with an index.
        k: candidates a segment, at most.
        evidence: of the robot's earlier requests.
    """
    found = found_in(codes, model, (stored,), k)
    timing.lap("search")
    there = MapSurroundings(codes, model, stored)
    probabilities = found.probabilities
    if probabilities is None:
        queries = np.repeat(np.arange(len(codes)), found.rows.shape[1])
        probabilities = there.likely(queries, found.rows.ravel()).reshape(found.rows.shape)
    places = stored.layers.column("centroids", found.rows)
    candidates = Candidates(centroids, found.rows, places, probabilities)
    localisation = localise(candidates, parameters, model.confidence, evidence, there)
    timing.lap("verify")
    return localisation
