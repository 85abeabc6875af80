"""Results about anchors: the place of a map on the Earth, and named poses in it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class MapMirror:
    """Source of a map that is a read-only copy of another service's map.

    Attributes:
        source: URL of that map.
        etag: ETag of the version there that was copied last; empty before the first copy.
        time: Time of the last copy, Unix seconds.
    """

    source: str
    etag: str
    time: float

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapMirror":
        """Build from the service's JSON; unknown fields are ignored."""
        return cls(**{name: content[name] for name in cls.__slots__})


@dataclass(frozen=True, slots=True)
class MapAnchor:
    """Place of a map on the Earth (WGS 84).

    Attributes:
        map: Name of the map.
        lat: Latitude, degrees.
        lon: Longitude, degrees.
        height: Height above the ellipsoid, meters.
        yaw_deg: Angle from east to the map's x axis, degrees, counter-clockwise.
        accuracy: Standard deviation of the position along an axis, meters.
        position: Point of the map that is at this place, in the map's frame, meters.
        frame: Name of the map's frame when the anchor was written.
        applies: Whether the map still has this frame.
        author: Name of the API key that wrote it.
        time: Time of the write, Unix seconds.
    """

    map: str
    lat: float
    lon: float
    height: float
    yaw_deg: float
    accuracy: float
    position: tuple[float, float, float]
    frame: str
    applies: bool
    author: str
    time: float

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapAnchor":
        """Build from the service's JSON; unknown fields are ignored."""
        x, y, z = content["position"]
        return cls(**{name: content[name] for name in cls.__slots__} | {"position": (x, y, z)})


@dataclass(frozen=True, slots=True, eq=False)
class MapAnchorFit:
    """Anchor that was fitted to GNSS fixes.

    Attributes:
        anchor: The anchor.
        dry_run: Whether nothing was written.
        yaw_deviation_deg: Standard deviation of its yaw, degrees.
        residuals: Horizontal distance of each fix from its place by the anchor, meters, float64
            (fixes,).
        is_inlier: Whether each fix agrees with the anchor, bool (fixes,).
    """

    anchor: MapAnchor
    dry_run: bool
    yaw_deviation_deg: float
    residuals: NDArray[np.float64]
    is_inlier: NDArray[np.bool_]

    @classmethod
    def of(cls, content: dict[str, Any]) -> "MapAnchorFit":
        """Build from the service's JSON."""
        residuals = content["residuals"]
        return cls(
            anchor=MapAnchor.of(content["anchor"]),
            dry_run=content["dry_run"],
            yaw_deviation_deg=content["yaw_deviation_deg"],
            residuals=np.array([each["meters"] for each in residuals], dtype=np.float64),
            is_inlier=np.array([each["inlier"] for each in residuals], dtype=np.bool_),
        )


@dataclass(frozen=True, slots=True, eq=False)
class AnchorPose:
    """Named pose in a map.

    Attributes:
        name: Name of the anchor.
        position: Position in the map's frame, meters, float64 (3,).
        orientation: Orientation as a quaternion x, y, z, w, float64 (4,).
        frame: Name of the map's frame when the anchor was written.
        applies: Whether the map still has this frame.
        author: Name of the API key that wrote it.
        time: Time of the write, Unix seconds.
    """

    name: str
    position: NDArray[np.float64]
    orientation: NDArray[np.float64]
    frame: str
    applies: bool
    author: str
    time: float

    @classmethod
    def of(cls, content: dict[str, Any]) -> "AnchorPose":
        """Build from the service's JSON; unknown fields are ignored."""
        values = {name: content[name] for name in cls.__slots__}
        for name in ("position", "orientation"):
            values[name] = np.array(values[name], dtype=np.float64)
        return cls(**values)


@dataclass(frozen=True, slots=True)
class Coverage:
    """Share of a request's segments that one map knows.

    Attributes:
        map: Name of the map.
        frame: Name of its frame.
        share: Share of the usable segments whose best candidate in this map is more likely right
            than wrong, 0 to 1.
        known: Number of these segments.
        probability: Mean of the best match probability of each usable segment in this map.
    """

    map: str
    frame: str
    share: float
    known: int
    probability: float

    @classmethod
    def of(cls, content: dict[str, Any]) -> "Coverage":
        """Build from the service's JSON; unknown fields are ignored."""
        return cls(**{name: content[name] for name in cls.__slots__})
