"""From a drive to segments: the paper's preprocessing (III-A), step by step."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, UInt8
from placecell.datasets import Drive
from placecell.descriptors.voxels import voxelize
from placecell.segmentation.deduplication import keep_distinct
from placecell.segmentation.ground import is_ground
from placecell.segmentation.grouping import Grouper
from placecell.segmentation.local_map import Accumulator
from placecell.segmentation.recording import Recording
from placecell.segmentation.region_growing import segment_indices

Progress = Callable[[Iterable[int], int, str], Iterable[int]]
"""Wraps a loop to show its progress: (items, how many, what) -> the same items."""


def silent(items: Iterable[int], total: int, what: str) -> Iterable[int]:  # noqa: ARG001
    """Show nothing."""
    return items


def segment_map(local_map: Float32, parameters: Parameters) -> list[Float32]:
    """Segments of a local map, each float32 (n, 3): ground off, then region growing."""
    objects = local_map[~is_ground(local_map, parameters)]
    return [objects[indices] for indices in segment_indices(objects, parameters)]


def segment_captures(
    drive: Drive,
    parameters: Parameters,
    scans: range | None = None,
    progress: Progress = silent,
) -> Iterator[tuple[int, Segments]]:
    """Segments of each frame, every `parameters.frame_step`-th scan, in the world frame.

    Args:
        scans: of the drive, all unless given; no scan outside feeds a local map.
    """
    scans = range(len(drive)) if scans is None else scans
    captures = scans[:: parameters.frame_step]
    accumulator = Accumulator(drive, parameters, first=scans.start)
    for capture in progress(captures, len(captures), f"segments of {drive.folder.name}"):
        clouds = segment_map(accumulator.local_map(capture), parameters)
        sensor = drive.poses[capture, :3, 3]
        yield capture, Segments.of(clouds, np.tile(sensor, (len(clouds), 1)))


def record(
    drive: Drive,
    parameters: Parameters,
    scans: range | None = None,
    progress: Progress = silent,
) -> Recording:
    """All segments of a drive, or of some scans of it, grouped, duplicates marked as such.

    Args:
        parameters: with the `frame_step` to use (see `Parameters.for_drive`).
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
        drive.options.tell(f"{drive.folder}: {drive.told(read)}")
    segments = Segments.concatenate(parts)
    del parts  # Of a long drive they are gigabytes.
    group = np.concatenate(groups)
    return Recording(
        name=drive.folder.name,
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
    """Occupancy grids as bits, uint8 (segments, bytes); a batch at a time stands unpacked."""
    packed = [np.zeros((0, (int(np.prod(parameters.grid)) + 7) // 8), dtype=np.uint8)]
    for first in range(0, len(segments), batch):
        some = segments.take(np.arange(first, min(first + batch, len(segments))))
        occupancy, _ = voxelize(some, parameters)
        packed.append(np.packbits(occupancy.reshape(len(some), -1), axis=1))
    return np.concatenate(packed)
