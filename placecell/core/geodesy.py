"""Geodesy: positions on the WGS 84 ellipsoid, and the place of a map on it.

Formulas: Hofmann-Wellenhof, Lichtenegger and Wasle, *GNSS*, section 8.2; geodetic latitude by
Bowring, *Survey Review* 23 (1976).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from placecell.core.types import Float64

EQUATOR = 6_378_137.0
"""Equatorial radius of WGS 84, meters."""
FLATTENING = 1 / 298.257223563
ECCENTRICITY_SQUARED = FLATTENING * (2 - FLATTENING)
POLE = EQUATOR * (1 - FLATTENING)
FARTHEST = 100_000.0
"""Largest distance from the anchor, meters. A map is flat, and the Earth is not."""


@dataclass(frozen=True, slots=True)
class GeoAnchor:
    """Place of a map on the Earth: the WGS 84 coordinates of one point of the map, and its yaw.

    Attributes:
        lat: latitude, degrees, north positive.
        lon: longitude, degrees, east positive.
        height: height above the ellipsoid, meters.
        yaw_deg: angle from east to the map's x axis, degrees, counter-clockwise.
        accuracy: standard deviation of the position along an axis, meters.
        position: x, y, z of the anchored point in the map's frame, meters.
    """

    lat: float
    lon: float
    height: float = 0.0
    yaw_deg: float = 0.0
    accuracy: float = 0.0
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def rotation(self) -> Float64:
        """Rotation from the map's frame to east, north, up at the anchor, float64 (3, 3)."""
        cos, sin = np.cos(np.radians(self.yaw_deg)), np.sin(np.radians(self.yaw_deg))
        return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])

    def moved(self, rotation: Float64, translation: Float64) -> "GeoAnchor":
        """Return the anchor of the same place in another map's frame.

        Args:
            rotation: (3, 3), rotation from this map's frame to the other's, about z.
            translation: (3,), origin of this frame in the other's, meters.
        """
        x, y, z = (rotation @ np.array(self.position) + translation).tolist()
        turn = np.degrees(np.arctan2(rotation[1, 0], rotation[0, 0]))
        yaw = float((self.yaw_deg - turn + 180) % 360 - 180)
        return replace(self, yaw_deg=yaw, position=(x, y, z))


def ecef_of(lat: ArrayLike, lon: ArrayLike, height: ArrayLike) -> Float64:
    """Return earth-centered, earth-fixed coordinates, meters, float64 (..., 3)."""
    phi, lam = np.radians(np.asarray(lat, np.float64)), np.radians(np.asarray(lon, np.float64))
    h = np.asarray(height, np.float64)
    across = EQUATOR / np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    return np.stack(
        [
            (across + h) * np.cos(phi) * np.cos(lam),
            (across + h) * np.cos(phi) * np.sin(lam),
            (across * (1 - ECCENTRICITY_SQUARED) + h) * np.sin(phi),
        ],
        axis=-1,
    )


def geodetic_of(ecef: Float64) -> Float64:
    """Return latitude, longitude (degrees) and height (meters), float64 (..., 3)."""
    x, y, z = np.moveaxis(np.asarray(ecef, np.float64), -1, 0)
    axis = np.hypot(x, y)
    second = ECCENTRICITY_SQUARED / (1 - ECCENTRICITY_SQUARED)
    reduced = np.arctan2(z * EQUATOR, axis * POLE)
    phi = reduced
    # Near the surface, one step is exact to a nanometer; the second is for great heights.
    for _ in range(2):
        phi = np.arctan2(
            z + second * POLE * np.sin(reduced) ** 3,
            axis - ECCENTRICITY_SQUARED * EQUATOR * np.cos(reduced) ** 3,
        )
        reduced = np.arctan2(POLE * np.sin(phi), EQUATOR * np.cos(phi))
    height = (
        axis * np.cos(phi)
        + z * np.sin(phi)
        - EQUATOR * np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    )
    return np.stack([np.degrees(phi), np.degrees(np.arctan2(y, x)), height], axis=-1)


def enu_axes(lat: float, lon: float) -> Float64:
    """Return the axes east, north, up at a place as rows in earth-centered coordinates, (3, 3)."""
    phi, lam = np.radians(lat), np.radians(lon)
    return np.array(
        [
            [-np.sin(lam), np.cos(lam), 0.0],
            [-np.sin(phi) * np.cos(lam), -np.sin(phi) * np.sin(lam), np.cos(phi)],
            [np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)],
        ]
    )


def to_geodetic(points: Float64, anchor: GeoAnchor) -> Float64:
    """Return latitude, longitude (degrees) and height of points in the map, float64 (n, 3).

    Raises:
        ValueError: a point is too far from the anchor.
    """
    local = np.asarray(points, np.float64).reshape(-1, 3) - np.array(anchor.position)
    if len(local) and np.abs(local[:, :2]).max() > FARTHEST:
        raise ValueError(
            f"A point is {np.abs(local[:, :2]).max() / 1000:,.0f} km from the anchor; expected at "
            f"most {FARTHEST / 1000:g} km. The map may be georeferenced already"
        )
    enu = local @ anchor.rotation.T
    origin = ecef_of(anchor.lat, anchor.lon, anchor.height)
    return geodetic_of(origin + enu @ enu_axes(anchor.lat, anchor.lon))


def to_map(places: Float64, anchor: GeoAnchor) -> Float64:
    """Return points in the map, float64 (n, 3), of latitudes, longitudes (degrees) and heights."""
    given = np.asarray(places, np.float64).reshape(-1, 3)
    origin = ecef_of(anchor.lat, anchor.lon, anchor.height)
    away = ecef_of(given[:, 0], given[:, 1], given[:, 2]) - origin
    enu = away @ enu_axes(anchor.lat, anchor.lon).T
    return np.asarray(enu @ anchor.rotation + np.array(anchor.position))


def rotation_at(point: Float64, anchor: GeoAnchor) -> Float64:
    """Return the rotation from the map's frame to east, north, up at a point of the map, (3, 3).

    It differs a little from that at the anchor: meridians converge, and the Earth is curved.
    """
    lat, lon, _ = to_geodetic(point, anchor)[0].tolist()
    there, here = enu_axes(lat, lon), enu_axes(anchor.lat, anchor.lon)
    return np.asarray(there @ here.T @ anchor.rotation)
