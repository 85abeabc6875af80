"""Results of point cloud files, and the scope of a key."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.http.encoding import row_of
from placecell_client.results.core import Written


@dataclass(frozen=True, slots=True, eq=False)
class ScannedFile:
    """Segments of a point cloud file, in a level frame whose origin is the sensor.

    Attributes:
        format: Format of the file, such as `PCD`.
        points: Number of points in the file.
        dropped_points: Number of points that were left out.
        segments: Points of each segment, float32 (n, 3), meters, for `Client.localize`.
        sensors: Sensor position of each segment, float64 (segments, 3), meters.
        centroids: Centroid of each segment, float64 (segments, 3), meters.
        extents: Sides of each segment's axis-aligned box, float64 (segments, 3), meters.
        cloud: Points of the scan to show, float32 (m, 3), meters.
        labels: Segment of each of them, int32 (m,); -1: ground, -2: no segment.
        transform: Transform from the file's frame to this frame, float64 (4, 4).
        sensor_height: Height of the sensor above the ground, meters; None if no ground was found.
        problems: Oddities of the scan, and the assumptions that the service made.
    """

    format: str
    points: int
    dropped_points: int
    segments: tuple[NDArray[np.float32], ...]
    sensors: NDArray[np.float64]
    centroids: NDArray[np.float64]
    extents: NDArray[np.float64]
    cloud: NDArray[np.float32]
    labels: NDArray[np.int32]
    transform: NDArray[np.float64]
    sensor_height: float | None
    problems: tuple[str, ...]

    def __repr__(self) -> str:
        return (
            f"ScannedFile({self.format}, {self.points:,} points, {len(self.segments):,} segments)"
        )

    @classmethod
    def of(cls, content: dict[str, Any]) -> "ScannedFile":
        """Build from the service's answer in either encoding."""
        segments = content["segments"]
        return cls(
            format=content["format"],
            points=content["points"],
            dropped_points=content["dropped_points"],
            segments=tuple(row_of(each["points"], "<f4").reshape(-1, 3) for each in segments),
            sensors=np.array(content["sensors"], np.float64).reshape(-1, 3),
            centroids=np.array([each["centroid"] for each in segments]).reshape(-1, 3),
            extents=np.array([each["extents"] for each in segments]).reshape(-1, 3),
            cloud=row_of(content["cloud"]["points"], "<f4").reshape(-1, 3),
            labels=row_of(content["cloud"]["labels"], "<i4"),
            transform=np.array(content["transform"], np.float64).reshape(4, 4),
            sensor_height=content["sensor_height"],
            problems=tuple(content["problems"]),
        )


@dataclass(frozen=True, slots=True)
class AddedScan:
    """Result of adding a scan to a map.

    Attributes:
        written: The new version of the map, and the numbers of changed and repeated segments.
        ids: Ids of the added segments, in the order of the scan.
        unusable: Number of segments that the model cannot describe.
        problems: Oddities of the scan, and the assumptions that the service made.
    """

    written: Written
    ids: tuple[int, ...]
    unusable: int
    problems: tuple[str, ...]

    @classmethod
    def of(cls, content: dict[str, Any]) -> "AddedScan":
        """Build from the service's JSON."""
        return cls(
            Written.of(content),
            tuple(content["ids"]),
            content["unusable"],
            tuple(content["problems"]),
        )


@dataclass(frozen=True, slots=True)
class KeyScope:
    """Scope of the client's API key.

    Attributes:
        name: Name of the key's principal; `anyone` if the service has no keys; empty if the key is
            not known.
        role: `none` if the key is not known; else `read`, `write` or `admin`.
        may_write: Whether the key may write maps in its scope.
        maps: Patterns of the names of its maps, with * and ?.
        robot: Robot whose segments alone the key may write; None for all robots.
        open: Whether the service has no keys, so that every client may do everything.
    """

    name: str
    role: str
    may_write: bool
    maps: tuple[str, ...]
    robot: str | None
    open: bool

    @classmethod
    def of(cls, content: dict[str, Any]) -> "KeyScope":
        """Build from the service's JSON; unknown fields are ignored."""
        values = {name: content[name] for name in cls.__slots__}
        return cls(**values | {"maps": tuple(content["maps"])})
