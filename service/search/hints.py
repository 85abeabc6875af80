"""Hints: where a request says that its robot is. They narrow the answer and never decide it.

The maps of the request are searched as without hints. If a narrowed map has no hypothesis within
the hints, the segments around them are searched too, and the poses that these suggest are tried.
All hypotheses then compete under the same thresholds, those outside the hints as well. So a wrong
hint cannot hide the right place. At last a pose that contradicts a hint is withheld.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from placecell_client.hints import GeoHint, Hints, LastPoseHint, SensorPose, UnusedHint
from scipy.spatial.transform import Rotation

from placecell.core.geodesy import GeoAnchor, to_map
from placecell.core.segment_classes import ClassFilter
from placecell.core.spatial import evenly
from placecell.core.types import Float64, Int8, Int64
from placecell.localization import Candidates, Localization, LocalizationParameters, Pose
from placecell.localization.guided_matching import MapSegments
from placecell.localization.localize import find_places
from service.core.auth import Principal
from service.core.problems import invalid_value
from service.inference.model_registry import Model
from service.maps.snapshot import MapSnapshot

DEVIATIONS = 3.0
"""Number of standard deviations of a hint that are searched."""

SEGMENTS = 128
"""Largest number of a request's segments that are searched around a hint, evenly chosen."""

ROWS = 20_000
"""Largest number of segments around a hint that are searched a second time."""

NEAREST = 25
"""Candidates of a segment in the search around a hint."""

FARTHEST_SENSOR = 100.0
"""Distance in meters of the nearest code's centroid from the frame's origin, above which the origin
cannot be the sensor."""

NAMES = ("near", "yaw", "last_pose", "geo", "maps", "tags")
"""Names of the hints."""

AnchorOf = Callable[[MapSnapshot], GeoAnchor | None]


@dataclass(frozen=True, slots=True, eq=False)
class Disc:
    """Circle on the map, or ball, that the sensor is in.

    Attributes:
        center: float64 (2,) or (3,), meters, in the map's frame.
        radius: meters.
    """

    center: Float64
    radius: float

    def holds(self, position: Float64) -> bool:
        """Return whether a position (3,) is inside."""
        away = position[: len(self.center)] - self.center
        return bool(np.linalg.norm(away) <= self.radius)


@dataclass(frozen=True, slots=True)
class HeadingRange:
    """Range of the sensor's heading in the map's frame, radians."""

    yaw: float
    tolerance: float

    def holds(self, yaw: float) -> bool:
        """Return whether a heading is inside."""
        return abs((yaw - self.yaw + np.pi) % (2 * np.pi) - np.pi) <= self.tolerance


@dataclass(frozen=True, slots=True, eq=False)
class HintedArea:
    """Poses of the sensor in one map that no hint contradicts.

    Attributes:
        discs: the sensor is in all of them.
        headings: its heading is in all of them.
    """

    discs: tuple[Disc, ...]
    headings: tuple[HeadingRange, ...]

    def holds(self, pose: Pose, sensor: SensorPose) -> bool:
        """Return whether the hints allow a pose of the request's frame."""
        position = pose.apply(np.asarray(sensor.position, np.float64))
        return all(each.holds(position) for each in self.discs) and all(
            each.holds(pose.yaw + sensor.yaw) for each in self.headings
        )


@dataclass(frozen=True, slots=True, eq=False)
class ResolvedHints:
    """Hints of a request, in the frames of the searched maps.

    Attributes:
        areas: poses that the hints allow, by uid of the map; maps that are excluded are left out.
        sensor: pose of the sensor in the request's frame.
        used: names of the hints that narrow something.
        unused: hints that cannot narrow a map.
        is_sensor_given: whether the request states the pose of the sensor.
    """

    areas: dict[str, HintedArea]
    sensor: SensorPose
    used: tuple[str, ...]
    unused: tuple[UnusedHint, ...]
    is_sensor_given: bool = False

    def allow(self, snapshot: MapSnapshot, pose: Pose) -> bool:
        """Return whether a pose in a map contradicts no hint."""
        area = self.areas.get(snapshot.head.uid)
        return area is not None and area.holds(pose, self.sensor)

    def narrowed(self, snapshot: MapSnapshot, found: Localization) -> Localization:
        """Return a map's localization without a pose that the hints exclude."""
        if found.reason in {"ambiguous", "too-few-segments"}:
            return found
        best, area = found.best, self.areas.get(snapshot.head.uid)
        is_allowed = area is not None
        if area is not None and not area.discs and not area.headings:
            return found  # No hint narrows this map.
        if best is None:
            if not is_allowed:
                return found
            detail = f"Nothing fits within the hints. {found.detail}"
        elif self.allow(snapshot, best.pose):
            return found
        elif not is_allowed:
            detail = f"The hints exclude map {snapshot.name!r:.80}."
        else:
            x, y, _ = best.pose.apply(np.asarray(self.sensor.position, np.float64)).tolist()
            detail = (
                "Nothing fits within the hints. The best pose is outside them, at "
                f"({x:.1f}, {y:.1f}), with the probability {found.probability:.3f}."
            )
        return replace(found, reason="outside-hints", detail=detail)


