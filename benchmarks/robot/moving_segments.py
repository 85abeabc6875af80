"""Segments that move while they are seen: how many are marked, and what that gains.

Two robots drive the same streets of a simulated town in opposite directions, with other parked cars
and with oncoming cars. The label of each return tells which segments move. Of a recorded drive,
blocks are localized in the map of the other blocks.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from evaluation.machine import machine
from evaluation.poses.evaluate import evaluate
from evaluation.poses.queries import Pair
from placecell.core.types import Bool, Float64, Int64
from placecell.datasets import Drive
from placecell.datasets.labels import has_labels, read_codes
from placecell.segmentation.incremental import IncrementalSegmentation
from placecell.segmentation.local_map import transform
from placecell.segmentation.pipeline import Progress, silent
from placecell.segmentation.recording import Recording

FIRST_MOVING = 252
"""First of SemanticKITTI's codes of things that move."""
NEAR = 0.2
"""Distance from a moving return within which a point is of the same thing, meters."""
MOST, FEWEST = 0.5, 0.05
"""Share of its points that move, from which a segment moves, and up to which it stands."""
POSE_KEYS = ("queries", "map_segments", "map_bytes", "best_pose_right", "counts")


@dataclass(frozen=True, slots=True, eq=False)
class MovingSegments:
    """Motion of the segments of a recording.

    Attributes:
        ids: int64 (segments,), persistent id of each segment.
        marked: bool (segments,), whether the segment was marked when it was seen.
        share: float64 (segments,), share of the points that are of moving things, by the labels;
            NaN without labels.
    """

    ids: Int64
    marked: Bool
    share: Float64

    @property
    def left_out(self) -> Bool:
        """Whether the robot's map is without the segment: its id was marked then or later."""
        return np.isin(self.ids, self.ids[self.marked])

    def figures(self) -> dict[str, int]:
        """Return the numbers of views that move and stand, and how many of them are marked."""
        moving, standing = self.share > MOST, self.share < FEWEST
        return {
            "views": len(self.ids),
            "marked": int(self.marked.sum()),
            "left_out": int(self.left_out.sum()),
            "moving": int(moving.sum()),
            "moving_marked": int((moving & self.marked).sum()),
            "moving_left_out": int((moving & self.left_out).sum()),
            "standing": int(standing.sum()),
            "standing_marked": int((standing & self.marked).sum()),
            "standing_left_out": int((standing & self.left_out).sum()),
        }


def moving_segments(drive: Drive, recording: Recording) -> MovingSegments:
    """Follow the segments of a recording scan by scan, beside the labels of the scans."""
    scans = range(recording.scans) if recording.part is None else recording.part
    segmentation = IncrementalSegmentation(recording.parameters)
    moving = deque[Any](maxlen=recording.parameters.accumulated_scans)
    count = len(recording.segments)
    ids, marked, share = np.zeros(count, np.int64), np.zeros(count, bool), np.zeros(count)
    captures, first = set(recording.capture_scans), 0
    for scan in scans:
        points, pose = drive.scan(scan), drive.poses[scan]
        segmentation.add(points, pose)
        moving.append(transform(pose, points[read_codes(drive, scan) >= FIRST_MOVING]))
        if scan not in captures:
            continue
        live = segmentation.segments()
        rows = slice(first, first + len(live))
        ids[rows], marked[rows] = live.ids, live.moved
        tree = cKDTree(np.concatenate(moving))
        for row in range(len(live)):
            away, _ = tree.query(live.segments.cloud(row), distance_upper_bound=NEAR)
            share[first + row] = np.isfinite(away).mean()
        first += len(live)
    if first != count:
        raise ValueError(f"{drive.folder}: the recording {recording.name} is of other scans.")
    return MovingSegments(ids, marked, share if has_labels(drive) else np.full(count, np.nan))


def without(recording: Recording, left_out: Bool) -> Recording:
    """Return a recording without some segments."""
    rows = np.flatnonzero(~left_out)
    return replace(
        recording,
        segments=recording.segments.take(rows),
        captures=recording.captures[rows],
        groups=recording.groups[rows],
        distinct=recording.distinct[rows],
    )


def measure_sensor(
    folder: Path,
    sensor: str,
    seed: int,
    scans: int,
    oncoming: float,
    model: Path,
    progress: Progress,
) -> dict[str, Any]:
    """Return the figures of one sensor; `measure_moving` has the arguments."""
    from town import two_robots
    from town.sensing.sensors import sensor as lidar_of

    paths = two_robots(
        folder,
        seed,
        scans,
        spacing=1.0,
        lidar=lidar_of(sensor),
        oncoming=oncoming,
        labels=True,
        overwrite=True,
        progress=progress,
    )
    figures = measure_pair(Pair.of(*paths, progress=progress), model, progress)
    return {"sensor": sensor, "seed": seed, **figures}


def measure_pair(pair: Pair, model: Path, progress: Progress) -> dict[str, Any]:
    """Return the marks of the mapping robot, and the poses of the other with and without them."""
    figures, kept = dict[str, int](), []
    for robot in (pair.mapper, pair.asker):
        assert isinstance(robot.drive, Drive)
        found = [moving_segments(robot.drive, each) for each in robot.recordings]
        if robot is pair.mapper:
            counts = [each.figures() for each in found]
            figures = {key: sum(each[key] for each in counts) for key in counts[0]}
        filtered = [
            without(recording, each.left_out)
            for recording, each in zip(robot.recordings, found, strict=True)
        ]
        kept.append(replace(robot, recordings=filtered))
    poses = {}
    tried = {"all": pair, "without moving": replace(pair, mapper=kept[0], asker=kept[1])}
    for name, each in tried.items():
        report, _ = evaluate(each, model, progress=progress)
        poses[name] = {key: report[key] for key in POSE_KEYS}
    return {**figures, "poses": poses}


def measure_moving(
    folder: Path,
    sensors: Sequence[str],
    seed: int,
    scans: int,
    oncoming: float,
    model: Path,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Return the report of `placecell bench moving`.

    Args:
        folder: folder for the simulated drives, which are replaced.
        sensors: names of the sensors, each in a town of its own.
        seed: seed of the first town; the others follow.
        scans: scans of each drive, 1 m apart.
        oncoming: number of oncoming cars per kilometer.
        model: folder of the model.
        progress: wraps the loops.
    """
    return {
        "scans": scans,
        "oncoming_per_km": oncoming,
        "rows": [
            measure_sensor(folder, name, seed + number, scans, oncoming, model, progress)
            for number, name in enumerate(sensors)
        ],
        "machine": machine(),
    }


def measure_moving_of_drive(
    drive: Path, model: Path, *, progress: Progress = silent
) -> dict[str, Any]:
    """Return the report of `placecell bench moving DRIVE`.

    Without labels, no view counts as moving or standing.

    Args:
        drive: folder or file of the drive.
        model: folder of the model.
        progress: wraps the loops.

    Raises:
        ValueError: the drive is too short for a second block.
    """
    pair = Pair.of(drive, progress=progress)
    row = {"sensor": pair.mapper.sensor, "drive": pair.mapper.drive.title}
    return {"rows": [row | measure_pair(pair, model, progress)], "machine": machine()}
