"""How two robots' maps lie to each other, from descriptors and centroids alone.

    alignment = align(a, b, looks)

goes step by step (`align.py`): the second map is cut into submaps, each is localized in the first,
poses that agree are one guess, and a guess is held against the whole overlap that follows from it.
`loops.py` checks the alignments of more than two maps. No step knows of models, files or requests.
"""

from placecell.map_alignment.align import MapAlignment, align, lies_as_well
from placecell.map_alignment.loops import Alignment, check_loops, poses_from
from placecell.map_alignment.map_view import Likeness, Looks, MapView
from placecell.map_alignment.overlap import Overlap
from placecell.map_alignment.parameters import AlignmentParameters

__all__ = [
    "Alignment",
    "AlignmentParameters",
    "Likeness",
    "Looks",
    "MapAlignment",
    "MapView",
    "Overlap",
    "align",
    "check_loops",
    "lies_as_well",
    "poses_from",
]
