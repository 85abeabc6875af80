"""Problems of scans: their points, units, frame and view."""

import re
from collections.abc import Iterator, Sequence

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.inspection.ground import USUAL_HEIGHTS, SensorMount
from placecell.inspection.problem import SourceProblem
from placecell.inspection.samples import Samples
from placecell.inspection.subject import CLOUDS, Subject
from placecell.sources.point_times import is_time

FARTHEST_MEDIAN = 250.0
"""Largest plausible median range, meters; a LiDAR scan's is some 10 m."""
USUAL_MEDIANS = (1.0, 80.0)
"""Median ranges of usual scans, meters."""
MOST_POINTS = 1_000_000
"""Points from which a cloud is a map rather than a sweep: the largest sensors give half of it."""
OFF_CENTER = 0.8
"""Share of the median range that the points' center may be away from the sensor."""
MANY_LOST = 0.6
"""Share of lost points from which something is wrong; half of the beams of a street hit the sky."""
FEW_POINTS = 1_000
NARROW_DEG = 120.0
LEVEL_DEG = 5.0
"""Ground removal needs z up within this angle, degrees."""

KNOWN_FIELDS = re.compile(
    r"_|[xyz]|n[xyz]|normal_[xyz]|curvature|rgba?|red|green|blue|i|intensit\w+|reflect\w+|remission"
    r"|ring|line|laser\w*|channel|row|col|column|tag|label|class\w*|\w*return\w*|noise|near_ir"
    r"|ambient|signal|range|distance|azimuth|elevation|confidence|velocity|scan_angle\w*|user_data"
    r"|point_source_id|synthetic|key_point|withheld|overlap|edge_of_flight_line|scan_direction_flag"
    r"|scanner_channel|column_\d+|scalar_\w+",
    re.IGNORECASE,
)
"""Names of fields whose meaning is known, besides times."""


def unreadable_scans(samples: Samples) -> Iterator[SourceProblem]:
    """Find scans that cannot be read, such as those of a truncated file."""
    failed, looked_at = len(samples.failures), len(samples.failures) + len(samples.scans)
    if failed:
        error = SourceProblem.of("warning", samples.failures[0])
        severity = "error" if 2 * failed > looked_at else "warning"
        what = f"{failed} of {looked_at} scans cannot be read. The first: {error.what}"
        yield SourceProblem(severity, what, error.cure)  # type: ignore[arg-type]


def empty_scans(samples: Samples) -> Iterator[SourceProblem]:
    """Find scans without usable points."""
    empty = [scan for scan in samples.scans if not scan.count]
    if not empty:
        return
    lost = sum(scan.read for scan in empty)
    yield SourceProblem(
        "error" if len(empty) == len(samples.scans) else "warning",
        f"{len(empty)} of {len(samples.scans)} scans have no usable point"
        + (f": all {lost:,} points are NaN, infinite or (0, 0, 0)" if lost else ""),
        "Check the sensor's driver and, in a bag, the topic (--topic). Empty scans are skipped.",
    )


def lost_points(samples: Samples) -> Iterator[SourceProblem]:
    """Find NaN points and points at (0, 0, 0)."""
    read = sum(scan.read for scan in samples.scans)
    for lost, kind in (
        (sum(scan.not_finite for scan in samples.scans), "NaN or infinite"),
        (sum(scan.zeros for scan in samples.scans), "(0, 0, 0)"),
    ):
        if not lost:
            continue
        share = lost / read
        cure = "They are dropped together with their times. No action is needed."
        if share > MANY_LOST:
            cure = (
                "They are dropped. So many are lost if the sensor is covered or looks at the sky, "
                "or if the driver's range limits are too narrow."
            )
        yield SourceProblem(
            "warning" if share > MANY_LOST else "info",
            f"{share:.1%} of the points are {kind}: beams without an echo",
            cure,
        )


