"""Results of describing, matching, and of reading and writing maps."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class ItemError:
    """Reason why one segment of a request could not be used.

    Attributes:
        type: Kind of problem as a URI.
        title: Kind of problem in a few words.
        detail: Fault of this segment.
    """

    type: str
    title: str
    detail: str


@dataclass(frozen=True, slots=True, eq=False)
class Description:
    """Descriptors of n segments.

    Attributes:
        model_id: Id of the model that computed the descriptors.
        codes: Stored form of the descriptors, int8 (n, code bytes), for maps and `Client.match`.
        descriptors: Descriptors before quantization to codes, float32 (n, d).
        centroids: Centroids in the frame of the request, meters, float64 (n, 3).
        errors: Segments that could not be used, by index. Their codes are 0, their descriptors and
            centroids NaN.
        dropped_points: Number of points that were not finite and were left out.
        classes: Class of each segment and its probability, as `placecell_client.classes` reads
            them, uint8 (n,); 0: unknown. None if the model has no semantic head.
        heights: Vertical sides of the segments' boxes, meters, float64 (n,); NaN: unknown. None if
            none is known. `Client.localize` sends them, for the height of the pose.
    """

    model_id: str
    codes: NDArray[np.int8]
    descriptors: NDArray[np.float32]
    centroids: NDArray[np.float64]
    errors: dict[int, ItemError]
    dropped_points: int = 0
    classes: NDArray[np.uint8] | None = None
    heights: NDArray[np.float64] | None = None

    def __repr__(self) -> str:
        return (
            f"Description({len(self.codes):,} segments, {len(self.errors)} errors, {self.model_id})"
        )


@dataclass(frozen=True, slots=True)
class Candidate:
    """Candidate: a map segment with a descriptor near the query's.

    Attributes:
        map: Name of the map.
        id: Id of the segment in that map.
        robot: Robot that stored the segment.
        distance: Euclidean distance between the stored descriptors.
        probability: Match probability, 0 to 1; None if the model has no pair classifier.
        centroid: Centroid in the map's frame, meters.
        frame: Name of the map's frame.
        model_id: Id of the model of the map, which gives distance and probability. Empty if the
            service is older than this field.
        support: Number of other queries, at most 32, that have a candidate at the same offset from
            this one as from the query, turned by one yaw. None if the candidates were not
            re-ranked.
    """

    map: str
    id: int
    robot: str
    distance: float
    probability: float | None
    centroid: tuple[float, float, float]
    frame: str
    model_id: str = ""
    support: int | None = None


@dataclass(frozen=True, slots=True)
class Skipped:
    """Map that was not searched: its model is not loaded or not the requested one.

    Attributes:
        map: Name of the map.
        model_id: Id of the map's model.
    """

    map: str
    model_id: str


@dataclass(frozen=True, slots=True)
class Matches:
    """Candidates of each query, best first: by distance, or by distance and support.

    With several models they are ordered by probability in place of distance.

    Attributes:
        model_id: Id of the model whose descriptors were compared.
        queries: Candidates of query i; empty if the query could not be used.
        errors: Queries that could not be used, by index.
        searched: Names of the searched maps.
        skipped: Maps that were not searched, because of their model.
        dropped_points: Number of points that were not finite and were left out.
    """

    model_id: str
    queries: tuple[tuple[Candidate, ...], ...]
    errors: dict[int, ItemError]
    searched: tuple[str, ...]
    skipped: tuple[Skipped, ...]
    dropped_points: int = 0


@dataclass(frozen=True, slots=True)
class MapSummary:
    """Summary of a stored map.

    Attributes:
        name: Name of the map.
        segments: Number of segments.
        sequence: Sequence number of the newest version; each write makes one.
        etag: ETag of the newest version, unique among all versions of all maps.
        bytes: Size in the service's store with all versions, bytes.
        model_id: Id of the map's model; the map is searched only if this model is loaded.
        frame: Name of the map's coordinate frame.
        robots: Number of segments of each robot.
        time_span: Earliest and latest frame time, seconds; None for a map without segments.
        optional: Names of the map's optional columns.
        sources: Number of segments that were merged from each map. Empty if the service is older
            than this field.
        tags: Tags of the map, sorted. Empty if the service is older than this field.
        classes: Number of segments of each class, and `unknown`. Empty if the map has no classes.
    """

    name: str
    segments: int
    sequence: int
    etag: str
    bytes: int
    model_id: str
    frame: str
    robots: dict[str, int]
    time_span: tuple[float, float] | None
    optional: tuple[str, ...]
    sources: dict[str, int] = field(default_factory=dict)
    tags: tuple[str, ...] = ()
    classes: dict[str, int] = field(default_factory=dict)

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapSummary":
        """Build from the service's JSON; unknown fields are ignored."""
        span = content["time_span"]
        return cls(
            name=content["name"],
            segments=content["segments"],
            sequence=content["sequence"],
            etag=content["etag"],
            bytes=content["bytes"],
            model_id=content["model_id"],
            frame=content["frame"],
            robots=dict(content["robots"]),
            time_span=(span[0], span[1]) if span is not None else None,
            optional=tuple(content["optional"]),
            sources=dict(content.get("sources", {})),  # older services have no such fields
            tags=tuple(content.get("tags", ())),
            classes=dict(content.get("classes", {})),
        )


