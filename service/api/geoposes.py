"""GeoPoses: poses in maps with a WGS 84 anchor, as poses on the Earth (OGC GeoPose 1.0)."""

from typing import Any

from scipy.spatial.transform import Rotation

from placecell.core.geodesy import GeoAnchor, rotation_at, to_geodetic
from placecell.localization import Pose

MEDIA_TYPE = "application/geopose+json"


def geopose_of(pose: Pose, anchor: GeoAnchor | None) -> dict[str, Any] | None:
    """Return a pose as a `GeoPose`; None without an anchor, or too far from it."""
    if anchor is None:
        return None
    try:
        lat, lon, height = to_geodetic(pose.translation, anchor)[0].tolist()
    except ValueError:  # the map is flat, and the Earth is not
        return None
    rotation = Rotation.from_matrix(rotation_at(pose.translation, anchor) @ pose.rotation)
    x, y, z, w = rotation.as_quat(canonical=True).tolist()
    return {
        "position": {"lat": lat, "lon": lon, "h": height},
        "quaternion": {"x": x, "y": y, "z": z, "w": w},
    }
