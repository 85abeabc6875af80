"""Playback: the scans and the odometry of a recording, as a robot would get them."""

import hashlib
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from placecell.datasets import FORMATS, open_drive
from placecell.datasets.drive import Drive
from placecell.datasets.source_poses import given_poses
from placecell.odometry.live_odometry import PosedScan, posed_scans
from placecell.odometry.scan_odometry import read
from placecell.sources.catalog import is_source, open_source
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import (
    KISS_ICP,
    NO_ODOMETRY,
    current_scan_options,
    silent,
    use_scan_options,
)
from placecell.sources.source import ScanSource


class Playback(Protocol):
    """Scans of a recording in the order of their times.

    Attributes:
        title: name of the recording.
        session: identity of the recording, for a restarted agent.
    """

    title: str
    session: str

    def __len__(self) -> int:
        """Return the number of scans."""

    def scans(self, first: int = 0) -> Iterator[PosedScan]:
        """Yield the scans from an index on, with their poses in the odometry frame."""


class DrivePlayback:
    """Playback of a drive with poses: they are the robot's odometry."""

    def __init__(self, drive: Drive) -> None:
        self.drive = drive
        self.title = drive.title
        self.session = identity(drive.title, drive.scan_hash(0), len(drive))

    def __len__(self) -> int:
        return len(self.drive)

    def scans(self, first: int = 0) -> Iterator[PosedScan]:
        """Yield the scans from an index on; a scan that cannot be read has no points."""
        covariances = self.drive.covariances
        for index in range(first, len(self.drive)):
            yield PosedScan(
                self.drive.scan(index),
                float(self.drive.times[index]),
                self.drive.poses[index],
                None if covariances is None else covariances[index],
            )


class OdometryPlayback:
    """Playback of a source without poses: the odometry is computed while the scans come."""

    def __init__(self, source: ScanSource, use_times: bool = True) -> None:
        self.source = source
        self.title = source.title
        self.session = identity(source.title, source.scan_hash(0), len(source))
        self._use_times = use_times

    def __len__(self) -> int:
        return len(self.source)

    def scans(self, first: int = 0) -> Iterator[PosedScan]:
        """Yield the scans from an index on; the odometry of those before is computed again."""
        scans = (read(self.source, index) for index in range(len(self.source)))
        for index, posed in enumerate(posed_scans(scans, self._use_times)):
            if index >= first:
                yield posed


def identity(title: str, first_scan: str, scans: int) -> str:
    """Return the identity of a recording: 16 hex digits."""
    return hashlib.sha256(f"{title}\n{first_scan}\n{scans}".encode()).hexdigest()[:16]


def open_playback(path: Path) -> Playback:
    """Open any source of scans, with the options of the current context.

    A folder in a known layout, a file of poses, or a topic gives the odometry; else it is computed
    by KISS-ICP, scan by scan.

    Raises:
        DriveError: the source cannot be read, or has no scans.
    """
    options = current_scan_options()
    path = Path(path).absolute()
    scans = path
    if path.is_dir():
        layout = next((each for each in FORMATS if each.recognizes(path)), None)
        if layout is not None:
            stated = options.poses is not None or options.odometry not in (None, NO_ODOMETRY)
            if not stated and layout.has_poses(path):
                return DrivePlayback(open_drive(path))
            scans = path / layout.scan_folder
    if options.odometry != KISS_ICP and not is_source(scans):
        return DrivePlayback(open_drive(path))  # The error tells which formats there are.
    with use_scan_options(options):
        source = open_source(scans)
    if not len(source):
        raise DriveError(f"{path}: holds no scans. Check the file, or its topic (--topic)")
    if len(source) == 1 or given_poses_exist(source):
        return DrivePlayback(open_drive(path))
    if options.odometry == NO_ODOMETRY:
        return DrivePlayback(open_drive(path))  # The error tells how to give poses.
    options.tell(f"{path}: the odometry is computed by kiss-icp while the scans come")
    return OdometryPlayback(source, options.deskew)


def given_poses_exist(source: ScanSource) -> bool:
    """Return whether a file, a topic or the source itself gives the poses."""
    options = replace(current_scan_options(), tell=silent)
    return given_poses(source, options) is not None


def at_own_pace(
    scans: Iterator[PosedScan],
    speed: float,
    late: Callable[[], None],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
    allowed: float = 0.1,
) -> Iterator[PosedScan]:
    """Yield scans when their time has come, and leave out those that come too late.

    A scan is late if the next one is due already. So a program that is too slow processes as many
    scans as it can, as on a robot.

    Args:
        scans: scans with ascending times.
        speed: number of recorded seconds in a second.
        late: called for each scan that is left out.
        clock: monotonic clock, seconds.
        sleep: waits a number of seconds.
        allowed: delay from which a scan is late, recorded seconds.
    """
    begun: float | None = None
    first = 0.0
    last = 0.0
    for scan in scans:
        if begun is None:
            begun, first = clock(), scan.time
        elif scan.time < last:
            begun, first = clock(), scan.time  # The clock of the recording jumped back.
        elif scan.time - last > LONGEST_PAUSE:
            first += scan.time - last - LONGEST_PAUSE
        last = scan.time
        due = begun + (scan.time - first) / speed
        now = clock()
        if now < due:
            sleep(due - now)
        elif (now - due) * speed > allowed:
            late()
            continue
        yield scan


LONGEST_PAUSE = 60.0
"""Longest pause of a recording that is waited for, recorded seconds."""
