"""From two stored maps to how they lie to each other."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Float64, Int64
from placecell.map_alignment import AlignmentParameters, MapAlignment, MapView, align
from service.core.problems import Problem
from service.inference.match_probability import match_probabilities
from service.inference.model_registry import Model
from service.maps.index import MapIndex, index_of
from service.maps.snapshot import MapSnapshot

K = 25
"""Candidates of each view of a submap's thing."""

BLOCK = 1 << 16
"""Pairs that are compared at once: their descriptors are much larger than what is told of them."""


SEARCHED = 512
"""Segments searched per step; cancellation is checked between steps."""

Check = Callable[[], None]
"""Raises an exception when nobody waits any longer; is asked for each part of a map."""


@dataclass(frozen=True, slots=True, eq=False)
class MapSide:
    """A stored map made ready to be aligned, once for all maps that it is held against.

    Attributes:
        stored: the map.
        content: all of it in one piece, whose rows an alignment names.
        view: where its segments are, and were seen from.
    """

    stored: MapSnapshot
    content: CompactMap
    view: MapView

    @classmethod
    def of(cls, stored: MapSnapshot) -> "MapSide":
        """Of a map as it is now."""
        content = stored.layers.content()
        viewpoints = content.frame_positions[content.frame_index]
        return cls(stored, content, MapView(content.centroids, viewpoints))

    def index(self, model: Model) -> MapIndex:
        """Over its content: the map's own, or a new one if the map was written to since."""
        stored = self.stored
        if stored.index is not None and self.content is stored.layers.base:
            return stored.index.base
        return index_of(self.content.codes, model.manifest.quantizer)


class StoredMatchProbabilities:
    """`MatchProbabilities` of two maps, a and b, that one model made."""

    def __init__(
        self, model: Model, a: CompactMap, b: CompactMap, check: Check = lambda: None
    ) -> None:
        self._model = model
        self._a, self._b = a.codes, b.codes
        self._check = check

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        """How likely each row of a and row of b are the same."""
        told = [np.zeros(0)]
        for begin in range(0, len(a), BLOCK):
            self._check()
            block = slice(begin, begin + BLOCK)
            told.append(match_probabilities(self._model, self._b[b[block]], self._a[a[block]]))
        return np.concatenate(told)


class StoredDescriptorSearch(StoredMatchProbabilities):
    """`DescriptorSearch` of two maps."""

    def __init__(
        self,
        model: Model,
        a: CompactMap,
        b: CompactMap,
        index: MapIndex,
        check: Check = lambda: None,
    ) -> None:
        """With an index over a."""
        super().__init__(model, a, b, check)
        self._index = index

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        """Of each row of b the rows of a that look most like it, and how likely."""
        distinct, inverse = np.unique(rows, return_inverse=True)
        parts = []
        for begin in range(0, max(len(distinct), 1), SEARCHED):
            self._check()
            _, near = self._index.search(self._b[distinct[begin : begin + SEARCHED]], K)
            parts.append(near)
        found = np.concatenate(parts)
        asked = np.repeat(distinct, found.shape[1])
        match_probabilities = self.match_probabilities(found.ravel(), asked).reshape(found.shape)
        return found[inverse], match_probabilities[inverse]


def align_maps(
    a: MapSide,
    b: MapSide,
    index: MapIndex,
    model: Model,
    parameters: AlignmentParameters,
    check: Check = lambda: None,
) -> MapAlignment:
    """How b lies to a, with a's index."""
    search = StoredDescriptorSearch(model, a.content, b.content, index, check)
    return align(a.view, b.view, search, parameters)


def check_same_model(a: MapSnapshot, b: MapSnapshot) -> None:
    """See that two maps can be compared; 409 if not."""
    if a.model_id != b.model_id:
        raise Problem(
            409,
            "other-model",
            f"Map {a.name!r} was made by model {a.model_id!r}, map {b.name!r} by {b.model_id!r}; "
            "descriptors of two models do not compare.",
        )
