"""Search for similar segments within one stored map, for the loops of its pose graph."""

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Bool, Float64, Int64
from placecell.descriptors.site_calibration import SiteCalibration
from service.inference.match_probability import QueryComparison
from service.inference.model_registry import Model
from service.maps.index import MapIndex

PAIRS = 1 << 16
"""Number of pairs compared per step, because their descriptors take much memory."""


class StoredSegmentSearch:
    """Nearest rows and match probabilities within one map (`SegmentSearch`)."""

    def __init__(
        self, model: Model, content: CompactMap, index: MapIndex, site: SiteCalibration | None
    ) -> None:
        """Create it.

        Args:
            model: model that made the codes.
            content: segments of the map.
            index: index over their codes.
            site: calibration of the map; None if the model has no site constants.
        """
        self._codes = content.codes
        self._index = index
        self._comparison = QueryComparison(content.codes, model, site, comparable=True)

    def nearest(self, rows: Int64, excluded: Bool, k: int) -> tuple[Int64, Float64]:
        """Return the k most similar rows of each row, apart from excluded ones."""
        distinct, inverse = np.unique(rows, return_inverse=True)
        _, found = self._index.search(self._codes[distinct], k, excluded)
        asked = np.repeat(distinct, found.shape[1])
        probabilities = self.match_probabilities(found.ravel(), asked).reshape(found.shape)
        return found[inverse], probabilities[inverse]

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        """Return the match probability of each row of a with the query row of b beside it."""
        parts = [np.zeros(0)]
        for begin in range(0, len(a), PAIRS):
            block = slice(begin, begin + PAIRS)
            parts.append(self._comparison.probabilities(b[block], self._codes[a[block]]))
        return np.concatenate(parts)
