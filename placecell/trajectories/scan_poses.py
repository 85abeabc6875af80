"""Poses of scans: a trajectory at the times of a source's scans."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.errors import DriveError
from placecell.core.types import Bool, Float64, Int64
from placecell.trajectories.interpolation import SAME, interpolate, lies_between, nearest
from placecell.trajectories.times import UNIT_NAMES, TimeUnit
from placecell.trajectories.trajectory import Trajectory

LARGEST_GAP = 0.5
"""Largest time between two poses that a scan's pose is interpolated from, seconds."""
ENOUGH = 0.5
"""Share of the scans that need a pose for a unit of time to be right."""
FACTORS: dict[TimeUnit, float] = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}
SAME_INTERVALS = 5e-3
"""Largest difference of the intervals of poses and scans that are taken for each other, seconds."""
FEWEST_INTERVALS = 10


@dataclass(frozen=True, slots=True)
class ScanPoses:
    """Poses of those scans that have one.

    Attributes:
        scans: index of each scan with a pose, int64 (k,), ascending.
        poses: pose at each of these scans, float64 (k, 4, 4).
        stamps: time of each of these scans, float64 (k,), seconds; None if there are no times.
        track: the whole trajectory, its times those of the scans' clock; None without times.
        remarks: what was found and decided, for the user.
    """

    scans: Int64
    poses: Float64
    stamps: Float64 | None
    track: Trajectory | None
    remarks: tuple[str, ...]


def poses_of_scans(
    trajectory: Trajectory, stamps: Float64, name: str, offset: float | None = None
) -> ScanPoses:
    """Return the pose of each scan, interpolated between the poses of a trajectory.

    A trajectory without times has one pose a scan. The unit of its times, and a difference of the
    clocks, are told where only one is possible; otherwise the trajectory is refused.

    Args:
        trajectory: the poses.
        stamps: time of each scan, float64 (scans,), seconds; NaN if unknown.
        name: name of the trajectory, for messages.
        offset: seconds to add to the times of the poses; None: 0, or found.

    Raises:
        DriveError: the trajectory does not fit the scans.
    """
    known = np.isfinite(stamps)
    if trajectory.stamps is None or not known.all():
        return in_sequence(trajectory, stamps, name)
    if offset is not None:
        moved = trajectory.stamps + offset
        remark = f"{name}: {offset:+g} s were added to its times, as stated"
        return at_times(replace(trajectory, stamps=moved), stamps, name, [remark])
    if posed(trajectory.stamps, stamps).any():
        share = float(posed(trajectory.stamps, stamps).mean())
        others = [unit for unit in FACTORS if other_share(trajectory, stamps, unit) > ENOUGH]
        if share >= ENOUGH or not others:
            return at_times(trajectory, stamps, name, [])
    fitting = [unit for unit in FACTORS if other_share(trajectory, stamps, unit) >= ENOUGH]
    if len(fitting) == 1:
        unit = fitting[0]
        remark = f"{name}: its times are {UNIT_NAMES[unit]}: only so they overlap with the scans'"
        scaled = replace(trajectory, stamps=trajectory.stamps * FACTORS[unit])
        return at_times(scaled, stamps, name, [remark])
    if len(fitting) > 1:
        units = " and as ".join(UNIT_NAMES[unit] for unit in fitting)
        raise DriveError(
            f"{name}: its times fit the scans' as {units}. Give the file with times in seconds"
        )
    if is_same_sequence(trajectory.stamps, stamps):
        shift = float(np.median(stamps - trajectory.stamps))
        remark = (
            f"{name}: its clock is {-shift:+,.3f} s off the scans' clock; poses and scans are "
            "equal in number and intervals, so they belong to each other in order"
        )
        return at_times(replace(trajectory, stamps=stamps.copy()), stamps, name, [remark])
    raise no_overlap(trajectory.stamps, stamps, name)


def posed(pose_stamps: Float64, stamps: Float64) -> Bool:
    """Return whether each scan has a pose: between two close poses, or at the time of one."""
    away, _ = nearest(stamps, pose_stamps)
    return lies_between(stamps, pose_stamps, LARGEST_GAP) | (away <= SAME)


def other_share(trajectory: Trajectory, stamps: Float64, unit: TimeUnit) -> float:
    """Return the share of scans that have a pose if the poses' times have this unit."""
    assert trajectory.stamps is not None
    return float(posed(trajectory.stamps * FACTORS[unit], stamps).mean())