def sensor_of_codes(centroids: Float64) -> SensorPose:
    """Return the origin of the request's frame as the sensor of codes with these centroids (n, 3).

    Raises:
        Problem: 422 if all centroids are far from the origin, so that the sensor is elsewhere.
    """
    away = np.linalg.norm(centroids, axis=1)
    nearest = float(np.min(away, initial=np.inf, where=np.isfinite(away)))
    if np.isfinite(nearest) and nearest > FARTHEST_SENSOR:
        raise invalid_value(
            "/hints/sensor",
            f"The nearest centroid is {nearest:.0f} m from the origin of the request's frame, so "
            "the sensor is not there. Give the sensor's pose in the frame of the centroids.",
        )
    return SensorPose((0.0, 0.0, 0.0))


def resolve(
    hints: Hints,
    searched: Sequence[MapSnapshot],
    sensor: SensorPose,
    known: Callable[[str], bool],
    tags_of: Callable[[MapSnapshot], Iterable[str]],
    anchor_of: AnchorOf,
    principal: Principal,
) -> ResolvedHints:
    """Put the hints into the frames of the maps that a request searches.

    Args:
        hints: the hints.
        searched: the maps.
        sensor: pose of the sensor in the request's frame, if the hints have none.
        known: returns whether a map of a name is stored.
        tags_of: returns the tags of a map.
        anchor_of: returns the WGS 84 anchor of a map; None if it has none.
        principal: principal, whose scope may not cover a named map.

    Raises:
        Problem: 422 if a hint names a map that is not stored or not searched, 403 if a named map is
            outside the scope of the key.
    """
    names = {each.name for each in searched}
    named = [
        (f"/hints/{hint}/map", place.map)
        for hint, place in (("near", hints.near), ("last_pose", hints.last_pose))
        if place is not None and place.map is not None
    ] + [(f"/hints/maps/{index}", name) for index, name in enumerate(hints.maps or ())]
    for pointer, name in named:
        principal.check_map(name)
        if not known(name):
            raise invalid_value(pointer, f"No map is named {name!r:.80}. GET /maps lists the maps.")
        if name not in names:
            raise invalid_value(
                pointer, f"Map {name!r:.80} is not searched by this request. Add it to 'maps'."
            )
    areas: dict[str, HintedArea] = {}
    used: set[str] = set()
    unused: list[UnusedHint] = []
    for snapshot in searched:
        if not _includes(hints, snapshot, tags_of):
            continue
        anchor = None if hints.geo is None else anchor_of(snapshot)
        if hints.geo is not None and anchor is None:
            reason = "The map has no WGS 84 anchor. Set one: PUT /maps/{map}/anchor."
            unused.append(UnusedHint("geo", snapshot.name, reason))
        areas[snapshot.head.uid] = _area_of(hints, anchor)
        used |= {"near", "yaw", "last_pose"} | ({"geo"} if anchor is not None else set())
    given = {name for name in NAMES if getattr(hints, name) is not None}
    used = given & (used | {"maps", "tags"})
    return ResolvedHints(
        areas,
        hints.sensor or sensor,
        tuple(sorted(used)),
        tuple(unused),
        hints.sensor is not None,
    )


def _includes(
    hints: Hints, snapshot: MapSnapshot, tags_of: Callable[[MapSnapshot], Iterable[str]]
) -> bool:
    """Return whether the robot may be in a map, by the map's name and tags."""
    if hints.maps is not None and snapshot.name not in hints.maps:
        return False
    if hints.tags is not None and not {*hints.tags} <= {*tags_of(snapshot)}:
        return False
    named = (place.map for place in (hints.near, hints.last_pose) if place is not None)
    return all(name in (None, snapshot.name) for name in named)


def _area_of(hints: Hints, anchor: GeoAnchor | None) -> HintedArea:
    """Return the poses in a map that the hints allow."""
    discs: list[Disc] = []
    headings: list[HeadingRange] = []
    if hints.near is not None:
        discs.append(Disc(np.asarray(hints.near.position, np.float64), float(hints.near.radius)))
    if hints.yaw is not None:
        headings.append(HeadingRange(hints.yaw.radians, hints.yaw.tolerance))
    if hints.last_pose is not None:
        discs.append(_disc_of_last(hints.last_pose))
        headings += _headings_of_last(hints.last_pose)
    if hints.geo is not None and anchor is not None:
        discs.append(_disc_of_geo(hints.geo, anchor))
    return HintedArea(tuple(discs), tuple(headings))


