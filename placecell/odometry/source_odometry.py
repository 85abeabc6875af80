"""Odometry of a source: run, level, estimate the drift, and remember the result."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata

import numpy as np

from placecell.core.progress import Progress
from placecell.core.types import Float64
from placecell.odometry import cache
from placecell.odometry.cache import CachedOdometry
from placecell.odometry.drift import estimate_drift
from placecell.odometry.ground_plane import GroundPlane
from placecell.odometry.leveling import first_scans, ground_in_world, leveling_of
from placecell.odometry.scan_odometry import INSTALL, OdometrySettings, run
from placecell.sources.errors import DriveError
from placecell.sources.source import ScanSource

VERSION = 1
"""Version of the odometry; part of the cache's key."""
LARGE_DRIFT = 3.0
"""Drift from which the user is warned, percent of the path."""


@dataclass(frozen=True, slots=True)
class SourceOdometry:
    """Trajectory of a source, from its scans alone.

    Attributes:
        poses: sensor to world, float64 (scans, 4, 4); z of the world is up.
        ground: ground in the frame of the first scan; None if none was found.
        drift_percent: estimated drift, percent of the path; None if the sensor hardly moves.
    """

    poses: Float64
    ground: GroundPlane | None
    drift_percent: float | None


def odometry_of(
    source: ScanSource,
    use_times: bool,
    progress: Progress,
    tell: Callable[[str], None],
) -> SourceOdometry:
    """Compute the trajectory of a source by KISS-ICP, or read it from the cache.

    Args:
        source: the source.
        use_times: deskew scans whose points have times.
        progress: shows the progress.
        tell: receives a line about what was found.

    Raises:
        DriveError: KISS-ICP is not installed, or no scan can be read.
    """
    try:
        version = metadata.version("kiss-icp")
    except metadata.PackageNotFoundError as error:
        raise DriveError(f"{source.path}: has no poses. {INSTALL}") from error
    settings = OdometrySettings.of(source, use_times)
    hashes = [source.scan_hash(index) for index in range(len(source))]
    file = cache.cache_file(
        source.title, [VERSION, version, settings, source.stamps.tobytes().hex(), *hashes]
    )
    found = cache.load(file, len(source))
    if found is None:
        computed = compute(source, settings, progress)
        kept = cache.save(file, computed)
        found = (cache.load(file, len(source)) if kept else None) or computed
        where = f"kept in {file}" if kept else f"not kept: {file.parent} cannot be written"
    else:
        where = f"read from {file}"
    tell(f"{source.path}: odometry by kiss-icp {version}, {where}")
    tell(f"{source.path}: {describe_drift(found.drift_percent)}")
    until = first_scans(source.stamps)
    ground = ground_in_world(source, range(until), found.poses[:until])
    if ground is None:
        tell(
            f"{source.path}: no ground was found below the sensor, so the world is not leveled; "
            "its z is the sensor's z at the first scan"
        )
        return SourceOdometry(found.poses, None, found.drift_percent)
    tell(
        f"{source.path}: leveled by the ground: the sensor is {ground.height:.2f} m above it and "
        f"tilted by {ground.tilt_deg:.1f} degrees at the first scan"
    )
    return SourceOdometry(leveling_of(ground) @ found.poses, ground, found.drift_percent)


def compute(source: ScanSource, settings: OdometrySettings, progress: Progress) -> CachedOdometry:
    """Run the odometry over all scans, and over parts of them backward.

    Raises:
        DriveError: the odometry lost its way.
    """
    everything = range(len(source))
    poses = run(source, everything, settings, progress, f"odometry of {source.title}")
    if not np.isfinite(poses).all():
        raise DriveError(
            f"{source.path}: odometry found no motion that fits the scans. Give poses with --poses "
            "FILE"
        )

    def backward(part: Sequence[int]) -> Float64:
        return run(source, part, settings, progress, f"drift of {source.title}")

    return CachedOdometry(poses, estimate_drift(poses, backward))


def describe_drift(percent: float | None) -> str:
    """Return the drift as text."""
    if percent is None:
        return "the sensor hardly moves, so the drift of the odometry is not estimated"
    told = (
        f"the drift of the odometry is about {percent:.2f}% of the path (forward against backward)"
    )
    if percent > LARGE_DRIFT:
        return f"{told}: it is not reliable here, and maps will be blurred. Give poses with --poses"
    return told
