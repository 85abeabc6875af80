"""Writer of GeoJSON: segments and the robot's way in WGS 84, around an anchor."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from placecell.core.types import Float64, UInt8
from placecell.export.content import ExportContent

EQUATOR = 6_378_137.0
"""Equatorial radius of WGS 84, meters."""
ECCENTRICITY_SQUARED = 6.694379990141e-3
FARTHEST = 100_000.0
"""Largest distance from the anchor, meters: a plane is a poor picture of the Earth beyond."""


@dataclass(frozen=True, slots=True)
class Anchor:
    """Place of a map's origin on the Earth.

    Attributes:
        latitude: degrees, north positive.
        longitude: degrees, east positive.
        yaw_deg: angle from east to the map's x axis, degrees, counter-clockwise.
    """

    latitude: float
    longitude: float
    yaw_deg: float = 0.0


def parse_anchor(text: str) -> Anchor:
    """Parse LAT,LON or LAT,LON,YAW_DEG.

    Raises:
        ValueError: the text has another form, or a value is out of range.
    """
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    fits = len(values) in (2, 3) and bool(np.isfinite(values).all())
    if not fits or abs(values[0]) > 85 or abs(values[1]) > 180:
        raise ValueError(
            f"Invalid --anchor {text!r}: expected LAT,LON or LAT,LON,YAW_DEG in degrees, such as "
            "49.011,8.424 (latitude -85 to 85, longitude -180 to 180)."
        )
    return Anchor(*values)


def to_wgs84(points: Float64, anchor: Anchor) -> Float64:
    """Return longitude, latitude (degrees) and height of points in the map, float64 (n, 3).

    The plane of the map touches the ellipsoid at the anchor; the radii there are those of WGS 84.

    Raises:
        ValueError: a point is too far from the anchor.
    """
    if len(points) and np.abs(points[:, :2]).max() > FARTHEST:
        raise ValueError(
            f"A point is {np.abs(points[:, :2]).max() / 1000:,.0f} km from the anchor; expected at "
            f"most {FARTHEST / 1000:g} km. The map may be georeferenced already"
        )
    yaw, latitude = np.radians(anchor.yaw_deg), np.radians(anchor.latitude)
    east = np.cos(yaw) * points[:, 0] - np.sin(yaw) * points[:, 1]
    north = np.sin(yaw) * points[:, 0] + np.cos(yaw) * points[:, 1]
    bend = 1 - ECCENTRICITY_SQUARED * np.sin(latitude) ** 2
    across = EQUATOR / np.sqrt(bend)
    along = EQUATOR * (1 - ECCENTRICITY_SQUARED) / bend**1.5
    return np.column_stack(
        [
            anchor.longitude + np.degrees(east / (across * np.cos(latitude))),
            anchor.latitude + np.degrees(north / along),
            points[:, 2],
        ]
    )


def write_geojson(content: ExportContent, color: UInt8, file: Path, anchor: Anchor) -> None:
    """Write a feature for each segment, and one for each robot's way (RFC 7946)."""
    places = np.round(to_wgs84(content.centroids, anchor), 8).tolist()
    features: list[dict[str, Any]] = []
    for index, place in enumerate(places):
        features.append(
            {
                "type": "Feature",
                "geometry": {"type": "Point", "coordinates": place},
                "properties": {
                    "id": int(content.ids[index]),
                    "robot": content.robots[int(content.robot[index])],
                    "group": int(content.groups[index]),
                    "size_m": content.extents[index].round(2).tolist(),
                    "marker-color": "#" + bytes(color[index]).hex(),
                },
            }
        )
    way = np.round(to_wgs84(content.poses[:, :3, 3], anchor), 8).tolist()
    if len(way) > 1:
        features.append(
            {
                "type": "Feature",
                "geometry": {"type": "LineString", "coordinates": way},
                "properties": {"name": "sensor positions", "captures": len(way)},
            }
        )
    collection = {"type": "FeatureCollection", "features": features}
    file.write_text(json.dumps(collection) + "\n", encoding="utf-8")
