"""Submaps: parts of a map that were seen from about one place."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.spatial import evenly
from placecell.core.types import Float64, Int64
from placecell.localization import Candidates
from placecell.localization.correspondences import number_places
from placecell.map_alignment.map_view import DescriptorSearch, MapView
from placecell.map_alignment.parameters import AlignmentParameters


@dataclass(frozen=True, slots=True, eq=False)
class Submap:
    """Part of a map.

    Attributes:
        middle: float64 (3,), meters, mean of the centroids in the map's frame.
        rows: int64 (n,), ascending, rows of the map.
    """

    middle: Float64
    rows: Int64


def cut(view: MapView, parameters: AlignmentParameters) -> list[Submap]:
    """Divide a map into submaps around viewpoints that are at least the spacing apart."""
    viewpoints = view.viewpoints[spread(view.viewpoints, parameters.spacing)]
    chosen = viewpoints[evenly(np.arange(len(viewpoints)), parameters.submaps)]
    if not len(chosen):
        return []
    tree = cKDTree(view.viewpoints)
    submaps = []
    for viewpoint in chosen:
        about = tree.query_ball_point(viewpoint, parameters.submap_radius, return_sorted=True)
        rows = evenly(np.array(about, dtype=np.int64), parameters.rows)
        submaps.append(Submap(view.centroids[rows].mean(axis=0), rows))
    return submaps


def spread(points: Float64, spacing: float) -> Int64:
    """Return indices of points that are at least the spacing apart, int64 (m,)."""
    numbers = number_places(np.arange(len(points)), points, spacing)
    # The first point of each number, in the order of `number_places`, is its leader.
    order = np.lexsort((*points.T[::-1], numbers))
    return order[np.flatnonzero(np.diff(numbers[order], prepend=-1))]


def candidates_of(
    submap: Submap,
    view: MapView,
    other: MapView,
    search: DescriptorSearch,
    parameters: AlignmentParameters,
) -> Candidates:
    """Return the candidates of a submap's landmarks in the other map.

    The views of a landmark, closer to each other than `same_place`, are one query.

    Args:
        submap: submap of the source map.
        view: source map.
        other: target map.
        search: search for similar segments of the target map.
        parameters: constants of alignment.
    """
    rows = submap.rows
    numbers = number_places(rows, view.centroids[rows], parameters.local.same_place)
    order = np.argsort(numbers, kind="stable")
    _, starts, counts = np.unique(numbers[order], return_index=True, return_counts=True)
    means = np.add.reduceat(view.centroids[rows][order], starts) / counts[:, None]
    asking = evenly(np.arange(len(starts)), parameters.landmarks)
    starts, counts, means = starts[asking], counts[asking], means[asking]
    # Some evenly spread views of each landmark. If it has few views, some are repeated.
    shares = np.arange(parameters.views) / parameters.views
    places = starts[:, None] + np.floor(shares * counts[:, None]).astype(np.int64)
    asked = rows[order][places]
    repeats = np.zeros(places.shape, dtype=bool)
    repeats[:, 1:] = places[:, 1:] == places[:, :-1]
    found, probabilities = search.nearest(asked.ravel())
    probabilities = np.where(repeats.ravel()[:, None], 0.0, probabilities)
    landmarks = len(starts)
    return Candidates(
        means,
        found.reshape(landmarks, -1),
        other.centroids[found].reshape(landmarks, -1, 3),
        probabilities.reshape(landmarks, -1),
    )
