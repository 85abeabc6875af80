"""Fit of a WGS 84 anchor to GNSS fixes: robust least squares for yaw and offset.

Some fixes are off by many meters, because a signal was reflected. So a grid of yaws is tried with
medians, which half of the fixes cannot spoil, and the best one is refined by reweighted least
squares with a shrinking scale (graduated non-convexity; Yang et al., RA-L 2020).
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.geodesy import GeoAnchor, ecef_of, enu_axes, geodetic_of
from placecell.core.types import Bool, Float64, Int64

FEWEST = 3
"""Smallest number of fixes: two determine yaw and offset, and the third can contradict them."""

LARGEST_DEVIATION_DEG = 2.0
"""Largest standard deviation of the yaw. At 100 m from the anchor, it is 3.5 m."""

SMALLEST_ACCURACY = 0.01
"""Smallest standard deviation of a fix that is believed, meters."""

OUTLIER = 3.0
"""Number of standard deviations above which a fix is an outlier."""

CELL = 10.0
"""Edge of a cell, meters. The fixes of a cell count as one, as successive errors are alike."""

GRID = 180
"""Number of yaws that are tried."""

STEPS = 30
"""Largest number of reweighted least squares."""


class FitError(ValueError):
    """The fixes do not determine an anchor; the message says why and what to do."""


@dataclass(frozen=True, slots=True, eq=False)
class GnssFixes:
    """GNSS fixes of robots in a map, n of them.

    Attributes:
        positions: positions of the antenna in the map's frame, float64 (n, 3), meters.
        places: latitude, longitude (degrees) and height (meters), float64 (n, 3); the height is NaN
            where it is not known.
        accuracies: standard deviation of each fix along an axis, float64 (n,), meters.
    """

    positions: Float64
    places: Float64
    accuracies: Float64

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True, slots=True, eq=False)
class AnchorFit:
    """Fitted anchor.

    Attributes:
        anchor: the anchor.
        yaw_deviation_deg: standard deviation of its yaw, degrees.
        residuals: horizontal distance of each fix from its place by the anchor, float64 (n,),
            meters.
        is_inlier: whether each fix agrees with the anchor, bool (n,).
    """

    anchor: GeoAnchor
    yaw_deviation_deg: float
    residuals: Float64
    is_inlier: Bool


def fit_anchor(fixes: GnssFixes) -> AnchorFit:
    """Fit an anchor to fixes.

    Raises:
        FitError: there are too few fixes, they do not determine the yaw, or most of them contradict
            each other.
    """
    if len(fixes) < FEWEST:
        raise FitError(f"{len(fixes)} fixes; expected {FEWEST} or more at different places.")
    sigmas = np.maximum(fixes.accuracies, SMALLEST_ACCURACY)
    heights = np.where(np.isfinite(fixes.places[:, 2]), fixes.places[:, 2], 0.0)
    here = fixes.positions[:, :2]
    worth = _worth_of(here)
    # In space, where longitudes do not jump from 180 to -180 degrees.
    origin = geodetic_of(
        np.median(ecef_of(fixes.places[:, 0], fixes.places[:, 1], heights), axis=0)
    )[:2]
    there = _east_north(fixes.places[:, :2], heights, origin)
    yaw, offset = _best_of_grid(here, there, sigmas)
    yaw, offset, weights = _refined(here, there, sigmas, worth, yaw, offset)
    # Again around the fitted point: elsewhere, north has another direction.
    middle = np.average(here, axis=0, weights=weights * worth / sigmas**2)
    origin = _place_of(_turned(middle, yaw) + offset, origin, float(np.median(heights)))
    there = _east_north(fixes.places[:, :2], heights, origin)
    yaw, offset, _ = _refined(here, there, sigmas, worth, yaw, _turned(-middle, yaw))
    residuals = np.linalg.norm(_turned(here, yaw) + offset - there, axis=1)
    inliers = residuals <= OUTLIER * sigmas
    if 2 * np.count_nonzero(inliers) < len(fixes):
        raise FitError(
            f"Only {np.count_nonzero(inliers)} of {len(fixes)} fixes agree with one place of the "
            "map. Check that the positions are in this map's frame, that latitude and longitude "
            "are not swapped, and that the accuracies are standard deviations in meters."
        )
    deviation, accuracy = _deviations(here, sigmas, worth, residuals, inliers)
    if deviation > LARGEST_DEVIATION_DEG:
        extent = float(np.ptp(here[inliers], axis=0).max())
        raise FitError(
            f"The fixes do not determine the yaw: its standard deviation would be {deviation:.1f} "
            f"degrees; expected at most {LARGEST_DEVIATION_DEG:g}. They span {extent:.0f} m with "
            f"an accuracy of {np.median(sigmas):.1f} m. Add fixes that are farther apart."
        )
    middle_z = float(np.average(fixes.positions[inliers, 2]))
    place = _place_of(_turned(middle, yaw) + offset, origin, 0.0)
    anchor = GeoAnchor(
        lat=float(place[0]),
        lon=float(place[1]),
        height=_height(fixes, inliers, middle_z),
        yaw_deg=float(np.degrees(yaw)),
        accuracy=accuracy,
        position=(float(middle[0]), float(middle[1]), middle_z),
    )
    return AnchorFit(anchor, deviation, residuals, inliers)


def _worth_of(here: Float64) -> Float64:
    """Return the weight of each fix: those of one cell weigh as much as one, float64 (n,)."""
    cells = np.floor(here / CELL).astype(np.int64)
    _, inverse, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    numbers: Int64 = inverse.reshape(-1)
    return np.asarray(1.0 / counts[numbers])


def _turned(points: Float64, yaw: float) -> Float64:
    """Return points (n, 2) or a point (2,), turned by a yaw."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.asarray(points @ np.array([[cos, sin], [-sin, cos]]))


