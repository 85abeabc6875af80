"""Coverage: how much of what a robot sees each map knows; a summary of its matches."""

from dataclasses import dataclass
from math import exp

from service.inference.describer import SegmentError
from service.inference.match_probability import deviation_of
from service.search.matching import MatchResult

GOOD = 0.5
"""Match probability from which a segment counts as known."""


@dataclass(frozen=True, slots=True)
class MapCoverage:
    """Share of a request's segments that one map knows.

    Attributes:
        map: name of the map.
        frame: name of its frame.
        share: share of the usable segments with a candidate in this map that is more likely right
            than wrong.
        known: number of these segments.
        probability: mean over the usable segments of the best match probability in this map; 0 for
            a segment without a candidate.
    """

    map: str
    frame: str
    share: float
    known: int
    probability: float


def coverage_of(result: MatchResult) -> tuple[int, list[MapCoverage]]:
    """Return the number of usable segments and the coverage by each map, the largest share first.

    A candidate that n other segments support has its odds multiplied by 1 + n, as in the order of
    the candidates of several models.
    """
    usable = 0
    deviations = {model.id: deviation_of(model) for model, _ in result.selection.searched}
    totals: dict[str, float] = {}
    known: dict[str, int] = {}
    for found in result:
        if isinstance(found, SegmentError):
            continue
        usable += 1
        best: dict[str, float] = {}
        for each in found:
            stated, support = each["probability"], each["support"] or 0
            if stated is None:  # the model has no pair classifier
                stated = exp(-0.5 * (each["distance"] / deviations[each["model_id"]]) ** 2)
            stated = (1 + support) * stated / (1 + support * stated)
            best[each["map"]] = max(best.get(each["map"], 0.0), stated)
        for name, stated in best.items():
            totals[name] = totals.get(name, 0.0) + stated
            known[name] = known.get(name, 0) + (stated >= GOOD)
    maps = [
        MapCoverage(
            map=snapshot.name,
            frame=snapshot.frame,
            share=known.get(snapshot.name, 0) / max(usable, 1),
            known=known.get(snapshot.name, 0),
            probability=totals.get(snapshot.name, 0.0) / max(usable, 1),
        )
        for snapshot in result.selection.maps
    ]
    return usable, sorted(maps, key=lambda each: (-each.share, -each.probability, each.map))
