"""Odometry from scans alone: KISS-ICP (Vizzo et al. 2023) over a source of scans."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from placecell.core.progress import Progress
from placecell.core.types import Float32, Float64
from placecell.odometry.deskew import SensorMotion, deskew
from placecell.sources.errors import DriveError
from placecell.sources.scan import LidarScan
from placecell.sources.source import ScanSource

SAMPLES = 8
"""Number of scans that tell the range of the sensor."""
RANGES = (20.0, 100.0)
"""Smallest and largest range up to which points are registered, meters."""
VOXELS_IN_RANGE = 100
"""KISS-ICP's own rule: the voxel of its map is a hundredth of the range."""
NEAREST = 0.03
"""Points nearer than this share of the range are the vehicle itself."""
USUAL_PERIOD = 0.1
"""Time between scans if it is not known, seconds."""

INSTALL = (
    'Odometry needs the package kiss-icp: pip install "placecell[odometry]". Or give poses with '
    "--poses FILE"
)


@dataclass(frozen=True, slots=True)
class OdometrySettings:
    """Settings of the odometry, found from the scans.

    Attributes:
        max_range: points farther away are not registered, meters.
        min_range: points nearer are not registered, meters.
        voxel: edge length of the map's voxels, meters.
        deskew: whether points are moved to the scan's time by their own times.
    """

    max_range: float
    min_range: float
    voxel: float
    deskew: bool

    @classmethod
    def of(cls, source: ScanSource, use_times: bool) -> "OdometrySettings":
        """Find the settings from some scans, evenly spread.

        Raises:
            DriveError: none of these scans can be read.
        """
        chosen = np.unique(np.linspace(0, len(source) - 1, SAMPLES).astype(int))
        clouds = [read(source, int(index)).points for index in chosen]
        clouds = [points for points in clouds if len(points)]
        if not clouds:
            raise DriveError(f"{source.path}: {len(chosen)} scans were tried, and none has points")
        return cls.of_points(clouds, use_times)

    @classmethod
    def of_points(cls, clouds: Sequence[Float32], use_times: bool) -> "OdometrySettings":
        """Find the settings from some scans with points."""
        ranges = [np.quantile(np.linalg.norm(points, axis=1), 0.98) for points in clouds]
        max_range = float(np.clip(1.2 * np.median(ranges), *RANGES).round(1))
        return cls(max_range, round(NEAREST * max_range, 2), max_range / VOXELS_IN_RANGE, use_times)


def read(source: ScanSource, index: int) -> LidarScan:
    """Read a scan; a damaged one has no points."""
    try:
        return source.scan(index)
    except DriveError:
        return LidarScan(np.zeros((0, 3), np.float32))


def kiss_icp(settings: OdometrySettings) -> Any:
    """Return a new odometry of KISS-ICP.

    Raises:
        DriveError: the package is not installed.
    """
    try:
        from kiss_icp.config import KISSConfig
        from kiss_icp.kiss_icp import KissICP
    except ModuleNotFoundError as error:
        raise DriveError(f"{INSTALL} ({error.name} is not installed)") from error
    config = KISSConfig()
    config.data.max_range = settings.max_range
    config.data.min_range = settings.min_range
    config.data.deskew = False  # `deskew` moves points to the scan's time, not to the sweep's end
    config.mapping.voxel_size = settings.voxel
    # Sums of several threads differ in their last bits from run to run.
    config.registration.max_num_threads = 1
    return KissICP(config)


def run(
    source: ScanSource,
    scans: Sequence[int],
    settings: OdometrySettings,
    progress: Progress,
    title: str,
    guide: Float64 | None = None,
) -> Float64:
    """Return the pose of each scan in the frame of the first, float64 (scans, 4, 4).

    Args:
        source: the source.
        scans: indices of the scans, ascending or descending in time.
        settings: settings of the odometry.
        progress: shows the progress.
        title: title of the progress bar.
        guide: poses of the same scans by an earlier pass: its motion deskews the scans and is where
            the registration starts; None: the motion goes on as between the two scans before.
    """
    stamps = times_of(source, scans)
    odometry = ScanOdometry(settings, None if guide is None else SensorMotion.of(stamps, guide))
    forward = 1.0 if scans[-1] >= scans[0] else -1.0
    poses = np.tile(np.eye(4), (len(scans), 1, 1))
    for step in progress(range(len(scans)), len(scans), title):
        poses[step] = odometry.add(read(source, scans[step]), float(stamps[step]), forward)
    return poses


class ScanOdometry:
    """Odometry of KISS-ICP, scan by scan.

    Attributes:
        stamps: times of the last scans, seconds, at most two.
        poses: poses of the last scans in the frame of the first, at most two.
    """

    def __init__(self, settings: OdometrySettings, motion: SensorMotion | None = None) -> None:
        """Begin an odometry.

        Args:
            settings: settings of the odometry.
            motion: motion of the sensor as far as it is known; None: it is expected to go on.

        Raises:
            DriveError: KISS-ICP is not installed.
        """
        self._odometry = kiss_icp(settings)
        self._deskew = settings.deskew
        self._motion = motion
        self.stamps: list[float] = []
        self.poses: list[Float64] = []

    def add(self, scan: LidarScan, stamp: float, forward: float = 1.0) -> Float64:
        """Return the pose of the next scan in the frame of the first, float64 (4, 4).

        Args:
            scan: the scan.
            stamp: its time, seconds, later than that of the scan before.
            forward: 1, or -1 if the drive is run backward.
        """
        expected = self._expected()
        points = scan.points
        if self._deskew and scan.times is not None and expected is not None:
            points = deskew(points, forward * scan.times, stamp, expected)
        if not len(points):
            pose = self.poses[-1] if self.poses else np.eye(4)
        else:
            if expected is not None and self.stamps:
                # KISS-ICP expects the last step again; scans may be missing between two.
                last, now = expected.at(np.array([self.stamps[-1], stamp]))
                self._odometry.last_delta = np.linalg.inv(last) @ now
            self._odometry.register_frame(points.astype(np.float64), np.zeros(0))
            pose = np.array(self._odometry.last_pose)
        self.stamps = [*self.stamps[-1:], stamp]
        self.poses = [*self.poses[-1:], pose]
        return pose

    def _expected(self) -> SensorMotion | None:
        """Return the known motion, else the one that goes on as between the two scans before."""
        if self._motion is not None:
            return self._motion
        if len(self.poses) < 2:
            return None
        return SensorMotion(np.array(self.stamps), np.array(self.poses))


def times_of(source: ScanSource, scans: Sequence[int]) -> Float64:
    """Return ascending times of scans, seconds; unknown and repeated ones are 0.1 s apart."""
    stamps = source.stamps[np.asarray(scans)]
    if not np.isfinite(stamps).all():
        return USUAL_PERIOD * np.arange(len(scans), dtype=np.float64)
    steps = np.abs(np.diff(stamps))
    steps[steps <= 0] = USUAL_PERIOD
    return np.concatenate([[0.0], np.cumsum(steps)])


def rotated(points: Float32, pose: Float64) -> Float32:
    """Rotate points by the rotation of a pose, float32 (n, 3)."""
    return np.asarray(points @ pose[:3, :3].T.astype(np.float32))