def _east_north(places: Float64, heights: Float64, origin: Float64) -> Float64:
    """Return places (latitude, longitude) as east and north of an origin, meters, (n, 2)."""
    height = float(np.median(heights))
    away = ecef_of(places[:, 0], places[:, 1], heights) - ecef_of(origin[0], origin[1], height)
    return np.asarray(away @ enu_axes(float(origin[0]), float(origin[1]))[:2].T)


def _place_of(east_north: Float64, origin: Float64, height: float) -> Float64:
    """Return latitude and longitude of a point east and north of an origin, float64 (2,)."""
    axes = enu_axes(float(origin[0]), float(origin[1]))
    return geodetic_of(ecef_of(origin[0], origin[1], height) + east_north @ axes[:2])[:2]


def _best_of_grid(here: Float64, there: Float64, sigmas: Float64) -> tuple[float, Float64]:
    """Return the best of some yaws and its offset, by medians."""
    best, cost = (0.0, np.zeros(2)), np.inf
    for yaw in np.linspace(-np.pi, np.pi, GRID, endpoint=False).tolist():
        away = there - _turned(here, yaw)
        offset = np.median(away, axis=0)
        found = float(np.median(np.linalg.norm(away - offset, axis=1) / sigmas))
        if found < cost:
            best, cost = (yaw, offset), found
    return best


def _refined(
    here: Float64, there: Float64, sigmas: Float64, worth: Float64, yaw: float, offset: Float64
) -> tuple[float, Float64, Float64]:
    """Refine yaw and offset; return them with the weight of each fix for its residual."""
    away = np.linalg.norm(_turned(here, yaw) + offset - there, axis=1) / sigmas
    scale = max(OUTLIER, 2 * float(np.median(away)))
    weights = np.ones(len(here))
    for _ in range(STEPS):
        weights = (scale**2 / (scale**2 + away**2)) ** 2
        total = weights * worth / sigmas**2
        one, other = (np.average(each, axis=0, weights=total) for each in (here, there))
        a, b = here - one, there - other
        before = yaw
        yaw = float(
            np.arctan2(total @ (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), total @ (a * b).sum(axis=1))
        )
        offset = other - _turned(one, yaw)
        away = np.linalg.norm(_turned(here, yaw) + offset - there, axis=1) / sigmas
        if scale <= OUTLIER and abs(yaw - before) < 1e-12:
            break
        scale = max(OUTLIER, scale / 1.4)
    return yaw, offset, weights


def _deviations(
    here: Float64, sigmas: Float64, worth: Float64, residuals: Float64, inliers: Bool
) -> tuple[float, float]:
    """Return the standard deviations of the yaw, degrees, and of the anchor's position, meters."""
    information = (worth / sigmas**2)[inliers]
    middle = np.average(here[inliers], axis=0, weights=information)
    spread = float(information @ ((here[inliers] - middle) ** 2).sum(axis=1))
    # Residuals larger than the accuracies say that these are too optimistic.
    chi = float(information @ residuals[inliers] ** 2) / max(float(worth[inliers].sum()) * 2, 1e-9)
    excess = max(1.0, np.sqrt(chi))
    deviation = np.degrees(excess / np.sqrt(spread)) if spread > 0 else np.inf
    return float(deviation), float(excess / np.sqrt(information.sum()))


def _height(fixes: GnssFixes, inliers: Bool, middle_z: float) -> float:
    """Return the height of the anchor; 0 if no fix has one."""
    known = inliers & np.isfinite(fixes.places[:, 2])
    if not known.any():
        return 0.0
    return float(np.median(fixes.places[known, 2] - fixes.positions[known, 2])) + middle_z
