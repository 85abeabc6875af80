"""The map and the queries of a comparison: the local maps that our segments are cut from."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.peers.exchange import MAP, POSES, QUERIES, cloud_file
from evaluation.poses.queries import MAPPED_METERS, spread
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Bool, Float64
from placecell.datasets import Drive
from placecell.segmentation.drive_splits import alternate_blocks, parameters_of
from placecell.segmentation.local_map import Accumulator, transform
from placecell.segmentation.pipeline import Progress, silent


@dataclass(frozen=True, slots=True)
class Stretch:
    """Scans of a drive that make local maps; none outside feeds them.

    Attributes:
        drive: whose scans.
        scans: which of them.
        parameters: how local maps are made, and which scans are frames.
        to_map: transform (4, 4) from the drive's world to the map's.
    """

    drive: Drive
    scans: range
    parameters: Parameters
    to_map: Float64

    @property
    def frames(self) -> range:
        """Scans that have a local map."""
        return self.scans[:: self.parameters.frame_step]


Frame = tuple[Stretch, int, Float64]
"""A stretch, the scan of its local map, and that one's pose (4, 4) in the drive's world."""


def stretches_of_one(
    drive: Drive, radius: float | None = None
) -> tuple[list[Stretch], list[Stretch]]:
    """A drive as map and query: its odd blocks and its even ones.

    Args:
        radius: of the local maps, metres; the protocol's unless given.

    Raises:
        ValueError: the drive stands still, so that it has no second block.
    """
    odd, even = alternate_blocks(drive)
    if not even:
        raise ValueError(f"{drive.folder}: stands still; there is no second block to ask from")
    parameters = parameters_of(odd + even, protocol_with_radius(radius).for_drive(len(drive)))

    def stretches(blocks: Iterable[range]) -> list[Stretch]:
        return [Stretch(drive, block, parameters, np.eye(4)) for block in blocks]

    return stretches(odd), stretches(even)


def stretches_of_two(
    mapped: Drive, asking: Drive, to_map: Float64, radius: float | None = None
) -> tuple[list[Stretch], list[Stretch]]:
    """One drive as the map, another one as the queries.

    Args:
        to_map: true transform (4, 4) from the asking drive's world to the mapped one's.
        radius: of the local maps, metres; the protocol's unless given.
    """

    def whole(drive: Drive, to_map: Float64) -> list[Stretch]:
        return [
            Stretch(
                drive, range(len(drive)), protocol_with_radius(radius).for_drive(len(drive)), to_map
            )
        ]

    return whole(mapped, np.eye(4)), whole(asking, to_map)


def protocol_with_radius(radius: float | None) -> Parameters:
    """Protocol v1, but for the radius of the local maps, if one is given."""
    if radius is None:
        return PROTOCOL_V1
    reach = max(radius, PROTOCOL_V1.max_range)
    return replace(PROTOCOL_V1, protocol="v1, wider", local_map_radius=radius, max_range=reach)


def near_map(poses: Float64, truth: Float64) -> Bool:
    """Which queries stand within 10 m of a frame of the map, bool (queries,)."""
    apart, _ = cKDTree(poses[:, :3, 3]).query(truth[:, :3, 3])
    return np.asarray(apart <= MAPPED_METERS)


def map_poses(stretches: Sequence[Stretch]) -> Float64:
    """Poses of the map's frames, float64 (frames, 4, 4)."""
    return poses_of(frames_of(stretches))


def query_poses(stretches: Sequence[Stretch], most: int | None = None, seed: int = 0) -> Float64:
    """True poses of the queries in the map's frame, float64 (queries, 4, 4); no peer sees them.

    Args:
        most: frames that are taken, spread evenly; all unless given.
        seed: of their headings.
    """
    return poses_of(frames_of(stretches, most, np.random.default_rng(seed)))


def poses_of(frames: Sequence[Frame]) -> Float64:
    """Of frames, in the map's frame, float64 (n, 4, 4)."""
    return np.stack([stretch.to_map @ pose for stretch, _, pose in frames])


def write_map(folder: Path, stretches: Sequence[Stretch], progress: Progress = silent) -> None:
    """The map as peers read it."""
    frames = frames_of(stretches)
    write_frames(folder / MAP, frames, progress)
    np.save(folder / MAP / POSES, poses_of(frames))


def write_queries(
    folder: Path,
    stretches: Sequence[Stretch],
    most: int | None = None,
    seed: int = 0,
    progress: Progress = silent,
) -> None:
    """The queries as peers read them.

    Each is turned about the vertical by a random angle: on a street that is driven one way, a
    method that finds no turn at all would otherwise look right.
    """
    write_frames(
        folder / QUERIES, frames_of(stretches, most, np.random.default_rng(seed)), progress
    )


def frames_of(
    stretches: Sequence[Stretch],
    most: int | None = None,
    turning: np.random.Generator | None = None,
) -> list[Frame]:
    """Frames in order; headings turned by random angles, if there is a generator of them."""
    frames = [(stretch, scan) for stretch in stretches for scan in stretch.frames]
    found = []
    for index in spread(len(frames), most):
        stretch, scan = frames[index]
        turn = turning.uniform(-np.pi, np.pi) if turning else 0.0
        found.append((stretch, scan, leveled(stretch.drive.poses[scan], turn)))
    return found


def write_frames(folder: Path, frames: Sequence[Frame], progress: Progress) -> None:
    """Local maps of frames, each about its sensor and level."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.npy"):
        old.unlink()
    accumulator: Accumulator | None = None
    for index in progress(range(len(frames)), len(frames), f"local maps, {folder.name}"):
        stretch, scan, pose = frames[index]
        if accumulator is None or accumulator.first != stretch.scans.start:
            accumulator = Accumulator(stretch.drive, stretch.parameters, stretch.scans.start)
        to_frame = np.asarray(np.linalg.inv(pose), dtype=np.float64)
        np.save(cloud_file(folder, index), transform(to_frame, accumulator.local_map(scan)))


def leveled(pose: Float64, turn: float = 0.0) -> Float64:
    """A pose (4, 4) with its place and its heading, turned on by an angle in radians; level."""
    heading = np.arctan2(pose[1, 0], pose[0, 0]) + turn
    level = np.eye(4)
    level[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
    level[:3, 3] = pose[:3, 3]
    return level
