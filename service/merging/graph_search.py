"""Search for similar segments within stored maps, for the loops of a pose graph."""

import numpy as np

from placecell.core.types import Bool, Float64, Int8, Int64
from placecell.descriptors.site_calibration import SiteCalibration
from service.inference.match_probability import QueryComparison
from service.inference.model_registry import Model
from service.maps.index import MapIndex

PAIRS = 1 << 16
"""Number of pairs compared per step, because their descriptors take much memory."""


class StoredSegmentSearch:
    """Nearest rows and match probabilities among some segments (`SegmentSearch`)."""

    def __init__(
        self, model: Model, codes: Int8, index: MapIndex, site: SiteCalibration | None
    ) -> None:
        """Create it.

        Args:
            model: model that made the codes.
            codes: int8 (n, code bytes), codes of the segments.
            index: index over their codes.
            site: calibration of the map; None if the model has no site constants.
        """
        self._codes = codes
        self._index = index
        self._comparison = QueryComparison(codes, model, site, comparable=True)

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
