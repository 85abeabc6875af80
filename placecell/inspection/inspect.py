"""The doctor: inspects a source and returns its report."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from placecell.inspection import pose_problems, scan_problems
from placecell.inspection.clocks import Clock, read_clock
from placecell.inspection.ground import SensorMount, find_mount
from placecell.inspection.imu import SourceImu, imu_problems, read_source_imu
from placecell.inspection.problem import Severity, SourceProblem
from placecell.inspection.samples import RANGES, Progress, Samples, sample
from placecell.inspection.subject import CLOUDS, Subject, open_subject
from placecell.trajectories.trajectory import Trajectory

SCANS = 40
"""Number of scans to look at."""
ORDER = ("error", "warning", "info")


@dataclass(frozen=True, slots=True, eq=False)
class Inspection:
    """Findings on a source.

    Attributes:
        subject: what was found at the path.
        samples: facts on some scans.
        clock: times of the scans.
        mount: the sensor's height and tilt.
        imu: the IMU of the source; None if it has none.
        problems: all problems, the worst first.
    """

    subject: Subject
    samples: Samples
    clock: Clock
    mount: SensorMount
    imu: SourceImu | None
    problems: tuple[SourceProblem, ...]

    @property
    def usable(self) -> bool:
        """Return whether Placecell can use the source."""
        return all(problem.severity != "error" for problem in self.problems)

    @property
    def leveled_by(self) -> str | None:
        """Source of up for odometry: `imu`, `ground`, or None."""
        if self.imu is not None and self.imu.gravity is not None:
            return "imu"
        return None if self.mount.ground is None else "ground"

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON values."""
        scans = self.samples.scans
        read = sum(scan.read for scan in scans)
        sweeps = [scan.sweep for scan in scans if scan.sweep is not None]
        ground = self.mount.ground
        trajectory = self.subject.trajectory
        return {
            "source": str(self.subject.path),
            "format": self.subject.format,
            "scans": len(self.subject.stamps),
            "scans_looked_at": len(scans) + len(self.samples.failures),
            "points_mean": round(float(np.mean([scan.read for scan in scans])), 1) if scans else 0,
            "fields": list(self.subject.fields()),
            "per_point_time": bool(sweeps),
            "sweep_s": round(float(np.median(sweeps)), 5) if sweeps else None,
            "nan_share": share(sum(scan.not_finite for scan in scans), read),
            "zero_share": share(sum(scan.zeros for scan in scans), read),
            "poses": 0 if trajectory is None else len(trajectory),
            "trajectory": None if trajectory is None else of_trajectory(trajectory),
            "frame": self.subject.frame,
            "tf": self.subject.transform or None,
            "sensor_height_m": None if ground is None else round(ground.height, 3),
            "tilt_deg": None if ground is None else round(ground.tilt_deg, 2),
            "ground": self.mount.reason or None,
            "imu": None if self.imu is None else self.imu.as_dict(),
            "leveled_by": self.leveled_by,
            "up_axis": self.mount.up_axis or None,
            "view_deg": round(float(np.median([s.view_deg for s in scans])), 1) if scans else None,
            "ranges": ranges(self.samples),
            "rate_hz": None if self.clock.rate_hz is None else round(self.clock.rate_hz, 3),
            "gaps": len(self.clock.gaps),
            "missing_scans": self.clock.lost,
            "gap_list": pose_problems.listed(self.clock.gaps),
            "clock_jumps": pose_problems.listed((*self.clock.backward, *self.clock.forward)),
            "topics": list(self.subject.topics),
            "cloud_topic": self.subject.chosen or None,
            "cloud_topics": sum(
                topic["type"].rpartition("/")[2].rpartition(".")[2] in CLOUDS
                for topic in self.subject.topics
            ),
            "usable": self.usable,
            "problems": [asdict(problem) for problem in self.problems],
        }


def share(part: int, whole: int) -> float:
    """Return a share, 0 to 1."""
    return round(part / whole, 6) if whole else 0.0


def ranges(samples: Samples) -> list[dict[str, Any]]:
    """Return the share of the points in each bin of ranges."""
    total = np.sum([scan.histogram for scan in samples.scans], axis=0, dtype=np.int64)
    if not np.any(total):
        return []
    return [
        {"from_m": low, "to_m": high, "share": round(float(part), 4)}
        for low, high, part in zip(RANGES, (*RANGES[1:], None), total / total.sum(), strict=True)
    ]


def of_trajectory(trajectory: Trajectory) -> dict[str, Any]:
    """Return the facts on poses. The length of a damaged trajectory may be no number."""
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.linalg.norm(np.diff(trajectory.poses[:, :3, 3], axis=0), axis=1)
        length = float(steps.sum())
    stamps = trajectory.stamps
    rate = None
    if stamps is not None and len(stamps) > 1 and stamps[-1] > stamps[0]:
        rate = round(float((len(stamps) - 1) / (stamps[-1] - stamps[0])), 3)
    return {
        "length_m": round(length, 2) if np.isfinite(length) else None,
        "rate_hz": rate,
        "frame": trajectory.frame,
        "world": trajectory.world,
    }


def silent(items: Any, total: int, what: str) -> Any:  # noqa: ARG001
    """Return the items and show no progress."""
    return items


# Damaged files hold any numbers. What overflows compares as infinite and is told as a problem.
@np.errstate(over="ignore", invalid="ignore")
def inspect_source(path: Path, scans: int = SCANS, progress: Progress = silent) -> Inspection:
    """Inspect a file or folder.

    Args:
        path: a drive, a bag, point clouds, a trajectory, or a file of Placecell.
        scans: number of scans to look at; they are evenly spread.
        progress: function that shows the progress.

    Raises:
        DriveError: the path does not exist.
    """
    subject = open_subject(path)
    samples = sample(subject, scans, progress) if len(subject.stamps) else Samples((), ())
    clock = read_clock(subject.stamps)
    mount = find_mount(samples.clouds)
    notes = subject.notes()
    found = list(subject.problems)
    found += scan_problems.unreadable_scans(samples)
    found += scan_problems.empty_scans(samples)
    of_map = list(scan_problems.map_cloud(samples, notes))
    found += of_map
    if not any(problem.severity == "error" for problem in of_map):
        found += scan_problems.wrong_unit(samples, mount)
        found += scan_problems.few_points(samples)
    found += scan_problems.wrong_up(mount)
    found += scan_problems.tilted(mount, subject)
    found += scan_problems.odd_height(mount, samples)
    found += scan_problems.narrow_view(samples)
    found += scan_problems.lost_points(samples)
    found += scan_problems.no_point_times(samples, subject)
    found += scan_problems.unknown_fields(subject.fields())
    found += scan_problems.repeated_scans(samples)
    found += scan_problems.cloud_topics(subject)
    found += pose_problems.no_poses(subject)
    poses, odd = pose_problems.matched(subject)
    found += odd
    imu = read_source_imu(subject, poses)
    found += imu_problems(imu, mount)
    found += pose_problems.standing_poses(subject.trajectory)
    found += pose_problems.jumping_poses(subject.trajectory)
    found += pose_problems.world_not_level(mount, poses)
    found += pose_problems.odd_times(clock, len(subject.stamps))
    for note in notes:
        severity: Severity = "warning" if "expected" in note.lower() else "info"
        found.append(SourceProblem.of(severity, note, "No action is needed if this is right."))
    found.sort(key=lambda problem: ORDER.index(problem.severity))
    return Inspection(subject, samples, clock, mount, imu, tuple(dict.fromkeys(found)))
