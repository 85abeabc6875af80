"""Cost of a request: an estimate in seconds of one core, made before the work.

A request within the limits on size can still be more work than its deadline allows: 1,000 queries
in maps of a hundred million segments, or the alignment of two maps of a million segments. Such a
request is refused at once (413) with its cost, the limit and a remedy. The estimate leaves out what
is not known before (number of poses tried, load of the machine): the deadline stops such work.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from placecell.core.parameters import NeighborhoodParameters
from placecell.core.types import Float32, Int64
from placecell.descriptors.reranking import DEPTH, NEIGHBORS
from placecell.map_alignment import AlignmentParameters
from service.core.problems import Problem

MACHINE = "one core of an Intel Xeon (Emerald Rapids), processor time, best of 3"


@dataclass(frozen=True, slots=True)
class Rates:
    """Seconds of one core per unit of work, measured with the default model on `MACHINE`."""

    point: float = 4.0e-8
    """Seconds per point of a segment: neighborhood voxels, orientation, the network's grid."""
    segment: float = 2.3e-4
    """Seconds per segment in the network."""
    near_voxel: float = 2.9e-9
    """Seconds per pair of a segment and another segment's voxel within reach, for a model with a
    neighborhood."""
    compared: float = 1.2e-9
    """Seconds per pair of a query and a map segment."""
    compared_k: float = 2.8e-11
    """Seconds per pair of a query and a map segment, for each candidate wanted."""
    candidate: float = 1.1e-6
    """Seconds per candidate of a query whose match probability is computed."""
    scanned: float = 4.6e-6
    """Seconds per point of a point cloud file: reading, leveling, segmentation."""
    supported: float = 3.4e-8
    """Seconds per pair of a candidate and a neighbor's candidate that may support it: the bound,
    reached if all pairs fit. In an ordinary request few do, and it takes a twentieth."""


RATES = Rates()


@dataclass(frozen=True, slots=True)
class Cost:
    """Cost of a request by kind of work, seconds of one core."""

    points: float = 0.0
    network: float = 0.0
    neighborhoods: float = 0.0
    search: float = 0.0
    candidates: float = 0.0
    scan: float = 0.0

    @property
    def seconds(self) -> float:
        """Return the sum over all kinds of work."""
        return sum(float(getattr(self, field.name)) for field in fields(self))

    def __add__(self, other: "Cost") -> "Cost":
        return Cost(
            **{
                field.name: getattr(self, field.name) + getattr(other, field.name)
                for field in fields(self)
            }
        )

    @property
    def largest(self) -> str:
        """Return the kind of work that costs most."""
        return max((field.name for field in fields(self)), key=lambda name: getattr(self, name))


NOTHING = Cost()

REMEDIES = {
    "points": "Send fewer points, such as one for each voxel of 0.1 m.",
    "network": "Send fewer segments.",
    "neighborhoods": "Send fewer segments, or fewer points of each.",
    "search": "Name fewer maps, or send fewer segments.",
    "scan": "Send fewer points, such as one for each voxel of 0.1 m.",
    "candidates": "Ask for fewer candidates (k), or send fewer segments.",
}


def check_cost(cost: Cost, limit: float, remedy: str | None = None) -> None:
    """Refuse work that costs more than a limit.

    Args:
        cost: cost of the request.
        limit: largest cost, seconds.
        remedy: advice to the client. Default: the advice for the largest kind of work.

    Raises:
        Problem: 413, the cost is above the limit.
    """
    if cost.seconds > limit:
        raise Problem(
            413,
            "too-much-work",
            f"The request would cost {cost.seconds:.1f} s of one core, most of it for "
            f"{cost.largest}; the limit is {limit:g} s. {remedy or REMEDIES[cost.largest]}",
        )


def cost_of_describing(
    points: Float32, counts: Int64, looks: NeighborhoodParameters | None
) -> Cost:
    """Return the cost of describing segments.

    Args:
        points: float32 (n, 3), points of the segments, one after the other.
        counts: int64 (segments,), points of each, 1 or more.
        looks: parameters of the neighborhood; None if the model uses none.
    """
    near = 0 if looks is None else near_voxels(points, counts, looks)
    return Cost(
        points=len(points) * RATES.point,
        network=len(counts) * RATES.segment,
        neighborhoods=near * RATES.near_voxel,
    )


def cost_of_segmenting(points: int) -> Cost:
    """Return the cost of segmenting the points of a file."""
    return Cost(scan=points * RATES.scanned)


def near_voxels(points: Float32, counts: Int64, looks: NeighborhoodParameters) -> int:
    """Estimate the number of pairs of a segment and a voxel within reach; seldom too low.

    Pairs are counted along each horizontal axis alone, and the axis with fewer pairs counts. So
    the estimate takes no longer than sorting the segments.
    """
    if not len(counts):
        return 0
    starts = np.cumsum(counts) - counts
    low = np.minimum.reduceat(points, starts, axis=0).astype(np.float64)
    high = np.maximum.reduceat(points, starts, axis=0).astype(np.float64)
    fit = np.prod(np.floor((high - low) / looks.voxel) + 1, axis=1)
    voxels = np.minimum(np.nan_to_num(fit, nan=1.0, posinf=np.inf), counts)
    middles, reach = (low + high) / 2, float(looks.rings[-1])
    fewest = np.inf
    for axis in (0, 1):
        along = middles[:, axis]
        order = np.argsort(along)
        total = np.append(0.0, np.cumsum(voxels[order]))
        begin = np.searchsorted(along[order], along - reach, side="left")
        end = np.searchsorted(along[order], along + reach, side="right")
        fewest = min(fewest, float((total[end] - total[begin]).sum()))
    return int(fewest)


def cost_of_search(queries: int, rows: int, k: int, models: int, is_reranked: bool = False) -> Cost:
    """Return the cost of searching candidates.

    Args:
        queries: number of segments or codes of the request.
        rows: number of segments of all searched maps.
        k: candidates per query.
        models: number of models whose maps are searched.
        is_reranked: whether the candidates are re-ranked.
    """
    found = queries * min(k * models, rows)
    pairs = found * min(NEIGHBORS, queries - 1) * min(DEPTH, k) if is_reranked else 0
    return Cost(
        search=queries * rows * (RATES.compared + RATES.compared_k * k),
        candidates=found * RATES.candidate + pairs * RATES.supported,
    )


def cost_of_aligning(sizes: Sequence[int], k: int, parameters: AlignmentParameters) -> Cost:
    """Return the cost of aligning every pair of some maps.

    Args:
        sizes: number of segments of each map; each is searched for segments of all later ones.
        k: candidates per segment.
        parameters: constants of the alignment.
    """
    asked = parameters.submaps * parameters.landmarks
    total = NOTHING
    for place, rows in enumerate(sizes):
        for other in sizes[place + 1 :]:
            total += cost_of_search(min(other, asked), rows, k, 1)
    return total
