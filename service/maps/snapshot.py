"""Snapshot: one version of a map, in memory and searchable."""

from dataclasses import dataclass

from service.maps.index import LayeredIndex
from service.maps.layers import MapLayers
from service.maps.store import MapHead

KEEPS_FRAME = frozenset({"edit", "age", "merge"})
"""Operations that leave all earlier segments where they are in the map's frame."""

MOVES_CAPTURES = frozenset({"optimize", "bend", "restore"})
"""Operations after which captures may be at other poses in the same frame; `bend` is a merge."""


@dataclass(frozen=True, slots=True, eq=False)
class MapSnapshot:
    """One version of a map, which never changes, whatever is written in the meantime.

    Attributes:
        head: head of the map in the store.
        layers: the segments.
        base_sequence: sequence of the version that the layers' base is.
        frame_since: sequence of a version since which no segment was moved in the map's frame.
        index: index over the descriptors; None if their model is not loaded.
    """

    head: MapHead
    layers: MapLayers
    base_sequence: int
    frame_since: int
    index: LayeredIndex | None

    def __len__(self) -> int:
        return len(self.layers)

    def __repr__(self) -> str:
        return f"MapSnapshot({self.name!r}, {len(self):,} segments)"

    @property
    def name(self) -> str:
        """Name of the map."""
        return self.head.name

    @property
    def model_id(self) -> str:
        """Id of the model that made the descriptors."""
        return self.layers.base.model_id

    @property
    def frame(self) -> str:
        """Name of the coordinate frame."""
        return self.layers.base.frame

    def shares_frame_with(self, other: "MapSnapshot") -> bool:
        """Return whether the other is a version of the same map in the same frame."""
        return (self.head.uid, self.frame_since) == (other.head.uid, other.frame_since)

    @property
    def tag(self) -> str:
        """ETag of this version, unique among all versions of all maps."""
        return tag_of(self.head.sequence, self.head.mark)


def tag_of(sequence: int, mark: str) -> str:
    """Return the ETag of a version: a prefix of its mark, and its sequence."""
    return f"{mark[:16]}-{sequence}"