def wrong_unit(samples: Samples, mount: SensorMount) -> Iterator[SourceProblem]:
    """Find coordinates in millimeters or centimeters."""
    median, off = ranges_of(samples)
    if np.isnan(median) or off:  # A map's frame is told instead.
        return
    if median > FARTHEST_MEDIAN or (mount.unit and median > USUAL_MEDIANS[1]):
        unit = mount.unit or ("mm" if median / 1000 > USUAL_MEDIANS[0] else "cm")
        yield SourceProblem(
            "error",
            f"The median range is {median:,.0f}, beyond any LiDAR in meters",
            f"State the unit with --unit {unit}.",
        )
    elif mount.unit and mount.ground is None:
        yield SourceProblem(
            "warning",
            f"A ground is seen below the sensor only if the coordinates are {mount.unit}",
            f"State the unit with --unit {mount.unit}, if it is so.",
        )
    elif median < 0.1:
        yield SourceProblem(
            "error",
            f"The median range is {median:.3g} m: the coordinates are not in meters",
            "Convert the points to meters.",
        )


def map_cloud(samples: Samples, notes: Sequence[str]) -> Iterator[SourceProblem]:
    """Find clouds that are maps, not scans of a sensor."""
    largest = max((scan.read for scan in samples.scans), default=0)
    median, off = ranges_of(samples)
    cure = (
        "Give the sensor's own scans, in the sensor's frame. A map cloud has no sensor position, "
        "so no captures can be made of it."
    )
    if off:
        center = np.median([scan.center for scan in samples.scans if scan.count], axis=0)
        where = ", ".join(f"{value:,.0f}" for value in center)
        yield SourceProblem(
            "error",
            f"The points lie around ({where}) m, {median:,.0f} m from the sensor (median): they "
            "are in the frame of a map",
            cure,
        )
    elif any("far from 0" in note for note in notes):
        yield SourceProblem(
            "error", "The coordinates are georeferenced: they are those of a map, not a scan", cure
        )
    elif largest > MOST_POINTS:
        yield SourceProblem(
            "warning",
            f"A scan has {largest:,} points, more than a sensor gives in a sweep: it may be a map",
            cure,
        )


def ranges_of(samples: Samples) -> tuple[float, bool]:
    """Return the median range, and whether the points lie away from the sensor."""
    some = [scan for scan in samples.scans if scan.count]
    if not some:
        return float("nan"), False
    median = float(np.median([scan.median_range for scan in some]))
    away = float(np.median([np.linalg.norm(scan.center) for scan in some]))
    return median, median > FARTHEST_MEDIAN and away > OFF_CENTER * median


def few_points(samples: Samples) -> Iterator[SourceProblem]:
    """Find scans with too few points for segments."""
    counts = [sum(scan.histogram[2:6]) for scan in samples.scans if scan.count]
    if not counts:
        return
    mean = float(np.mean(counts))
    least = PROTOCOL_V1.min_points
    where = f"between {PROTOCOL_V1.min_range:g} and {PROTOCOL_V1.max_range:g} m"
    if mean < least:
        yield SourceProblem(
            "error",
            f"Scans have {mean:,.0f} points {where}, fewer than the {least} of one segment",
            "Check the unit (--unit), the topic (--topic), and the driver's range limits.",
        )
    elif mean < FEW_POINTS:
        yield SourceProblem(
            "warning",
            f"Scans have only {mean:,.0f} points {where}, so few segments will be found",
            "Use the sensor's full resolution, without a filter that thins the points.",
        )


def narrow_view(samples: Samples) -> Iterator[SourceProblem]:
    """Find sensors that see a part of the circle only."""
    views = [scan.view_deg for scan in samples.scans if scan.count]
    if views and np.median(views) < NARROW_DEG:
        yield SourceProblem(
            "info",
            f"The points lie within {np.median(views):.0f} degrees around the sensor: a narrow "
            "view. A place is recognized only from similar headings",
            "Use a sensor that sees all around, or drive each way in both directions.",
        )


def wrong_up(mount: SensorMount) -> Iterator[SourceProblem]:
    """Find frames whose z axis does not point up, such as a camera's."""
    if mount.up_axis not in ("", "z"):
        kind = " as in a camera's frame" if mount.up_axis == "-y" else ""
        yield SourceProblem(
            "warning",
            f"The axis {mount.up_axis} of the scans' frame points up{kind}, not z",
            "State the sensor's pose in a frame with z up with --extrinsic, or record the points "
            "in the sensor's frame (x ahead, y left, z up).",
        )


