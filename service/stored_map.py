"""One version of a stored map, in memory and searchable."""

from dataclasses import dataclass

import numpy as np

from segments.quantiser import Quantiser
from segments.types import Float64, Int8, Int64
from service.layers import Layers
from service.map_index import MapIndex, index_of
from service.map_store import Head


@dataclass(frozen=True, slots=True)
class LayeredIndex:
    """An index over each layer of a map."""

    base: MapIndex
    recent: MapIndex

    @classmethod
    def of(
        cls, layers: Layers, quantiser: Quantiser, base: MapIndex | None = None
    ) -> "LayeredIndex":
        """Over both layers.

        Args:
            layers: of the map.
            quantiser: of the model that made it.
            base: the base's, if it is there already.
        """
        recent = index_of(layers.recent.codes, quantiser)
        return cls(base or index_of(layers.base.codes, quantiser), recent)

    def search(self, layers: Layers, codes: Int8, k: int) -> tuple[Float64, Int64]:
        """The nearest segments to each query, over both layers; see `StoredMap.search`."""
        distances, rows = self.base.search(codes, k, layers.gone if layers.buried else None)
        if not len(layers.recent):
            return distances, rows
        nearer, above = self.recent.search(codes, k)
        distances = np.concatenate([distances, nearer], axis=1)
        rows = np.concatenate([rows, above + len(layers.base)], axis=1)
        order = np.lexsort((layers.column("ids", rows), distances), axis=1)[:, :k]
        return np.take_along_axis(distances, order, axis=1), np.take_along_axis(rows, order, axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class StoredMap:
    """A map as its newest version is: readers that have one see it whole, whatever is written.

    Attributes:
        head: where the map stands in the store.
        layers: its segments.
        folded: sequence of the version that the layers' base is.
        index: over its descriptors; None if the model that made them is not loaded.
    """

    head: Head
    layers: Layers
    folded: int
    index: LayeredIndex | None

    def __len__(self) -> int:
        return len(self.layers)

    @property
    def name(self) -> str:
        """Of the map."""
        return self.head.name

    @property
    def model_id(self) -> str:
        """Of the model that made its descriptors."""
        return self.layers.base.model_id

    @property
    def frame(self) -> str:
        """Name of its coordinate frame."""
        return self.layers.base.frame

    @property
    def tag(self) -> str:
        """Names this version, of all versions of all maps."""
        return tag_of(self.head.sequence, self.head.mark)

    def search(self, codes: Int8, k: int) -> tuple[Float64, Int64]:
        """The nearest segments to each query.

        Args:
            codes: int8 (q, code bytes).
            k: so many, or all if the map has fewer.

        Returns:
            Distances in steps of the quantiser, float64 (q, min(k, n)), ascending; and rows of
            `layers`, int64, of the same shape, by id among equal distances.
        """
        assert self.index is not None
        return self.index.search(self.layers, codes, k)


def tag_of(sequence: int, mark: str) -> str:
    """The tag of a version: its sequence, and enough of its mark to tell it from all others."""
    return f"{mark[:16]}-{sequence}"
