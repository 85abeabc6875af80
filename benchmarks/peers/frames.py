"""Map and queries of a comparison: the same local maps that our segmentation gets.

Peers that are made for larger local maps get those of the same stretches (`wide_maps.py`).
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.peers.exchange import MAP, NEAR, POSES, QUERIES, cloud_file, folder_of
from benchmarks.peers.wide_maps import WIDE, WideAccumulator, apart_from, traveled
from evaluation.poses.queries import MAPPED_METERS, spread
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Bool, Float32, Float64
from placecell.datasets import Drive
from placecell.segmentation.drive_splits import alternate_blocks, parameters_of
from placecell.segmentation.local_map import Accumulator, transform
from placecell.segmentation.pipeline import Progress, silent


@dataclass(frozen=True, slots=True)
class Stretch:
    """Scans of a drive from which local maps are made; no other scan contributes to them.

    Attributes:
        drive: the drive.
        scans: scans of the stretch.
        parameters: parameters of the local maps.
        to_map: transform (4, 4) from the drive's frame to the map's.
    """

    drive: Drive
    scans: range
    parameters: Parameters
    to_map: Float64

    @property
    def frames(self) -> range:
        """Return the scans that have a local map."""
        return self.scans[:: self.parameters.frame_step]


Frame = tuple[Stretch, int, Float64]
"""Stretch, scan of the local map, and pose (4, 4) of the local map in the drive's frame."""


def stretches_of_one(
    drive: Drive, radius: float | None = None
) -> tuple[list[Stretch], list[Stretch]]:
    """Split a drive into a map, its odd blocks, and queries, its even blocks.

    Args:
        drive: the drive.
        radius: radius of the local maps, meters; None: that of the protocol.

    Raises:
        ValueError: the drive is too short for a second block.
    """
    odd, even = alternate_blocks(drive)
    if not even:
        raise ValueError(
            f"{drive.folder}: the drive is too short for a second block. Use a longer drive."
        )
    parameters = parameters_of(odd + even, protocol_with_radius(radius).for_drive(len(drive)))

    def stretches(blocks: Iterable[range]) -> list[Stretch]:
        return [Stretch(drive, block, parameters, np.eye(4)) for block in blocks]

    return stretches(odd), stretches(even)


def stretches_of_two(
    mapped: Drive, asking: Drive, to_map: Float64, radius: float | None = None
) -> tuple[list[Stretch], list[Stretch]]:
    """Return one drive as the map and another drive as the queries.

    Args:
        mapped: drive of the map.
        asking: drive of the queries.
        to_map: true transform (4, 4) from the frame of the queries' drive to that of the map.
        radius: radius of the local maps, meters; None: that of the protocol.
    """

    def whole(drive: Drive, to_map: Float64) -> list[Stretch]:
        return [
            Stretch(
                drive, range(len(drive)), protocol_with_radius(radius).for_drive(len(drive)), to_map
            )
        ]

    return whole(mapped, np.eye(4)), whole(asking, to_map)


def protocol_with_radius(radius: float | None) -> Parameters:
    """Return protocol v1, with another radius of the local maps if one is given."""
    if radius is None:
        return PROTOCOL_V1
    reach = max(radius, PROTOCOL_V1.max_range)
    return replace(PROTOCOL_V1, protocol="v1, wider", local_map_radius=radius, max_range=reach)


def near_map(poses: Float64, truth: Float64) -> Bool:
    """Return which queries lie within 10 m of a local map of the map, bool (queries,)."""
    apart, _ = cKDTree(poses[:, :3, 3]).query(truth[:, :3, 3])
    return np.asarray(apart <= MAPPED_METERS)


def map_poses(stretches: Sequence[Stretch]) -> Float64:
    """Return the poses of the map's local maps, float64 (frames, 4, 4)."""
    return poses_of(frames_of(stretches))


def query_poses(stretches: Sequence[Stretch], most: int | None = None, seed: int = 0) -> Float64:
    """Return the true poses of the queries in the map's frame, float64 (queries, 4, 4).

    Args:
        stretches: stretches that make the queries.
        most: largest number of queries, spread evenly; None: all.
        seed: random seed of the headings.
    """
    return poses_of(frames_of(stretches, most, np.random.default_rng(seed)))


def poses_of(frames: Sequence[Frame]) -> Float64:
    """Return the poses of local maps in the map's frame, float64 (n, 4, 4)."""
    return np.stack([stretch.to_map @ pose for stretch, _, pose in frames])


