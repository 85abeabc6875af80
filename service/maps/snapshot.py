"""Snapshot: one version of a map, in memory and searchable; or the summary of one that is not."""

from collections import Counter
from dataclasses import dataclass

from service.maps.index import LayeredIndex
from service.maps.layers import MapLayers
from service.maps.store import MapHead

KEEPS_FRAME = frozenset({"edit", "age", "merge"})
"""Operations that leave all earlier segments where they are in the map's frame."""

MOVES_CAPTURES = frozenset({"optimize", "bend", "restore"})
"""Operations after which captures may be at other poses in the same frame; `bend` is a merge."""


@dataclass(frozen=True, slots=True)
class MapSummary:
    """Facts about the segments of a map, which a list of maps shows.

    Attributes:
        segments: number of segments.
        model_id: id of the model that made the descriptors.
        frame: name of the coordinate frame.
        robots: number of segments of each robot.
        sources: number of segments that were merged from each map, as far as that is known.
        time_span: earliest and latest time of the segments' frames, seconds; None without segments.
        optional: names of the optional columns.
        classes: number of segments of each class, and `unknown`; empty without classes.
    """

    segments: int
    model_id: str
    frame: str
    robots: Counter[str]
    sources: Counter[str]
    time_span: tuple[float, float] | None
    optional: tuple[str, ...]
    classes: dict[str, int]

    @classmethod
    def of(cls, layers: MapLayers) -> "MapSummary":
        """Summarize a map; reads the whole map."""
        return cls(
            segments=len(layers),
            model_id=layers.base.model_id,
            frame=layers.base.frame,
            robots=layers.robots,
            sources=layers.sources,
            time_span=layers.time_span,
            optional=tuple(sorted(layers.optional)),
            classes=layers.class_counts,
        )


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

    @property
    def robots(self) -> Counter[str]:
        """Number of segments of each robot."""
        return self.layers.robots

    @property
    def summary(self) -> MapSummary:
        """Summary of the segments; reads the whole map."""
        return MapSummary.of(self.layers)

    def shares_frame_with(self, other: "MapSnapshot") -> bool:
        """Return whether the other is a version of the same map in the same frame."""
        return (self.head.uid, self.frame_since) == (other.head.uid, other.frame_since)

    @property
    def tag(self) -> str:
        """ETag of this version, unique among all versions of all maps."""
        return tag_of(self.head.sequence, self.head.mark)


@dataclass(frozen=True, slots=True, eq=False)
class ColdMap:
    """One version of a map whose segments are in the store only.

    Attributes:
        head: head of the map in the store.
        frame_since: as of a snapshot.
        summary: summary of the segments.
    """

    head: MapHead
    frame_since: int
    summary: MapSummary

    @classmethod
    def of(cls, snapshot: MapSnapshot) -> "ColdMap":
        """Return what is kept of a map when its segments leave the memory."""
        return cls(snapshot.head, snapshot.frame_since, snapshot.summary)

    def __len__(self) -> int:
        return self.summary.segments

    @property
    def name(self) -> str:
        """Name of the map."""
        return self.head.name

    @property
    def model_id(self) -> str:
        """Id of the model that made the descriptors."""
        return self.summary.model_id

    @property
    def frame(self) -> str:
        """Name of the coordinate frame."""
        return self.summary.frame

    @property
    def robots(self) -> Counter[str]:
        """Number of segments of each robot."""
        return self.summary.robots

    @property
    def tag(self) -> str:
        """ETag of this version."""
        return tag_of(self.head.sequence, self.head.mark)


MapEntry = MapSnapshot | ColdMap
"""A map of the service, in memory or not."""


def tag_of(sequence: int, mark: str) -> str:
    """Return the ETag of a version: a prefix of its mark, and its sequence."""
    return f"{mark[:16]}-{sequence}"
