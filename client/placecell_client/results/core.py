"""What the service answers, typed."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class ItemError:
    """Why one segment of a request could not be used, while others were."""

    type: str
    title: str
    detail: str


@dataclass(frozen=True, slots=True, eq=False)
class Description:
    """Descriptors of n segments.

    Attributes:
        model_id: of the model that made them.
        codes: int8 (n, code bytes), the stored form, for maps and for `Client.match`.
        descriptors: float32 (n, d), before they were rounded to codes.
        centroids: float64 (n, 3), metres, in the frame of the request.
        errors: by index, the segments that could not be used; their codes are 0, the rest is NaN.
        dropped_points: points that were not finite and were left out.
    """

    model_id: str
    codes: NDArray[np.int8]
    descriptors: NDArray[np.float32]
    centroids: NDArray[np.float64]
    errors: dict[int, ItemError]
    dropped_points: int = 0


@dataclass(frozen=True, slots=True)
class Candidate:
    """A segment of a map that looks like the query.

    Attributes:
        map: the map's name.
        id: of the segment in that map.
        robot: that put it there.
        distance: between the stored descriptors.
        probability: that both are the same place; None if the model has no classifier.
        centroid: metres, in the map's frame.
        frame: name of the map's frame.
        model_id: of the model that made the map: the probability is by its pair classifier, and
            the distance between its descriptors. Empty from a service older than this field.
    """

    map: str
    id: int
    robot: str
    distance: float
    probability: float | None
    centroid: tuple[float, float, float]
    frame: str
    model_id: str = ""


@dataclass(frozen=True, slots=True)
class Skipped:
    """A map that was not searched: another model made it."""

    map: str
    model_id: str


@dataclass(frozen=True, slots=True)
class Matches:
    """Candidates of each query, nearest first; those of several models most probable first.

    Attributes:
        model_id: of the model whose descriptors were compared.
        queries: candidates of query i; empty if it could not be used.
        errors: by index, the queries that could not be used.
        searched: names of the maps.
        skipped: maps of other models.
        dropped_points: points that were not finite and were left out.
    """

    model_id: str
    queries: tuple[tuple[Candidate, ...], ...]
    errors: dict[int, ItemError]
    searched: tuple[str, ...]
    skipped: tuple[Skipped, ...]
    dropped_points: int = 0


@dataclass(frozen=True, slots=True)
class MapSummary:
    """A stored map.

    Attributes:
        name: of the map.
        segments: in it.
        sequence: of its newest version; each write makes one.
        etag: names that version, of all versions of all maps.
        bytes: that it takes in the service's store, with its old versions.
        model_id: of the model that made it; searched only if the service has that model loaded.
        frame: name of its coordinate frame.
        robots: how many segments each has in it.
        time_span: earliest and latest time, seconds; None for a map without segments.
        optional: names of the optional columns that it has.
        sources: how many segments were merged from each map, as far as the service tells.
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

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapSummary":
        """From the service's JSON; fields that a later service adds are left out."""
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
            sources=dict(content.get("sources", {})),  # an earlier service tells none
        )


@dataclass(frozen=True, slots=True)
class Maps:
    """The stored maps; a sequence of those that can be read.

    Attributes:
        maps: by name.
        damaged: names of those that are stored but cannot be read, and so are not served.
    """

    maps: tuple[MapSummary, ...]
    damaged: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[MapSummary]:
        return iter(self.maps)

    def __len__(self) -> int:
        return len(self.maps)


@dataclass(frozen=True, slots=True)
class Written:
    """What a write to a map did.

    Attributes:
        map: its name.
        sequence: of its version after the write.
        etag: of that version.
        segments: in the map after it.
        changed: segments added or replaced; 0 also if the write had been done before.
        removed: segments removed.
        repeats: segments that were not stored, for they were seen before.
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
        """From the service's JSON."""
        return cls(**{name: content[name] for name in cls.__slots__})


@dataclass(frozen=True, slots=True)
class MapVersion:
    """A version of a map.

    Attributes:
        sequence: its number; they grow by one.
        etag: names it, of all versions of all maps.
        time: when it was written, Unix seconds of the service's clock.
        author: name of the key that wrote it.
        operation: such as `put`, `edit`, `restore`, `age`.
        changed: segments added or replaced.
        removed: segments removed.
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
        """From the service's JSON."""
        return cls(**{name: content[name] for name in cls.__slots__})


@dataclass(frozen=True, slots=True)
class PartialUpload:
    """A map file that is uploaded in parts and is not complete.

    Attributes:
        digest: SHA-256 of the whole file, 64 hex digits.
        bytes: that the service has received.
        time: of the last part, Unix seconds of the service's clock.
    """

    digest: str
    bytes: int
    time: float


@dataclass(frozen=True, slots=True)
class Info:
    """Versions, limits and costs of a service.

    Attributes:
        version: of the service.
        model_id: of the model that it has loaded.
        model: the model's manifest in short.
        limits: by name; see the service's `/info`.
        costs: seconds of one core for each unit of work, by name; see the service's `/info`. Empty
            of a service that does not tell them.
        map_file_version: of the map files that it reads.
    """

    version: str
    model_id: str
    model: dict[str, Any]
    limits: dict[str, float]
    map_file_version: int
    costs: dict[str, Any] = field(default_factory=dict)
