"""Things that several robots saw: pairs of segments, and how far they lie apart in a map."""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.pose_graph import GraphMap
from placecell.pose_graph.frames import headings

DOUBLE = 0.3
"""Distance within which two views of one thing are no double wall, meters."""


def shared_things(graph: GraphMap, true: Float64) -> Int64:
    """Return pairs of segments of different robots that show the same thing, int64 (p, 2).

    They are the nearest segments of each other where the robots truly were, within 0.3 m and seen
    from within 10 m of each other.
    """
    frames = graph.frames
    there = graph.moved(true[:, :3, 3], headings(true[:, :3, :3])).centroids
    tracks = frames.odometry.tracks[graph.captures]
    spots = true[graph.captures, :3, 3]
    pairs = []
    names = np.unique(tracks)
    for place, one in enumerate(names):
        for other in names[place + 1 :]:
            here, away = np.flatnonzero(tracks == one), np.flatnonzero(tracks == other)
            near, found = cKDTree(there[away]).query(there[here])
            _, back = cKDTree(there[here]).query(there[away])
            mutual = (back[found] == np.arange(len(here))) & (near <= DOUBLE)
            both = np.column_stack([here[mutual], away[found[mutual]]])
            close = np.linalg.norm(spots[both[:, 0]] - spots[both[:, 1]], axis=1) <= 10.0
            pairs.append(both[close])
    return np.concatenate(pairs) if pairs else np.zeros((0, 2), dtype=np.int64)


def within(graph: GraphMap, pairs: Int64) -> float:
    """Return the share of pairs of segments that lie within 0.3 m of each other in a map."""
    if not len(pairs):
        return 0.0
    apart = np.linalg.norm(graph.centroids[pairs[:, 0]] - graph.centroids[pairs[:, 1]], axis=1)
    return float((apart <= DOUBLE).mean())
