"""One version of a stored map, in memory and searchable."""

from dataclasses import dataclass

from service.maps.index import LayeredIndex
from service.maps.layers import MapLayers
from service.maps.store import MapHead

KEEPS_FRAME = frozenset({"edit", "age", "merge"})
"""Operations after which what a map held, if anything, still lies where it lay."""


@dataclass(frozen=True, slots=True, eq=False)
class MapSnapshot:
    """A map as its newest version is: readers that have one see it whole, whatever is written.

    Attributes:
        head: where the map stands in the store.
        layers: its segments.
        base_sequence: sequence of the version that the layers' base is.
        frame_since: sequence of a version since which no segment was moved in the map's frame.
        index: over its descriptors; None if the model that made them is not loaded.
    """

    head: MapHead
    layers: MapLayers
    base_sequence: int
    frame_since: int
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

    def shares_frame_with(self, other: "MapSnapshot") -> bool:
        """Whether it is another version of the same map, in the same frame."""
        return (self.head.uid, self.frame_since) == (other.head.uid, other.frame_since)

    @property
    def tag(self) -> str:
        """Names this version, of all versions of all maps."""
        return tag_of(self.head.sequence, self.head.mark)


def tag_of(sequence: int, mark: str) -> str:
    """The tag of a version: its sequence, and enough of its mark to tell it from all others."""
    return f"{mark[:16]}-{sequence}"