def _disc_of_last(last: LastPoseHint) -> Disc:
    center = np.asarray(last.position, np.float64)
    if last.radius is not None:
        return Disc(center, float(last.radius))
    covariance = np.asarray(last.covariance, np.float64)[:3, :3]
    # The largest standard deviation in any direction.
    variance = float(np.linalg.eigvalsh((covariance + covariance.T) / 2)[-1])
    return Disc(center, DEVIATIONS * np.sqrt(max(variance, 0.0)))


def _headings_of_last(last: LastPoseHint) -> list[HeadingRange]:
    """Return the range of headings of a last pose; none if it does not limit the heading."""
    if last.orientation is None:
        return []
    tolerance = last.yaw_tolerance
    if tolerance is None and last.covariance is not None and len(last.covariance) > 3:
        variance = float(np.asarray(last.covariance, np.float64)[-1, -1])
        tolerance = DEVIATIONS * np.sqrt(variance)
    if tolerance is None:
        return []
    forward = Rotation.from_quat(np.asarray(last.orientation, np.float64)).apply([1.0, 0.0, 0.0])
    return [HeadingRange(float(np.arctan2(forward[1], forward[0])), float(tolerance))]


def _disc_of_geo(geo: GeoHint, anchor: GeoAnchor) -> Disc:
    point = to_map(np.array([[geo.lat, geo.lon, anchor.height]]), anchor)[0]
    return Disc(point[:2], DEVIATIONS * float(np.hypot(geo.accuracy, anchor.accuracy)))


def guesses_within(
    area: HintedArea,
    sensor: SensorPose,
    codes: Int8,
    centroids: Float64,
    model: Model,
    snapshot: MapSnapshot,
    there: MapSegments,
    parameters: LocalizationParameters,
    wanted: ClassFilter | None = None,
) -> tuple[Pose, ...]:
    """Return poses within an area that the segments around it suggest.

    Only these segments are searched, so that the many similar ones of a large map do not displace
    them. The poses are guesses: the candidates of the whole map confirm or reject them.

    Args:
        area: the area.
        sensor: pose of the sensor in the request's frame.
        codes: codes of the request's segments, int8 (q, code bytes).
        centroids: their centroids, float64 (q, 3), meters, in the request's frame.
        model: model that made the codes and the map.
        snapshot: the map.
        there: its segments, compared with the codes.
        parameters: parameters of the localization.
        wanted: filter of the map's segments.
    """
    if not area.discs:
        return ()
    asked = evenly(np.flatnonzero(np.isfinite(centroids).all(axis=1)), SEGMENTS)
    if not len(asked):
        return ()
    away = np.linalg.norm(centroids[asked] - np.asarray(sensor.position, np.float64), axis=1)
    disc = min(area.discs, key=lambda disc: disc.radius)
    rows = _rows_around(disc, float(away.max()), snapshot, wanted)
    if not len(rows) or len(rows) > ROWS:
        return ()
    near = _nearest_among(rows, codes[asked], model, snapshot)
    queries = np.repeat(asked, near.shape[1])
    candidates = Candidates(
        centroids[asked],
        near,
        snapshot.layers.column("centroids", near),
        there.match_probabilities(queries, near.ravel()).reshape(near.shape),
    )
    found = find_places(candidates, parameters).hypotheses
    return tuple(each.pose for each in found if area.holds(each.pose, sensor))


def _rows_around(
    disc: Disc, reach: float, snapshot: MapSnapshot, wanted: ClassFilter | None
) -> Int64:
    """Return the rows of a map within reach of a disc, and a few others."""
    low = high = disc.center
    if len(disc.center) == 2:
        low, high = np.append(low, -np.inf), np.append(high, np.inf)
    return snapshot.layers.rows_near(np.stack([low, high]), disc.radius + reach, wanted)


def _nearest_among(rows: Int64, codes: Int8, model: Model, snapshot: MapSnapshot) -> Int64:
    """Return the nearest of some rows to each code, int64 (q, up to `NEAREST`), in any order."""
    quantizer = model.manifest.quantizer
    stored = snapshot.layers.column("codes", rows)
    one, other = (quantizer.levels(each).astype(np.float32) for each in (codes, stored))
    squared = (one**2).sum(axis=1)[:, None] + (other**2).sum(axis=1) - 2 * one @ other.T
    k = min(NEAREST, len(rows))
    return np.asarray(rows[np.argpartition(squared, k - 1, axis=1)[:, :k]])
