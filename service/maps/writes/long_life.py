"""Segments of a map as the judgment of long life needs them."""

import numpy as np
from placecell_client import CompactMap

from placecell.lasting.judgment import ObservedSegments


def observed_segments(content: CompactMap) -> ObservedSegments:
    """Return the segments of a map with their boxes and captures; unknown sizes are zeros."""
    n = len(content)
    sides = np.zeros((n, 3)) if content.extents is None else content.extents / 10.0
    return ObservedSegments(
        centroids=content.centroids,
        sides=sides,
        viewpoints=content.frame_positions,
        captures=content.frame_index.astype(np.int64),
    )