@dataclass(frozen=True, slots=True)
class Maps:
    """Stored maps; iterating yields the readable maps.

    Attributes:
        maps: Readable maps, sorted by name.
        damaged: Names of maps that cannot be read and are not served.
    """

    maps: tuple[MapSummary, ...]
    damaged: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[MapSummary]:
        return iter(self.maps)

    def __len__(self) -> int:
        return len(self.maps)


@dataclass(frozen=True, slots=True)
class Written:
    """Result of a write to a map.

    Attributes:
        map: Name of the map.
        sequence: Sequence number of the version after the write.
        etag: ETag of that version.
        segments: Number of segments after the write.
        changed: Number of segments added or replaced; 0 if the write changed nothing.
        removed: Number of segments removed.
        repeats: Number of segments that were not stored, because the map has them already.
    """

    map: str
    sequence: int
    etag: str
    segments: int
    changed: int
    removed: int
    repeats: int

    @classmethod
    def of(cls, content: dict[str, Any]) -> "Written":
        """Build from the service's JSON."""
        return cls(**{name: content[name] for name in cls.__slots__})


@dataclass(frozen=True, slots=True)
class MapVersion:
    """Version of a map.

    Attributes:
        sequence: Sequence number; it grows by one per version.
        etag: ETag of the version, unique among all versions of all maps.
        time: Time of the write on the service's clock, Unix seconds.
        author: Principal whose API key wrote the version.
        operation: Kind of write, such as `put`, `edit`, `restore` or `age` (`Client.prune_map`).
        changed: Number of segments added or replaced.
        removed: Number of segments removed.
    """

    sequence: int
    etag: str
    time: float
    author: str
    operation: str
    changed: int
    removed: int

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapVersion":
        """Build from the service's JSON."""
        return cls(**{name: content[name] for name in cls.__slots__})


@dataclass(frozen=True, slots=True)
class PartialUpload:
    """Unfinished upload of a map file in parts.

    Attributes:
        digest: SHA-256 of the whole file, 64 hexadecimal digits.
        bytes: Number of bytes that the service has received.
        time: Time of the last part on the service's clock, Unix seconds.
    """

    digest: str
    bytes: int
    time: float


@dataclass(frozen=True, slots=True)
class Info:
    """Versions, limits and costs of a service.

    Attributes:
        version: Version of the service.
        model_id: Id of the default model.
        model: Short form of the default model's manifest.
        limits: Limits by name; `GET /info` documents them.
        costs: Processor time per unit of work by name, seconds; `GET /info` documents them. Empty
            if the service is older than this field.
        map_file_version: Version of the map files that the service reads.
    """

    version: str
    model_id: str
    model: dict[str, Any]
    limits: dict[str, float]
    map_file_version: int
    costs: dict[str, Any] = field(default_factory=dict)
