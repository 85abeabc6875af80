"""Alignment of two stored maps: the transform between their frames."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Float64, Int64
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters, MapAlignment, MapView, align
from service.core.problems import Problem
from service.inference.match_probability import match_probabilities
from service.inference.model_registry import Model
from service.maps.index import MapIndex, index_of
from service.maps.snapshot import MapSnapshot

K = 25
"""Number of candidates of each view of an object in a submap."""

BLOCK = 1 << 16
"""Number of pairs compared per step, because their descriptors take much memory."""

SEARCHED = 512
"""Number of segments searched per step; cancellation is checked between steps."""

CancellationCheck = Callable[[], None]
"""Raises `Cancelled` if the deadline passed or the client disconnected."""


@dataclass(frozen=True, slots=True, eq=False)
class MapSide:
    """Stored map, prepared once for its alignments with several maps.

    Attributes:
        snapshot: the map.
        content: its segments in one piece; an alignment refers to their rows.
        view: positions of the segments and of the sensor when it saw them.
    """

    snapshot: MapSnapshot
    content: CompactMap
    view: MapView

    @classmethod
    def of(
        cls,
        snapshot: MapSnapshot,
        prepare: Callable[[CompactMap], CompactMap] | None = None,
    ) -> "MapSide":
        """Prepare a map; `prepare` may change the poses of its captures."""
        content = snapshot.layers.content()
        return cls.holding(snapshot, content if prepare is None else prepare(content))

    @classmethod
    def holding(cls, snapshot: MapSnapshot, content: CompactMap) -> "MapSide":
        """Return a map with this content, whose captures may be at other poses."""
        viewpoints = content.frame_positions[content.frame_index]
        return cls(snapshot, content, MapView(content.centroids, viewpoints))

    def index(self, model: Model) -> MapIndex:
        """Return an index over the content; builds one if the map has two layers."""
        snapshot = self.snapshot
        if snapshot.index is not None and self.content is snapshot.layers.base:
            return snapshot.index.base
        return index_of(self.content.codes, model.manifest.quantizer)


@dataclass(frozen=True, slots=True, eq=False)
class AlignedMaps:
    """Two stored maps and the alignment of the second one with the first one.

    Attributes:
        a: the first map.
        b: the second map.
        found: their alignment; its rows are those of the two contents.
    """

    a: MapSide
    b: MapSide
    found: MapAlignment

    @property
    def pose(self) -> Pose | None:
        """Return the pose of b's frame in a's; None if the maps are not aligned."""
        return self.found.pose


class StoredMatchProbabilities:
    """Match probabilities between maps a and b of one model (`MatchProbabilities`)."""

    def __init__(
        self, model: Model, a: CompactMap, b: CompactMap, check: CancellationCheck = lambda: None
    ) -> None:
        self._model = model
        self._a, self._b = a.codes, b.codes
        self._check = check

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        """Return the match probability of each row of a with the row of b beside it."""
        probabilities = [np.zeros(0)]
        for begin in range(0, len(a), BLOCK):
            self._check()
            block = slice(begin, begin + BLOCK)
            probabilities.append(
                match_probabilities(self._model, self._b[b[block]], self._a[a[block]])
            )
        return np.concatenate(probabilities)


class StoredDescriptorSearch(StoredMatchProbabilities):
    """Nearest rows and match probabilities between maps a and b (`DescriptorSearch`)."""

    def __init__(
        self,
        model: Model,
        a: CompactMap,
        b: CompactMap,
        index: MapIndex,
        check: CancellationCheck = lambda: None,
    ) -> None:
        """Create it from an index over a."""
        super().__init__(model, a, b, check)
        self._index = index

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        """Return the rows of a most similar to each row of b, and their match probabilities."""
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
    check: CancellationCheck = lambda: None,
) -> MapAlignment:
    """Align b with a, given an index over a."""
    search = StoredDescriptorSearch(model, a.content, b.content, index, check)
    return align(a.view, b.view, search, parameters)


def check_same_model(a: MapSnapshot, b: MapSnapshot) -> None:
    """Check that two maps have the same model; 409 if not."""
    if a.model_id != b.model_id:
        raise Problem(
            409,
            "other-model",
            f"Map {a.name!r} was made by model {a.model_id!r}, map {b.name!r} by {b.model_id!r}. "
            "Descriptors of two models cannot be compared; build both maps with one model.",
        )