def tilted(mount: SensorMount, subject: Subject) -> Iterator[SourceProblem]:
    """Find sensors that are mounted at an angle."""
    if mount.ground is None or mount.up_axis != "z" or mount.ground.tilt_deg <= LEVEL_DEG:
        return
    told = f"The sensor is tilted by {mount.ground.tilt_deg:.1f} degrees against the ground"
    if subject.trajectory is not None:
        yield SourceProblem("info", told, "No action is needed if the poses contain the tilt.")
    else:
        yield SourceProblem(
            "warning", told, "State the mount with --extrinsic, or use poses of the sensor."
        )


def odd_height(mount: SensorMount, samples: Samples) -> Iterator[SourceProblem]:
    """Find odd heights of the sensor above the ground, and scans without a ground."""
    if not any(scan.count for scan in samples.scans) or mount.unit:
        return
    if mount.ground is None:
        yield SourceProblem(
            "warning",
            mount.reason,
            "Check that the sensor sees the ground, that z points up, and the unit (--unit).",
        )
    elif not USUAL_HEIGHTS[0] <= mount.ground.height <= USUAL_HEIGHTS[1]:
        yield SourceProblem(
            "warning",
            f"The sensor is {mount.ground.height:.2f} m above the ground; expected "
            f"{USUAL_HEIGHTS[0]} to {USUAL_HEIGHTS[1]} m",
            "Check the unit (--unit), and that z points up.",
        )


def no_point_times(samples: Samples, subject: Subject) -> Iterator[SourceProblem]:
    """Find scans without times of points, or with times that are no sweep."""
    if not samples.scans:
        return
    sweeps = [scan.sweep for scan in samples.scans if scan.sweep is not None]
    if sweeps:
        sweep = float(np.median(sweeps))
        steps = np.diff(subject.stamps[np.isfinite(subject.stamps)])
        period = float(np.median(steps[steps > 0])) if (steps > 0).any() else None
        if period and not 0.2 * period <= sweep <= 1.5 * period:
            yield SourceProblem(
                "warning",
                f"The points' times span {sweep:.3g} s, but scans are {period:.3g} s apart",
                "Check the driver's unit of the points' times. Use --no-deskew if they are wrong.",
            )
        return
    yield SourceProblem(
        "info",
        "The points have no times, so scans cannot be deskewed; motion blurs fast drives",
        "Record the driver's own cloud with a field t, time or timestamp, or give deskewed scans.",
    )


def unknown_fields(fields: Sequence[str]) -> Iterator[SourceProblem]:
    """Find fields that are not known."""
    odd = [name for name in fields if not KNOWN_FIELDS.fullmatch(name) and not is_time(name)]
    if odd and len(odd) < len(fields):
        yield SourceProblem(
            "info",
            f"The fields {', '.join(odd[:12])} are not known and not used",
            "Name the field t, time or timestamp if it holds the points' times.",
        )


def repeated_scans(samples: Samples) -> Iterator[SourceProblem]:
    """Find scans with exactly the points of another."""
    digests = [scan.digest for scan in samples.scans if scan.count]
    repeated = len(digests) - len(set(digests))
    if repeated:
        yield SourceProblem(
            "warning",
            f"{repeated} of {len(digests)} scans repeat the points of another scan",
            "Remove the copies. The recording node may have stored the last message again.",
        )


def cloud_topics(subject: Subject) -> Iterator[SourceProblem]:
    """Tell which of several topics with clouds is used."""
    topics = [
        topic["name"]
        for topic in subject.topics
        if topic["messages"] and topic["type"].rpartition("/")[2].rpartition(".")[2] in CLOUDS
    ]
    if len(topics) > 1 and subject.chosen:
        others = ", ".join(name for name in topics if name != subject.chosen)
        yield SourceProblem(
            "info",
            f"{len(topics)} topics have clouds. Clouds are read from {subject.chosen}",
            f"State another one with --topic: {others}.",
        )
