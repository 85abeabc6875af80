"""Odometry of a source: run, level, estimate the drift, and remember the result."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from hashlib import sha256
from importlib import metadata

import numpy as np

from placecell.core.progress import Progress
from placecell.core.types import Float64
from placecell.odometry import cache
from placecell.odometry.cache import CachedOdometry
from placecell.odometry.deskew import SensorMotion
from placecell.odometry.drift import estimate_drift
from placecell.odometry.gravity import Gravity, NotLevelError, find_gravity
from placecell.odometry.ground_plane import UP, GroundPlane
from placecell.odometry.inertial_odometry import INSTALL as INSTALL_INERTIAL
from placecell.odometry.inertial_odometry import imu_of, run_inertial
from placecell.odometry.leveling import first_scans, ground_in_world, leveling_of
from placecell.odometry.scan_odometry import INSTALL, OdometrySettings, read, run
from placecell.sources.errors import DriveError
from placecell.sources.imu import ImuSamples
from placecell.sources.scan_options import KISS_ICP, RKO_LIO
from placecell.sources.source import ScanSource

VERSION = 2
"""Version of the odometry; part of the cache's key."""
START = 20
"""Number of first scans whose poses come from a run backward."""
SAME_STEP = 0.1
"""Difference of two runs from step to step that is the noise of the registration, meters."""
PROBED = 3
"""Number of scans that tell whether points have times."""
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
    method: str = KISS_ICP,
) -> SourceOdometry:
    """Compute the trajectory of a source by odometry, or read it from the cache.

    Args:
        source: the source.
        use_times: deskew scans whose points have times.
        progress: shows the progress.
        tell: receives a line about what was found.
        method: package that computes it, `kiss-icp` or `rko-lio`.

    Raises:
        DriveError: the package is not installed, no scan can be read, or an IMU is missing.
    """
    try:
        version = metadata.version(method)
    except metadata.PackageNotFoundError as error:
        install = INSTALL if method == KISS_ICP else INSTALL_INERTIAL
        raise DriveError(f"{source.path}: has no poses. {install}") from error
    imu = imu_of(source) if method == RKO_LIO else None
    settings = OdometrySettings.of(source, use_times)
    hashes = [source.scan_hash(index) for index in range(len(source))]
    parts: list[object] = [VERSION, version, settings, source.stamps.tobytes().hex(), *hashes]
    if imu is not None:
        parts += [method, imu.topic, sha256(imu.accelerations.tobytes()).hexdigest()]
    file = cache.cache_file(source.title, parts)
    found = cache.load(file, len(source))
    if found is None:
        computed = compute(source, settings, progress, imu)
        kept = cache.save(file, computed)
        found = (cache.load(file, len(source)) if kept else None) or computed
        where = f"kept in {file}" if kept else f"not kept: {file.parent} cannot be written"
    else:
        where = f"read from {file}"
    tell(f"{source.path}: odometry by {method} {version}, {where}")
    tell(f"{source.path}: {describe_drift(found.drift_percent, method)}")
    until = first_scans(source.stamps)
    up, ground = level(source, found.poses[:until], tell)
    return SourceOdometry(leveling_of(up) @ found.poses, ground, found.drift_percent)


def level(
    source: ScanSource, poses: Float64, tell: Callable[[str], None]
) -> tuple[Float64, GroundPlane | None]:
    """Return up in the world of the first scan, and the ground there; tell how up was found.

    An IMU comes first, then the ground. Without both, up is the z axis of the first scan.

    Args:
        source: the source.
        poses: poses of its first scans, float64 (scans, 4, 4).
        tell: receives what was found.
    """
    gravity = gravity_of(source, poses, tell)
    expected = np.array(UP) if gravity is None else gravity.up
    ground = ground_in_world(source, range(len(poses)), poses, expected.tolist())
    if gravity is not None and ground is None:
        above = ground_in_world(source, range(len(poses)), poses, (-expected).tolist())
        if above is not None:
            tell(
                f"{source.path}: the IMU points up into the ground; expected accelerations that "
                "point up at rest, as REP 145 states. The ground is used instead"
            )
            gravity, ground = None, above
    height = "" if ground is None else f"{ground.height:.2f} m above the ground and "
    if gravity is not None:
        tell(
            f"{source.path}: leveled by imu: {gravity.how}; the sensor is {height}tilted by "
            f"{gravity.tilt_deg:.1f} degrees at the first scan"
        )
        return gravity.up, ground
    if ground is None:
        tell(
            f"{source.path}: no ground was found below the sensor, so the world is not leveled; "
            "its z is the sensor's z at the first scan"
        )
        return expected, None
    tell(
        f"{source.path}: leveled by the ground: the sensor is {height}tilted by "
        f"{ground.tilt_deg:.1f} degrees at the first scan"
    )
    return ground.up, ground


