"""The map and the queries of a comparison: the local maps that our segments are cut from."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from bench.peers.exchange import MAP, POSES, QUERIES, cloud_file
from bench.pose_queries import MAPPED_METRES, spread
from segments.blocks import alternate_blocks
from segments.drives import Drive
from segments.extraction import Progress, silent
from segments.local_map import Accumulator, transform
from segments.parameters import PROTOCOL_V1, Parameters
from segments.types import Bool, Float64


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
    protocol = within(radius).for_drive(len(drive))
    parameters = protocol.for_block(min(map(len, odd + even)))

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
        return [Stretch(drive, range(len(drive)), within(radius).for_drive(len(drive)), to_map)]

    return whole(mapped, np.eye(4)), whole(asking, to_map)


def within(radius: float | None) -> Parameters:
    """Protocol v1, but for the radius of the local maps, if one is given."""
    if radius is None:
        return PROTOCOL_V1
    reach = max(radius, PROTOCOL_V1.max_range)
    return replace(PROTOCOL_V1, protocol="v1, wider", local_map_radius=radius, max_range=reach)


def near_map(poses: Float64, truth: Float64) -> Bool:
    """Which queries stand within 10 m of a frame of the map, bool (queries,)."""
    apart, _ = cKDTree(poses[:, :3, 3]).query(truth[:, :3, 3])
    return np.asarray(apart <= MAPPED_METRES)


def write_map(folder: Path, stretches: Sequence[Stretch], progress: Progress = silent) -> Float64:
    """The map as peers read it; poses of its frames, float64 (frames, 4, 4)."""
    poses = write_frames(folder / MAP, stretches, progress)
    np.save(folder / MAP / POSES, poses)
    return poses


def write_queries(
    folder: Path,
    stretches: Sequence[Stretch],
    most: int | None = None,
    seed: int = 0,
    progress: Progress = silent,
) -> Float64:
    """The queries as peers read them.

    Each is turned about the vertical by a random angle: on a street that is driven one way, a
    method that finds no turn at all would otherwise look right.

    Args:
        most: frames that are taken, spread evenly; all unless given.

    Returns:
        true poses of the queries in the map's frame, float64 (queries, 4, 4); no peer sees them.
    """
    turning = np.random.default_rng(seed)
    return write_frames(folder / QUERIES, stretches, progress, turning, most)


def write_frames(
    folder: Path,
    stretches: Sequence[Stretch],
    progress: Progress,
    turning: np.random.Generator | None = None,
    most: int | None = None,
) -> Float64:
    """Local maps of all frames, each about its sensor and level; returns their poses."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.npy"):
        old.unlink()
    frames = [(stretch, scan) for stretch in stretches for scan in stretch.frames]
    frames = [frames[index] for index in spread(len(frames), most)]
    poses = []
    accumulator: Accumulator | None = None
    for index in progress(range(len(frames)), len(frames), f"local maps, {folder.name}"):
        stretch, scan = frames[index]
        if accumulator is None or accumulator.first != stretch.scans.start:
            accumulator = Accumulator(stretch.drive, stretch.parameters, stretch.scans.start)
        turn = turning.uniform(-np.pi, np.pi) if turning else 0.0
        pose = upright(stretch.drive.poses[scan], turn)
        to_frame = np.asarray(np.linalg.inv(pose), dtype=np.float64)
        cloud = transform(to_frame, accumulator.local_map(scan))
        np.save(cloud_file(folder, index), cloud)
        poses.append(stretch.to_map @ pose)
    return np.stack(poses)


def upright(pose: Float64, turn: float = 0.0) -> Float64:
    """A pose (4, 4) with its place and its heading, turned on by an angle in radians; level."""
    heading = np.arctan2(pose[1, 0], pose[0, 0]) + turn
    level = np.eye(4)
    level[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
    level[:3, 3] = pose[:3, 3]
    return level
