"""Odometry from scans and an IMU: RKO-LIO (Malladi et al. 2025) over a source of scans."""

from typing import Any

import numpy as np

from placecell.core.progress import Progress
from placecell.core.types import Float64
from placecell.odometry.deskew import SensorMotion
from placecell.odometry.scan_odometry import OdometrySettings, read
from placecell.sources.errors import DriveError
from placecell.sources.imu import ImuSamples
from placecell.sources.source import ScanSource
from placecell.trajectories.poses import of_quaternions

INSTALL = (
    'This odometry needs the package rko-lio: pip install "placecell[rko-lio]". Or use --odometry '
    "kiss-icp, which needs no IMU, or give poses with --poses FILE"
)
LONGEST_SWEEP = 1.0
"""Time after a scan's stamp in which measurements of the IMU belong to it, seconds."""


def imu_of(source: ScanSource) -> ImuSamples:
    """Return the IMU of all scans of a source.

    Raises:
        DriveError: there is none, or the scans have no times.
    """
    stamps = source.stamps
    if not np.isfinite(stamps).all() or not (np.diff(stamps) > 0).all():
        raise DriveError(
            f"{source.path}: --odometry rko-lio needs scans with ascending times, and some have "
            "none or repeat one. Use --odometry kiss-icp"
        )
    imu = source.imu(float(stamps[0]) - LONGEST_SWEEP, float(stamps[-1]) + LONGEST_SWEEP)
    if imu is None:
        raise DriveError(
            f"{source.path}: --odometry rko-lio needs an IMU, and there is no sensor_msgs/Imu with "
            "accelerations. Use --odometry kiss-icp"
        )
    return imu


def run_inertial(
    source: ScanSource, settings: OdometrySettings, imu: ImuSamples, progress: Progress
) -> Float64:
    """Return the pose of each scan in the frame of the first, float64 (scans, 4, 4).

    Args:
        source: the source; its scans have ascending times.
        settings: settings of the odometry.
        imu: measurements of the IMU over all scans.
        progress: shows the progress.

    Raises:
        DriveError: RKO-LIO is not installed, or it registers fewer than two scans.
    """
    odometry, refused = rko_lio(settings)
    mount = np.eye(4)
    mount[:3, 3] = imu.mount[:3, 3]  # The measurements are in the LiDAR's axes already.
    stamps = source.stamps
    begin = min(float(stamps[0]), float(imu.stamps[0])) - LONGEST_SWEEP
    measured = 0
    for index in progress(range(len(source)), len(source), f"odometry of {source.title}"):
        scan = read(source, index)
        if not len(scan.points):
            continue
        times = np.full(len(scan.points), stamps[index])
        if settings.deskew and scan.times is not None:
            times = times + scan.times
        while measured < len(imu) and imu.stamps[measured] <= times.max():
            odometry.add_imu_measurement(
                imu.accelerations[measured],
                imu.rates[measured],
                nanoseconds(float(imu.stamps[measured]) - begin),
                mount,
            )
            measured += 1
        try:
            ticks = np.round((times - begin) * 1e9).astype(np.int64)
            odometry.register_scan(scan.points.astype(np.float64), ticks)
        except refused:  # Without measurements of the IMU; its pose lies between the others.
            continue
    ticks, rows = odometry.poses_with_timestamps()
    values = np.asarray(rows, np.float64).reshape(-1, 7)  # position, and quaternion x y z w
    poses = of_quaternions(values[:, :3], values[:, 3:])
    motion = SensorMotion.of(np.asarray(ticks, np.float64) * 1e-9 + begin, poses)
    if motion is None:
        raise DriveError(
            f"{source.path}: rko-lio registered {len(ticks)} of {len(source)} scans. Check that "
            "the IMU and the scans are of the same time (placecell inspect), or use --odometry "
            "kiss-icp"
        )
    found = motion.at(stamps)
    return np.asarray(np.linalg.inv(found[0]) @ found)


def rko_lio(settings: OdometrySettings) -> tuple[Any, type[Exception]]:
    """Return a new odometry of RKO-LIO, and the error that it raises for a scan.

    Raises:
        DriveError: the package is not installed.
    """
    try:
        from rko_lio.config import LIOConfig
        from rko_lio.lio import LIO
        from rko_lio.rko_lio_pybind import InputError
    except ModuleNotFoundError as error:
        raise DriveError(f"{INSTALL} ({error.name} is not installed)") from error
    config = LIOConfig(
        deskew=settings.deskew,
        voxel_size=settings.voxel,
        max_range=settings.max_range,
        min_range=settings.min_range,
        max_num_threads=1,  # as of KISS-ICP
        initialization_phase=True,
    )
    return LIO(config), InputError


def nanoseconds(seconds: float) -> int:
    """Return a time in nanoseconds."""
    return round(seconds * 1e9)
