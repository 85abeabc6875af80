"""Problems of poses and times."""

from collections.abc import Iterator

import numpy as np

from placecell.inspection.clocks import JUMP, LISTED, Clock
from placecell.inspection.ground import SensorMount, world_tilt
from placecell.inspection.problem import SourceProblem
from placecell.inspection.scan_problems import LEVEL_DEG
from placecell.inspection.subject import Subject
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import current_scan_options
from placecell.trajectories.scan_poses import ScanPoses, poses_of_scans
from placecell.trajectories.trajectory import Trajectory

RATES = (1.0, 40.0)
"""Usual rates of scans, Hz."""
STANDS = 0.1
"""Largest extent of positions that counts as standing, meters."""
FASTEST = 70.0
"""Speed above which a step between poses is a jump, m/s: 250 km/h."""
SMALLEST_JUMP = 2.0
"""Smallest step that is a jump, meters."""


def no_poses(subject: Subject) -> Iterator[SourceProblem]:
    """Find sources without poses."""
    if subject.trajectory is None and len(subject.stamps):
        if any("pose" in problem.what for problem in subject.problems):
            return  # Damaged poses are told already.
        yield SourceProblem(
            "warning",
            "The source has scans and no poses",
            "Give a trajectory with --poses FILE. Without one, odometry of the scans is used "
            "(--odometry kiss-icp; install it with: pip install 'placecell[odometry]').",
        )


def matched(subject: Subject) -> tuple[ScanPoses | None, list[SourceProblem]]:
    """Return the poses of the scans, and the problems of finding them."""
    if subject.trajectory is None or not len(subject.stamps):
        return None, []
    order = np.sort(subject.stamps) if np.isfinite(subject.stamps).all() else subject.stamps
    if subject.trajectory.stamps is not None and len(subject.trajectory) == len(order):
        same = np.array_equal(subject.trajectory.stamps, subject.stamps)
        if same:  # a drive's own poses, one a scan
            poses = subject.trajectory.poses
            return ScanPoses(np.arange(len(poses)), poses, subject.stamps, None, ()), []
    try:
        offset = current_scan_options().pose_offset
        found = poses_of_scans(subject.trajectory, order, "The trajectory", offset)
    except DriveError as error:
        return None, [SourceProblem.of("error", error)]
    problems = []
    for remark in found.remarks:
        part = len(found.scans) < len(order) and "left out" in remark
        problems.append(
            SourceProblem(
                "warning" if part else "info",
                remark,
                "Record poses for the whole drive, or use odometry (--odometry kiss-icp)."
                if part
                else "No action is needed if this is right.",
            )
        )
    return found, problems


def standing_poses(trajectory: Trajectory | None) -> Iterator[SourceProblem]:
    """Find poses that never move."""
    if trajectory is None or len(trajectory) < 2:
        return
    extent = float(np.ptp(trajectory.poses[:, :3, 3], axis=0).max())
    if extent < STANDS:
        yield SourceProblem(
            "warning",
            f"The {len(trajectory)} poses never move: they extend over {extent:.3f} m",
            "Use another topic (--odometry TOPIC), a trajectory (--poses FILE), or odometry of the "
            "scans (--odometry kiss-icp). If the robot stood still, record a drive.",
        )


def jumping_poses(trajectory: Trajectory | None) -> Iterator[SourceProblem]:
    """Find steps between poses that no vehicle drives."""
    if trajectory is None or len(trajectory) < 3:
        return
    steps = np.linalg.norm(np.diff(trajectory.poses[:, :3, 3], axis=0), axis=1)
    if trajectory.stamps is None:
        usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
        jumps = steps > np.maximum(SMALLEST_JUMP, 20 * usual)
    else:
        waits = np.diff(trajectory.stamps)
        jumps = (steps > SMALLEST_JUMP) & (steps > FASTEST * np.maximum(waits, 0.01))
    if jumps.any():
        first = int(jumps.argmax())
        yield SourceProblem(
            "warning",
            f"{int(jumps.sum())} steps between poses are jumps, faster than a vehicle. The first: "
            f"{steps[first]:.1f} m after pose {first}",
            "Use poses that are continuous, such as odometry in place of GPS or a pose graph that "
            "was corrected during the drive.",
        )


def world_not_level(mount: SensorMount, poses: ScanPoses | None) -> Iterator[SourceProblem]:
    """Find poses whose world does not have z up."""
    if poses is None or mount.ground is None or not len(poses.poses):
        return
    tilt = world_tilt(mount.ground, poses.poses)
    if tilt > LEVEL_DEG:
        yield SourceProblem(
            "warning",
            f"In the frame of the poses, up is {tilt:.0f} degrees away from z; the ground removal "
            f"needs {LEVEL_DEG:g} degrees or less",
            "State the sensor's pose in the frame of the poses with --extrinsic, or convert the "
            "poses to a frame with z up.",
        )


def odd_times(clock: Clock, scans: int) -> Iterator[SourceProblem]:
    """Find clock jumps, gaps, repeated times and odd rates."""
    if scans > 1 and clock.unknown:
        yield SourceProblem(
            "info" if clock.unknown == scans else "warning",
            f"{clock.unknown} of {scans} scans have no time",
            "Add times.txt with a time in seconds a line, or name the files by their time.",
        )
    for jumps, word in ((clock.backward, "backward"), (clock.forward, "forward")):
        if jumps:
            at, length = jumps[0]
            yield SourceProblem(
                "warning",
                f"The clock jumps {word} {len(jumps)} times. The first: {length:+.3f} s after "
                f"scan {at}",
                "Synchronize the sensor's clock before recording."
                if word == "backward"
                else f"Cut the recording there if it is a pause of over {JUMP:g} s.",
            )
    if clock.repeated:
        yield SourceProblem(
            "warning",
            f"{clock.repeated} scans have the time of the scan before",
            "Remove repeated messages, or use the sensor's own time stamps.",
        )
    if clock.gaps:
        at, length = clock.gaps[0]
        yield SourceProblem(
            "warning" if clock.lost > 0.01 * scans else "info",
            f"{len(clock.gaps)} gaps, in which about {clock.lost} scans are missing. The first: "
            f"{length:.2f} s after scan {at}",
            "Record to a faster disk, or with a larger buffer, so that no messages are dropped.",
        )
    if clock.rate_hz is not None and not RATES[0] <= clock.rate_hz <= RATES[1]:
        yield SourceProblem(
            "warning",
            f"Scans come at {clock.rate_hz:.3g} Hz; expected {RATES[0]:g} to {RATES[1]:g} Hz",
            "Check the unit of the times (--time-unit).",
        )


def listed(gaps: tuple[tuple[int, float], ...]) -> list[dict[str, float]]:
    """Return the first gaps as JSON values."""
    return [{"after_scan": at, "seconds": round(length, 4)} for at, length in gaps[:LISTED]]
