"""Map alignment: the transform between two robots' maps, from descriptors and centroids.

    alignment = align(a, b, search)

The steps are in `align.py`: the second map is divided into submaps, each submap is localized in the
first map, consistent poses are combined, and each combined pose is verified on the whole overlap.
`loops.py` checks the alignments of more than two maps. No step depends on models, files or
requests.
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
