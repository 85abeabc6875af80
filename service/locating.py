"""From queries to the robot's place in one map."""

from segments.localisation import Candidates, Localisation, LocalisationParameters, localise
from segments.localisation.evidence import Evidence
from segments.types import Float64, Int8
from service.matching import found_in
from service.models import Model
from service.stored_map import StoredMap
from service.timing import Timing


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
    candidates = Candidates(
        centroids,
        found.rows,
        stored.layers.column("centroids", found.rows),
        found.distances,
        found.probabilities,
    )
    localisation = localise(candidates, parameters, evidence=evidence)
    timing.lap("verify")
    return localisation
