"""A drive of any source of scans: poses from a file, from the source itself, or by odometry."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path

import numpy as np

from placecell.core.types import Float64
from placecell.datasets.drive import Drive, check_motion
from placecell.datasets.source_poses import SourcePoses, find_poses, prefixed
from placecell.odometry.deskew import SensorMotion
from placecell.odometry.leveling import ground_in_world, leveling_of
from placecell.sources.bags import BagSource
from placecell.sources.errors import DriveError
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import (
    current_scan_options,
    silent,
    use_scan_options,
)
from placecell.sources.source import ScanSource
from placecell.trajectories.covariance import interpolate_covariances
from placecell.trajectories.interpolation import SAME

LARGEST_SLOPE = 10.0
"""Tilt of the ground over a whole drive from which z of the world is not up, degrees; the steepest
streets have 20 degrees, but not over a whole drive."""
UNKNOWN_STEP = 0.1
"""Time between two scans if nothing tells it, seconds."""


class SourceDrive(Drive):
    """A drive of a source of scans. Scans without a pose are left out.

    Attributes:
        source: the source.
        scans: index of each scan in the source, int64 (scans,).
        source_poses: the poses, and how they were found.
        is_leveled: whether the world of the poses was turned, so that covariances have other axes.
    """

    name = "source of scans"
    layout = "bags, MCAP, folders of point clouds, point cloud files"

    def __init__(self, source: ScanSource, folder: Path | None = None) -> None:
        """Find the poses of the scans.

        Args:
            source: the source.
            folder: folder of the drive, which names it; None: that of the source.

        Raises:
            DriveError: there are no poses, or they do not fit the scans.
        """
        self.source = source
        self.folder = folder or source.path
        self.options = options = current_scan_options()
        if not len(source):
            raise DriveError(
                f"{source.path}: holds no scans. Check the file, or its topic (--topic)"
            )
        if isinstance(source, BagSource):
            topic = source.cloud_topic
            frame = f", frame {source.frame!r}" if source.frame else ""
            options.tell(
                f"{source.path}: scans are the {len(topic)} clouds of the topic {topic.name!r} "
                f"({topic.type}{frame})"
            )
        elif options.topic:
            options.tell(f"{source.path}: {source.format} has no topics; --topic is not used")
        self.source_poses: SourcePoses = find_poses(source, options)
        self.scans = self.source_poses.scans
        self.scan_files = [source.path] * len(self.scans)
        self.origin = self.source_poses.poses[0, :3, 3].copy()
        self.poses = self.source_poses.poses.copy()
        self.poses[:, :3, 3] -= self.origin
        self.level()
        self.times = self.find_times()
        for remark in check_motion(
            self.poses, self.times, Path(self.source_poses.name), source.path
        ):
            options.tell(remark)
        self.tell_times()

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        from placecell.sources.catalog import is_source

        return is_source(folder)

    @property
    def title(self) -> str:
        return self.source.title if self.folder == self.source.path else self.folder.name

    @property
    def content(self) -> str:
        fields = ", ".join(self.source.fields)
        return f"{self.source.format} with {fields}" if fields else self.source.format

    def level(self) -> None:
        """Turn the world so that its z is up, if the ground shows that it is not."""
        self.is_leveled = False
        ground = ground_in_world(self.source, self.scans.tolist(), self.poses)
        if ground is None or ground.tilt_deg < LARGEST_SLOPE:
            return
        self.options.tell(
            f"{self.folder}: the ground is tilted by {ground.tilt_deg:.0f} degrees in the world of "
            "the poses; the world is leveled by it"
        )
        self.poses = leveling_of(ground.up) @ self.poses
        self.is_leveled = True

    def find_times(self) -> Float64:
        """Return the time of each scan, seconds; 0.1 s apart if nothing tells it."""
        times = self.source_poses.stamps
        if times is not None and np.isfinite(times).all():
            return times
        self.options.tell(
            f"{self.folder}: the scans have no times; they are taken as {UNKNOWN_STEP} s apart"
        )
        return UNKNOWN_STEP * np.arange(len(self.scans), dtype=np.float64)

    def tell_times(self) -> None:
        """Tell whether scans are deskewed, by the first scan."""
        try:
            times = self.source.scan(int(self.scans[0])).times
        except DriveError:
            return  # `scan` reports it.
        if times is None or not len(times):
            told = "the points have no times, so scans are not deskewed"
        elif not self.options.deskew:
            told = "scans are not deskewed (--no-deskew)"
        elif self.motion is None:
            told = "scans are not deskewed, because the poses have no ascending times"
        else:
            told = (
                f"scans are deskewed by the points' times ({times.min():.3f} to {times.max():.3f} "
                "s) and the poses. Use --no-deskew if they are deskewed already"
            )
        self.options.tell(f"{self.folder}: {told}")

    @cached_property
    def motion(self) -> SensorMotion | None:
        """Motion of the sensor, from all poses that there are."""
        track = self.source_poses.track
        if track is None or track.stamps is None:
            return SensorMotion.of(self.times, self.poses)
        poses = track.poses.copy()
        poses[:, :3, 3] -= self.origin
        return SensorMotion.of(track.stamps, poses)

    @cached_property
    def covariances(self) -> Float64 | None:
        track = self.source_poses.track
        if track is None or track.covariances is None or track.stamps is None or self.is_leveled:
            return None
        return interpolate_covariances(self.times, track.stamps, track.covariances)

    def read_scan(self, index: int) -> LidarScan:
        scan = self.source.scan(int(self.scans[index]))
        if scan.times is None or not self.options.deskew:
            return replace(scan, times=None)
        return replace(scan, times=self.on_clock(scan, index))

    def on_clock(self, scan: LidarScan, index: int) -> Float64:
        """Return the times of a scan's points, relative to the drive's time of the scan."""
        assert scan.times is not None
        apart = scan.stamp - float(self.source.stamps[int(self.scans[index])])
        return scan.times + apart if np.isfinite(apart) and abs(apart) > SAME else scan.times

    def scan_hash(self, index: int) -> str:
        return self.source.scan_hash(int(self.scans[index]))

    def scan_name(self, index: int) -> str:
        return f"scan {int(self.scans[index])}"

    def scan_path(self, index: int) -> str:
        return f"{self.folder}, {self.scan_name(index)}"


def open_source_drive(path: Path, folder: Path | None = None, layouts: str = "") -> SourceDrive:
    """Open any source of scans as a drive.

    Args:
        path: file or folder of the source.
        folder: folder of the drive, which names it; None: `path`.
        layouts: layouts of drives that the path does not have, for the message.

    Raises:
        DriveError: the source has no known format, or there are no poses for it.
    """
    from placecell.sources.catalog import is_source, open_source

    options = current_scan_options()
    with use_scan_options(replace(options, tell=silent)):
        try:
            source = open_source(path)  # `told` says what it finds.
        except DriveError as error:
            if not layouts or is_source(path):
                raise
            raise DriveError(f"{error}; or a drive in a known layout ({layouts})") from error
    told = set[str]()

    def tell_once(message: str) -> None:
        if message not in told:
            told.add(message)
            options.tell(message)

    def tell_notes() -> None:
        for note in source.notes():
            tell_once(prefixed(str(source.path), note))

    tell_notes()
    with use_scan_options(replace(options, tell=tell_once)):
        drive = SourceDrive(source, folder)
    tell_notes()  # of what was read since
    return drive