def gravity_of(source: ScanSource, poses: Float64, tell: Callable[[str], None]) -> Gravity | None:
    """Return up by the source's IMU; None if there is none of use, which is told."""
    stamps = source.stamps[: len(poses)]
    motion = SensorMotion.of(stamps, poses) if np.isfinite(stamps).all() else None
    if motion is None:
        return None
    imu = source.imu(float(stamps[0]), float(stamps[-1]))
    if imu is None:
        return None
    try:
        gravity = find_gravity(imu, motion)
    except NotLevelError as error:
        tell(f"{source.path}: the IMU is not used to level the world: {error}")
        return None
    return Gravity(gravity.up, f"{gravity.how}, mounted by {imu.how}")


def compute(
    source: ScanSource,
    settings: OdometrySettings,
    progress: Progress,
    imu: ImuSamples | None = None,
) -> CachedOdometry:
    """Run the odometry over all scans; that without an IMU also over parts of them backward.

    Raises:
        DriveError: the odometry lost its way.
    """
    everything = range(len(source))
    if imu is not None:  # It does not run backward, so nothing tells its drift.
        return CachedOdometry(run_inertial(source, settings, imu, progress), None)
    poses = run_twice(source, everything, settings, progress, f"odometry of {source.title}")
    if not np.isfinite(poses).all():
        raise DriveError(
            f"{source.path}: odometry found no motion that fits the scans. Give poses with --poses "
            "FILE"
        )

    def backward(part: Sequence[int]) -> Float64:
        return run_joined(source, part, settings, progress, f"drift of {source.title}")

    return CachedOdometry(poses, estimate_drift(poses, backward))


def run_twice(
    source: ScanSource,
    scans: Sequence[int],
    settings: OdometrySettings,
    progress: Progress,
    title: str,
) -> Float64:
    """Return the poses of scans by two passes, float64 (scans, 4, 4).

    The first pass expects each motion to go on as before, and deskews with a wrong motion in turns.
    The second pass has the right one. Scans without times have one pass.
    """
    poses = run_joined(source, scans, settings, progress, title)
    times = any(read(source, int(index)).times is not None for index in scans[:PROBED])
    if not (settings.deskew and times and np.isfinite(poses).all()):
        return poses
    return run_joined(source, scans, settings, progress, f"{title}, second pass", poses)


def run_joined(
    source: ScanSource,
    scans: Sequence[int],
    settings: OdometrySettings,
    progress: Progress,
    title: str,
    guide: Float64 | None = None,
) -> Float64:
    """Return the poses of scans, those of the first ones by a run backward, float64 (scans, 4, 4).

    A sensor that moves at its first scan misleads the odometry for some scans: it expects a sensor
    that stands, and the rings on the ground look alike. A run backward comes to these scans with
    the right motion. Where both runs agree, the run forward is kept.
    """
    forward = run(source, scans, settings, progress, title, guide)
    count = min(len(scans), 2 * START)
    if count < 3 or not np.isfinite(forward).all():
        return forward
    reverse = None if guide is None else guide[:count][::-1]
    told = f"{title}, start"
    backward = run(source, scans[:count][::-1], settings, progress, told, reverse)[::-1]
    if not np.isfinite(backward).all():
        return forward
    at = count // 2
    steps = [np.linalg.inv(each[:at]) @ each[1 : at + 1] for each in (forward, backward)]
    if np.linalg.norm((steps[0] - steps[1])[:, :3, 3], axis=1).max() < SAME_STEP:
        return forward
    start = forward[at] @ np.linalg.inv(backward[at]) @ backward[:at]
    poses = np.concatenate([start, forward[at:]])
    return np.asarray(np.linalg.inv(poses[0]) @ poses)


def describe_drift(percent: float | None, method: str = KISS_ICP) -> str:
    """Return the drift as text."""
    if method != KISS_ICP:
        return f"the drift of {method} is not estimated: it does not run backward"
    if percent is None:
        return "the sensor hardly moves, so the drift of the odometry is not estimated"
    told = (
        f"the drift of the odometry is about {percent:.2f}% of the path (forward against backward)"
    )
    if percent > LARGE_DRIFT:
        return f"{told}: it is not reliable here, and maps will be blurred. Give poses with --poses"
    return told
