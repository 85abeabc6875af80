"""Labels of segments: the class of most of their points, from labels of the drive's points.

A segment's points are the means of the local map's voxels. So each voxel takes the most common
class of the labeled points in it, and each segment the most common class of its voxels.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from placecell.core.progress import Progress, silent
from placecell.core.types import Bool, Float32, Int64, UInt8
from placecell.datasets.drive import Drive
from placecell.datasets.labels import CODES, NO_CLASS, class_of_code, read_codes
from placecell.segmentation.local_map import transform
from placecell.segmentation.recording import Recording

HALF = 1 << 20
"""Largest number of voxels from the origin along an axis."""


class LabeledVoxels(NamedTuple):
    """Points of one scan.

    Attributes:
        keys: int64 (n,), voxel of each point.
        classes: uint8 (n,), class index of each point.
    """

    keys: Int64
    classes: UInt8


def segment_classes(drive: Drive, recording: Recording, progress: Progress = silent) -> UInt8:
    """Return the class index of each segment, uint8 (segments,); `NO_CLASS` without labels.

    Args:
        drive: drive with labels (`placecell.datasets.labels`).
        recording: its segments.
        progress: function that shows the progress.
    """
    parameters = recording.parameters
    table = class_of_code()
    window: deque[LabeledVoxels] = deque(maxlen=parameters.accumulated_scans)
    found = np.full(len(recording.segments), NO_CLASS, dtype=np.uint8)
    captures = set(recording.capture_scans)
    scans = range(len(drive)) if recording.part is None else recording.part
    owners = recording.segments.owners
    ends = np.searchsorted(recording.captures, np.arange(scans.start, scans.stop + 1))
    for place, scan in enumerate(progress(scans, len(scans), f"labels of {drive.title}")):
        points = drive.scan(scan)
        codes = read_codes(drive, scan) if len(points) else np.zeros(0, np.uint16)
        classes = table[codes]
        world = transform(drive.poses[scan], points)
        labeled = (classes != NO_CLASS) & near(points, parameters.max_range)
        window.append(
            LabeledVoxels(voxel_keys(world[labeled], parameters.map_voxel), classes[labeled])
        )
        first, end = int(ends[place]), int(ends[place + 1])
        if scan not in captures or first == end:
            continue
        starts = recording.segments.starts
        rows = slice(int(starts[first]), int(recording.segments.ends[end - 1]))
        voxels = voxel_keys(recording.segments.points[rows], parameters.map_voxel)
        found[first:end] = majority(
            voxel_classes(voxels, window), owners[rows] - first, end - first
        )
    return found


def near(points: Float32, reach: float) -> Bool:
    """Return which points are within reach of the sensor, bool (n,)."""
    return np.asarray(np.einsum("ij,ij->i", points, points) <= reach**2)


def voxel_keys(points: Float32, voxel: float) -> Int64:
    """Return the voxel of each point as one number, int64 (n,)."""
    cells = np.floor(points / np.float32(voxel)).astype(np.int64).clip(-HALF, HALF - 1) + HALF
    return np.asarray((cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2])


def voxel_classes(voxels: Int64, scans: "deque[LabeledVoxels]") -> UInt8:
    """Return the most common class of the labeled points in each voxel, uint8 (n,)."""
    distinct, which = np.unique(voxels, return_inverse=True)
    votes = np.zeros(len(distinct) * len(CODES), dtype=np.int64)
    for keys, classes in scans:
        places = np.searchsorted(distinct, keys).clip(max=len(distinct) - 1)
        hit = distinct[places] == keys
        votes += np.bincount(places[hit] * len(CODES) + classes[hit], minlength=len(votes))
    counts = votes.reshape(-1, len(CODES))
    best = np.where(counts.any(axis=1), counts.argmax(axis=1), NO_CLASS)
    return best[which].astype(np.uint8)


def majority(classes: UInt8, owners: Int64, count: int) -> UInt8:
    """Return the most common class of each owner, uint8 (count,).

    Points without a class count as a class of their own: if they are the most, the owner has none.

    Args:
        classes: class index of each point, uint8 (n,).
        owners: owner of each point, int64 (n,), 0 to `count` - 1.
        count: number of owners.
    """
    last = len(CODES)
    votes = np.zeros((count, last + 1), dtype=np.int64)
    np.add.at(votes, (owners, np.minimum(classes, last)), 1)
    best = votes.argmax(axis=1)
    return np.where(best == last, NO_CLASS, best).astype(np.uint8)
