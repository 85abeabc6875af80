"""Facts on some scans of a source, evenly spread; a source may be larger than the memory."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.inspection.subject import Subject
from placecell.sources.errors import DriveError

RANGES = (0.0, 1.0, 3.0, 10.0, 20.0, 40.0, 60.0, 100.0, 200.0)
"""Edges of the histogram of ranges, meters; the last bin is open."""
KEPT_POINTS = 4_000_000
"""Most points of all samples that are kept in memory."""


@dataclass(frozen=True, slots=True, eq=False)
class ScanSample:
    """Facts on one scan.

    Attributes:
        index: number of the scan.
        read: number of points in the file.
        not_finite: points with NaN or infinity.
        zeros: points at (0, 0, 0).
        count: number of usable points.
        median_range: median distance of the points from the sensor, meters; NaN without points.
        center: median of the points, float64 (3,), meters.
        histogram: number of points in each bin of `RANGES`.
        view_deg: angle around the sensor that points lie in, degrees.
        sweep: time from the first to the last point, seconds; None without times.
        stamp: time of the scan, seconds.
        digest: hash of the points.
        points: the points, float32 (n, 3); none if the samples are too large to be kept.
    """

    index: int
    read: int
    not_finite: int
    zeros: int
    count: int
    median_range: float
    center: Float64
    histogram: Sequence[int]
    view_deg: float
    sweep: float | None
    stamp: float
    digest: int
    points: Float32


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Facts on some scans.

    Attributes:
        scans: facts on each scan that could be read.
        failures: error of each scan that could not.
    """

    scans: Sequence[ScanSample]
    failures: Sequence[str]

    @property
    def clouds(self) -> list[Float32]:
        """Points of the scans that were kept and have any."""
        return [scan.points for scan in self.scans if len(scan.points)]


def chosen_scans(scans: int, most: int) -> list[int]:
    """Return the numbers of scans to look at: evenly spread, with the second scan.

    Two neighbors show a source that repeats its scans.
    """
    spread = np.linspace(0, scans - 1, min(most, scans)).round().astype(int).tolist()
    return sorted({*spread, *range(min(2, scans))})


Progress = Callable[[Iterable[int], int, str], Iterable[int]]


def sample(subject: Subject, most: int, progress: Progress) -> Samples:
    """Read some scans of a source.

    Args:
        subject: the source.
        most: number of scans to read.
        progress: function that shows the progress.
    """
    found: list[ScanSample] = []
    failures: list[str] = []
    left = KEPT_POINTS
    indices = chosen_scans(len(subject.stamps), most)
    for index in progress(indices, len(indices), "scans"):
        try:
            scan = subject.read(index)
        except DriveError as error:
            failures.append(str(error))
            continue
        points = scan.points
        ranges = np.linalg.norm(points.astype(np.float64), axis=1)
        keep = len(points) <= left
        left -= len(points) if keep else 0
        times = scan.times
        found.append(
            ScanSample(
                index=index,
                read=scan.read,
                not_finite=scan.not_finite,
                zeros=scan.zeros,
                count=len(points),
                median_range=float(np.median(ranges)) if len(points) else np.nan,
                center=np.median(points, axis=0) if len(points) else np.zeros(3),
                histogram=np.histogram(ranges, (*RANGES, np.inf))[0].tolist(),
                view_deg=view(points),
                sweep=float(times.max() - times.min())
                if times is not None and len(times)
                else None,
                stamp=scan.stamp,
                digest=hash(points.tobytes()),
                points=points if keep else points[:0],
            )
        )
    return Samples(found, failures)


def view(points: Float32) -> float:
    """Return the angle around the sensor's z axis that points lie in, degrees, in steps of 5."""
    if not len(points):
        return 0.0
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    bins = np.floor(azimuth / 5).astype(int) % 72
    # A few stray points do not widen the view.
    used = np.bincount(bins, minlength=72) > max(1, len(points) // 7200)
    return float(5 * np.count_nonzero(used))
