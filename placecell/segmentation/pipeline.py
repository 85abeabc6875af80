"""Segmentation pipeline: the paper's preprocessing (III-A) from a drive to grouped segments."""

from collections.abc import Iterator

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.progress import Progress, silent
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Int64, UInt8
from placecell.datasets import Drive
from placecell.descriptors.voxels import voxelize
from placecell.segmentation.ceiling import is_overhead
from placecell.segmentation.deduplication import keep_distinct
from placecell.segmentation.ground import HeightGrid, is_ground
from placecell.segmentation.grouping import Grouper
from placecell.segmentation.local_map import Accumulator
from placecell.segmentation.recording import Recording
from placecell.segmentation.region_growing import segment_indices

__all__ = [
    "Progress",
    "packed_grids",
    "record",
    "segment_captures",
    "segment_map",
    "segment_rows",
    "silent",
]


def segment_map(local_map: Float32, parameters: Parameters) -> list[Float32]:
    """Remove ground and ceiling of a local map and return its segments, float32 (n, 3) each.

    Args:
        local_map: float32 (n, 3), meters, world frame.
        parameters: parameters of ground removal, ceiling removal and region growing.
    """
    return [local_map[rows] for rows in segment_rows(local_map, parameters)[0]]


def segment_rows(local_map: Float32, parameters: Parameters) -> tuple[list[Int64], Bool]:
    """Return the rows of each segment's points in a local map, and whether each row is ground.

    Args:
        local_map: float32 (n, 3), meters, world frame.
        parameters: parameters of ground removal, ceiling removal and region growing.
    """
    ground, overhead = ground_and_overhead(local_map, parameters)
    objects = np.flatnonzero(~(ground | overhead))
    regions = segment_indices(local_map[objects], parameters)
    return [objects[indices] for indices in regions], ground


def ground_and_overhead(local_map: Float32, parameters: Parameters) -> tuple[Bool, Bool]:
    """Return whether each point of a local map is ground, and whether it is overhead, bool (n,).

    Args:
        local_map: float32 (n, 3), meters, world frame.
        parameters: parameters of ground removal and ceiling removal.
    """
    grid = HeightGrid.of(local_map, parameters) if len(local_map) else None
    return is_ground(local_map, parameters, grid), is_overhead(local_map, parameters, grid)


def segment_captures(
    drive: Drive,
    parameters: Parameters,
    scans: range | None = None,
    progress: Progress = silent,
) -> Iterator[tuple[int, Segments]]:
    """Yield the scan index and the segments of each capture, in the world frame.

    Every `parameters.frame_step`-th scan is a capture.

    Args:
        drive: drive to read.
        parameters: parameters of the segmentation.
        scans: scans to use, also for local maps; None for all.
        progress: function that shows the progress.
    """
    scans = range(len(drive)) if scans is None else scans
    captures = scans[:: parameters.frame_step]
    accumulator = Accumulator(drive, parameters, first=scans.start)
    for capture in progress(captures, len(captures), f"segments of {drive.title}"):
        clouds = segment_map(accumulator.local_map(capture), parameters)
        sensor = drive.poses[capture, :3, 3]
        yield capture, Segments.of(clouds, np.tile(sensor, (len(clouds), 1)))


def record(
    drive: Drive,
    parameters: Parameters,
    scans: range | None = None,
    progress: Progress = silent,
) -> Recording:
    """Record all segments of a drive, or of some of its scans, with groups and duplicates.

    Args:
        drive: drive to read.
        parameters: parameters of the segmentation (see `Parameters.for_drive`).
        scans: scans to use; None for all.
        progress: function that shows the progress.

    Raises:
        DriveError: Most scans cannot be used, or one cannot and the options are strict.
    """
    grouper = Grouper(parameters.d_same)
    captures, parts, groups = [], [], []
    for capture, some in segment_captures(drive, parameters, scans, progress):
        captures.append(np.full(len(some), capture, dtype=np.int64))
        parts.append(some)
        groups.append(grouper.add_capture(some.centroids()))
    read = range(len(drive)) if scans is None else scans
    drive.check_usable(read)
    skipped, dropped = drive.dropouts.within(read)
    if skipped or dropped:
        drive.options.tell(f"{drive.folder}: {drive.summary(read)}")
    segments = Segments.concatenate(parts)
    del parts  # They are gigabytes for a long drive.
    group = np.concatenate(groups)
    return Recording(
        name=drive.title,
        parameters=parameters,
        segments=segments,
        captures=np.concatenate(captures),
        groups=group,
        distinct=keep_distinct(packed_grids(segments, parameters), group, parameters.th_H),
        scans=len(drive),
        scan_hashes=tuple(drive.scan_hash(index) for index in range(len(drive))),
        path_length=drive.path_length(),
        part=scans,
        skipped_scans=skipped,
        dropped_points=dropped,
    )


def packed_grids(segments: Segments, parameters: Parameters, batch: int = 1000) -> UInt8:
    """Return occupancy grids as bits, uint8 (segments, bytes), computed batch by batch."""
    packed = [np.zeros((0, (int(np.prod(parameters.grid)) + 7) // 8), dtype=np.uint8)]
    for first in range(0, len(segments), batch):
        some = segments.take(np.arange(first, min(first + batch, len(segments))))
        occupancy, _ = voxelize(some, parameters)
        packed.append(np.packbits(occupancy.reshape(len(some), -1), axis=1))
    return np.concatenate(packed)
