"""Pose graph: loops of a map that drifted, and the poses of its captures that fit them best.

    bent = bend(graph, search)

The steps are in `bend.py`: captures are localized in other parts of the map, loops are judged, and
poses are optimized with GTSAM, which is imported only then. No step depends on models, files or
requests.
"""

from placecell.pose_graph.bend import BentMap, JudgedLoop, bend, judged
from placecell.pose_graph.frames import CaptureOdometry, GraphFrames
from placecell.pose_graph.loops import FoundLoop, GraphMap, SegmentSearch
from placecell.pose_graph.optimize import PoseGraphUnavailableError
from placecell.pose_graph.parameters import PoseGraphParameters

__all__ = [
    "BentMap",
    "CaptureOdometry",
    "FoundLoop",
    "GraphFrames",
    "GraphMap",
    "JudgedLoop",
    "PoseGraphParameters",
    "PoseGraphUnavailableError",
    "SegmentSearch",
    "bend",
    "judged",
]
