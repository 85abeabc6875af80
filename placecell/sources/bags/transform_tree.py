"""The tree of coordinate frames in a bag's tf messages."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from placecell.core.types import Bool, Float64
from placecell.sources.bags.containers.bag import Bag
from placecell.sources.bags.pose_messages import TRANSFORMS, StampedPose, transforms
from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError
from placecell.trajectories.interpolation import interpolate
from placecell.trajectories.poses import of_quaternions

STILL = 1e-3
"""Largest change of a transform that counts as none: meters, and parts of a rotation matrix."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameEdge:
    """Transform between a frame and its parent.

    Attributes:
        parent: frame above.
        child: frame below.
        stamps: times, float64 (n,), seconds, ascending.
        poses: poses of the child in the parent, float64 (n, 4, 4).
        moves: whether the pose changes.
    """

    parent: str
    child: str
    stamps: Float64
    poses: Float64
    moves: bool

    def at(self, times: Float64) -> Float64:
        """Return the pose at times within the first and the last, float64 (k, 4, 4)."""
        if not self.moves or len(self.stamps) < 2:
            return np.tile(self.poses[-1], (len(times), 1, 1))
        return interpolate(times, self.stamps, self.poses)


@dataclass(frozen=True, slots=True)
class TransformTree:
    """Coordinate frames, each with the transform to its parent.

    Attributes:
        edges: by the child's name.
        remarks: what was odd about the transforms.
    """

    edges: dict[str, FrameEdge] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    @property
    def frames(self) -> set[str]:
        """Return the names of all frames."""
        return set(self.edges) | {edge.parent for edge in self.edges.values()}

    def chain(self, frame: str) -> list[FrameEdge]:
        """Return the edges from a frame up to the root.

        Raises:
            DriveError: the frames form a loop.
        """
        chain: list[FrameEdge] = []
        names = [frame]
        while (edge := self.edges.get(names[-1])) is not None:
            chain.append(edge)
            if edge.parent in names:
                raise DriveError(
                    f"The transforms of the bag form a loop: {' -> '.join([*names, edge.parent])}. "
                    "Expected a tree of frames. State the poses with --poses or --odometry TOPIC, "
                    "and the sensor's pose on the robot with --extrinsic"
                )
            names.append(edge.parent)
        return chain

    def between(self, base: str, frame: str) -> tuple[list[FrameEdge], list[FrameEdge]] | None:
        """Return the edges up from `base` and from `frame` to the frame that both have in common.

        None if they are not connected.

        Raises:
            DriveError: the frames form a loop.
        """
        up, down = self.chain(base), self.chain(frame)
        above = [base, *(edge.parent for edge in up)]
        names = [frame, *(edge.parent for edge in down)]
        for count, name in enumerate(names):
            if name in above:
                return up[: above.index(name)], down[:count]
        return None


def pose_of(edges: Sequence[FrameEdge]) -> Float64:
    """Return the pose of the lowest frame of a chain in the highest, (4, 4), at the last time."""
    pose = np.eye(4)
    for edge in edges:
        pose = edge.poses[-1] @ pose
    return pose


def valid(poses: Sequence[StampedPose]) -> tuple[Bool, Float64]:
    """Return which poses have finite numbers and a quaternion, bool (n,), and all values (n, 7)."""
    values = np.array([pose.values for pose in poses]).reshape(-1, 7)
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.linalg.norm(values[:, 3:], axis=1)
    usable = np.isfinite(values).all(axis=1) & np.isfinite(lengths) & (lengths > 1e-6)
    return usable, values


def read_transforms(bag: Bag) -> TransformTree:
    """Read all tf messages of a bag; damaged ones are left out."""
    found: dict[tuple[str, str], list[StampedPose]] = {}
    fixed: set[tuple[str, str]] = set()
    remarks = []
    damaged = 0
    for topic in bag.topics:
        if topic.type not in TRANSFORMS or topic.encoding not in ("ros1", "cdr"):
            continue
        for data in bag.contents(topic):
            try:
                for pose in transforms(Wire(data or b"", topic.encoding, str(bag.path))):
                    found.setdefault((pose.parent, pose.child), []).append(pose)
                    if topic.name.endswith("static"):
                        fixed.add((pose.parent, pose.child))
            except DriveError:
                damaged += 1
    if damaged:
        remarks.append(f"{bag.path}: {damaged} tf messages are damaged and left out")
    edges: dict[str, FrameEdge] = {}
    for (parent, child), poses in sorted(found.items(), key=lambda item: -len(item[1])):
        if parent == child or not child:
            remarks.append(f"{bag.path}: a transform from {parent!r} to {child!r} is left out")
            continue
        if child in edges:
            remarks.append(
                f"{bag.path}: the frame {child!r} has two parents in tf, {edges[child].parent!r} "
                f"and {parent!r}; the first one is used, because it has more transforms"
            )
            continue
        edge = edge_of(parent, child, poses, (parent, child) in fixed)
        if edge is None:
            remarks.append(
                f"{bag.path}: no transform from {parent!r} to {child!r} has finite numbers and a "
                "rotation; they are left out"
            )
        else:
            edges[child] = edge
    return TransformTree(edges, tuple(remarks))


def edge_of(parent: str, child: str, poses: Sequence[StampedPose], fixed: bool) -> FrameEdge | None:
    """Return the edge of all transforms between two frames; None if none is valid."""
    usable, values = valid(poses)
    if not usable.any():
        return None
    values = values[usable]
    stamps = np.array([pose.stamp_ns for pose in poses], np.int64)[usable]
    stamps, first = np.unique(stamps, return_index=True)
    transformed = of_quaternions(values[first, :3], values[first, 3:])
    moves = not fixed and bool(np.ptp(transformed, axis=0).max() > STILL)
    return FrameEdge(parent, child, stamps.astype(np.float64) * 1e-9, transformed, moves)


def moving(edges: Sequence[FrameEdge]) -> Iterator[int]:
    """Yield the position of each edge that moves."""
    for position, edge in enumerate(edges):
        if edge.moves:
            yield position