def is_same_sequence(pose_stamps: Float64, stamps: Float64) -> bool:
    """Return whether poses and scans are equal in number and in intervals."""
    if len(pose_stamps) != len(stamps) or len(stamps) <= FEWEST_INTERVALS:
        return False
    return float(np.abs(np.diff(pose_stamps) - np.diff(stamps)).max()) <= SAME_INTERVALS


def in_sequence(trajectory: Trajectory, stamps: Float64, name: str) -> ScanPoses:
    """Return the poses in order, one a scan.

    Raises:
        DriveError: there is another number of poses than scans.
    """
    if len(trajectory) != len(stamps):
        lacking = (
            "the poses have no times" if trajectory.stamps is None else "the scans have no times"
        )
        raise DriveError(
            f"{name}: {len(trajectory)} poses for {len(stamps)} scans, and {lacking}, so they "
            "cannot be matched. Give one pose a scan, or times for both: a TUM file, or a times "
            "file beside the poses"
        )
    times, remarks = stamps, []
    if not np.isfinite(stamps).all():
        if trajectory.stamps is None:
            return ScanPoses(np.arange(len(stamps)), trajectory.poses, None, None, ())
        times = trajectory.stamps
        remarks.append(f"{name}: the scans have no times; they get those of the poses, in order")
    track = replace(trajectory, stamps=times) if (np.diff(times) > 0).all() else None
    return ScanPoses(np.arange(len(times)), trajectory.poses, times, track, tuple(remarks))


def at_times(
    trajectory: Trajectory, stamps: Float64, name: str, remarks: Sequence[str]
) -> ScanPoses:
    """Return the poses of the scans within the trajectory, and remarks on the others.

    Raises:
        DriveError: no scan has a pose.
    """
    assert trajectory.stamps is not None
    there = posed(trajectory.stamps, stamps)
    if not there.any():
        raise no_overlap(trajectory.stamps, stamps, name)
    scans = np.flatnonzero(there)
    at = stamps[scans]
    away, index = nearest(at, trajectory.stamps)
    poses = trajectory.poses[index].copy()
    # A scan at the time of a pose has that pose, bit for bit.
    between = away > 0 if len(trajectory) > 1 else np.zeros(len(at), dtype=bool)
    between &= lies_between(at, trajectory.stamps, LARGEST_GAP)
    poses[between] = interpolate(at[between], trajectory.stamps, trajectory.poses)
    told = list(remarks)
    if not there.all():
        before = int((stamps < trajectory.stamps[0] - SAME).sum())
        after = int((stamps > trajectory.stamps[-1] + SAME).sum())
        gaps = len(stamps) - len(scans) - before - after
        told.append(
            f"{name}: {len(stamps) - len(scans)} of {len(stamps)} scans have no pose and are left "
            f"out ({before} before the first pose, {after} after the last, {gaps} between poses "
            f"more than {LARGEST_GAP} s apart)"
        )
    return ScanPoses(scans, poses, at, trajectory, tuple(told))


def no_overlap(pose_stamps: Float64, stamps: Float64, name: str) -> DriveError:
    """Return the error of a trajectory whose times do not overlap with the scans'."""
    ours, theirs = (f"{each[0]:.3f} to {each[-1]:.3f} s" for each in (stamps, pose_stamps))
    apart = float(np.median(np.diff(pose_stamps))) if len(pose_stamps) > 1 else 0.0
    overlaps = pose_stamps[0] <= stamps[-1] and pose_stamps[-1] >= stamps[0]
    if overlaps and apart > LARGEST_GAP:
        return DriveError(
            f"{name}: its poses are {apart:.2f} s apart (median), expected at most {LARGEST_GAP} "
            "s. Give a trajectory with more poses, or use --odometry kiss-icp"
        )
    shift = float(stamps[0] - pose_stamps[0])
    hint = ""
    hours = shift / 1800
    if abs(hours) > 0.5 and abs(hours - round(hours)) < 0.1 and abs(hours) < 60:
        zone = round(hours)
        hint = f" The difference is close to a time zone of {zone / 2:g} h: {zone * 1800}."
    return DriveError(
        f"{name}: its times ({theirs}) do not overlap with the scans' times ({ours}). If the "
        "clocks differ, state the seconds to add to the poses' times with --pose-offset, such as "
        f"{shift:.3f} if both begin at the same moment.{hint}"
    )
