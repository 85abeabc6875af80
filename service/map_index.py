"""Nearest descriptors in one map."""

from typing import Protocol

import faiss
import numpy as np

from segments.quantiser import Quantiser
from segments.types import Float64, Int8, Int64


class MapIndex(Protocol):
    """Searches the stored descriptors of one map."""

    def search(self, codes: Int8, k: int) -> tuple[Float64, Int64]:
        """The nearest rows of the map to each query.

        Args:
            codes: int8 (q, code bytes).
            k: so many, or all if the map has fewer.

        Returns:
            Distances in steps of the quantiser, float64 (q, min(k, n)), ascending; and rows,
            int64, of the same shape, ascending among equal distances.
        """


class ExactIndex:
    """Compares with every row.

    Levels are whole numbers, and squared distances of up to 258 dimensions stay below 2^24: exact
    in float32, so a distance depends neither on the batch nor on the order of summation.
    """

    def __init__(self, codes: Int8, quantiser: Quantiser) -> None:
        self._quantiser = quantiser
        levels = quantiser.levels(codes)
        self._index = faiss.IndexFlatL2(levels.shape[1])
        self._index.add(levels.astype(np.float32))

    def search(self, codes: Int8, k: int) -> tuple[Float64, Int64]:
        """The nearest rows of the map to each query."""
        k = min(k, self._index.ntotal)
        if not k:
            return np.zeros((len(codes), 0)), np.zeros((len(codes), 0), dtype=np.int64)
        squared, rows = self._index.search(self._quantiser.levels(codes).astype(np.float32), k)
        order = np.lexsort((rows, squared), axis=1)
        distances = np.sqrt(np.take_along_axis(squared, order, axis=1).astype(np.float64))
        return distances, np.take_along_axis(rows, order, axis=1)