def write_map(
    folder: Path,
    stretches: Sequence[Stretch],
    progress: Progress = silent,
    kinds: Iterable[str] = (NEAR,),
) -> None:
    """Write the files of the map, with local maps of some kinds."""
    frames = frames_of(stretches)
    for kind in kinds:
        some = frames if kind == NEAR else spaced(frames, WIDE[kind].apart)
        into = folder_of(folder, MAP, kind)
        write_frames(into, some, progress, local_maps(kind, ahead=True))
        np.save(into / POSES, poses_of(some))


def write_queries(
    folder: Path,
    stretches: Sequence[Stretch],
    most: int | None = None,
    seed: int = 0,
    progress: Progress = silent,
    kinds: Iterable[str] = (NEAR,),
) -> None:
    """Write the files of the queries, each rotated by a random angle about the vertical.

    On a street that is driven in one direction, a method that finds no rotation would otherwise
    look right.
    """
    frames = frames_of(stretches, most, np.random.default_rng(seed))
    for kind in kinds:
        into = folder_of(folder, QUERIES, kind)
        write_frames(into, frames, progress, local_maps(kind, ahead=False))


def frames_of(
    stretches: Sequence[Stretch],
    most: int | None = None,
    turning: np.random.Generator | None = None,
) -> list[Frame]:
    """Return the local maps of stretches in order, with random headings if `turning` is given."""
    frames = [(stretch, scan) for stretch in stretches for scan in stretch.frames]
    found = []
    for index in spread(len(frames), most):
        stretch, scan = frames[index]
        turn = turning.uniform(-np.pi, np.pi) if turning else 0.0
        found.append((stretch, scan, leveled(stretch.drive.poses[scan], turn)))
    return found


LocalMapOf = Callable[[Stretch, int], Float32]
"""Function of a stretch and a scan that returns a local map in the drive's frame."""


def local_maps(kind: str, *, ahead: bool) -> LocalMapOf:
    """Return the function of the local maps of a kind.

    Args:
        kind: kind of the local maps.
        ahead: whether wide local maps also hold scans after the capture.
    """
    open_at: tuple[Stretch, Callable[[int], Float32]] | None = None

    def local_map(stretch: Stretch, scan: int) -> Float32:
        nonlocal open_at
        if open_at is None or open_at[0] is not stretch:
            open_at = stretch, opened(stretch, kind, ahead=ahead)
        return open_at[1](scan)

    return local_map


def opened(stretch: Stretch, kind: str, *, ahead: bool) -> Callable[[int], Float32]:
    """Return the function of the local maps of one stretch, which reads each scan once."""
    if kind == NEAR:
        return Accumulator(stretch.drive, stretch.parameters, stretch.scans.start).local_map
    accumulator = WideAccumulator(stretch.drive, stretch.scans, WIDE[kind])
    return partial(accumulator.local_map, ahead=ahead)


def spaced(frames: Sequence[Frame], apart: float) -> list[Frame]:
    """Return frames of each stretch that are at least `apart` meters of travel from each other."""
    chosen: list[Frame] = []
    for _, group in groupby(frames, key=lambda frame: id(frame[0])):
        of_stretch = list(group)
        stretch = of_stretch[0][0]
        along = traveled(stretch.drive.poses)[[scan for _, scan, _ in of_stretch]]
        chosen += [of_stretch[index] for index in apart_from(along, apart)]
    return chosen


def write_frames(
    folder: Path, frames: Sequence[Frame], progress: Progress, local_map: LocalMapOf
) -> None:
    """Write local maps, each in a level frame with its origin at the sensor."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.npy"):
        old.unlink()
    for index in progress(range(len(frames)), len(frames), f"local maps, {folder.name}"):
        stretch, scan, pose = frames[index]
        to_frame = np.asarray(np.linalg.inv(pose), dtype=np.float64)
        np.save(cloud_file(folder, index), transform(to_frame, local_map(stretch, scan)))


def leveled(pose: Float64, turn: float = 0.0) -> Float64:
    """Return the level pose (4, 4) with the position and heading of a pose.

    Args:
        pose: the pose (4, 4).
        turn: angle to add to the heading, radians.
    """
    heading = np.arctan2(pose[1, 0], pose[0, 0]) + turn
    level = np.eye(4)
    level[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
    level[:3, 3] = pose[:3, 3]
    return level
