"""Writer of GeoJSON: segments and the robot's way in WGS 84, around an anchor."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.core.types import Float64, UInt8
from placecell.export.content import ExportContent


def parse_anchor(text: str) -> GeoAnchor:
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
    lat, lon, *yaw = values
    return GeoAnchor(lat, lon, yaw_deg=yaw[0] if yaw else 0.0)


def write_geojson(content: ExportContent, color: UInt8, file: Path, anchor: GeoAnchor) -> None:
    """Write a feature for each segment, and one for each robot's way (RFC 7946)."""
    places = _coordinates(content.centroids, anchor)
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
    way = _coordinates(content.poses[:, :3, 3], anchor)
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


def _coordinates(points: Float64, anchor: GeoAnchor) -> list[list[float]]:
    """Return points of the map as GeoJSON has them: longitude, latitude, height."""
    placed: list[list[float]] = np.round(to_geodetic(points, anchor)[:, [1, 0, 2]], 8).tolist()
    return placed
