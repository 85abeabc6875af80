"""How two robots' maps lie to each other, from descriptors and centroids alone.

    alignment = align(a, b, looks)

goes step by step (`align.py`): the second map is cut into submaps, each is localized in the first,
poses that agree are one guess, and a guess is held against the whole overlap that follows from it.
`loops.py` checks the alignments of more than two maps. No step knows of models, files or requests.
"""

from placecell.map_alignment.align import MapAlignment, align, fits_as_well
from placecell.map_alignment.loops import PairwiseAlignment, check_loops, poses_from
from placecell.map_alignment.map_view import DescriptorSearch, MapView, MatchProbabilities
from placecell.map_alignment.overlap import Overlap
from placecell.map_alignment.parameters import AlignmentParameters

__all__ = [
    "AlignmentParameters",
    "DescriptorSearch",
    "MapAlignment",
    "MapView",
    "MatchProbabilities",
    "Overlap",
    "PairwiseAlignment",
    "align",
    "check_loops",
    "fits_as_well",
    "poses_from",
]
