"""Poses in a bag: odometry, poses, paths and tf."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.types import Float64
from placecell.sources.bags.containers.bag import Bag
from placecell.sources.bags.containers.container import BagTopic
from placecell.sources.bags.pose_messages import PATH, POSES, TRANSFORMS, StampedPose
from placecell.sources.bags.transform_tree import (
    FrameEdge,
    TransformTree,
    moving,
    pose_of,
    read_transforms,
    valid,
)
from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError
from placecell.trajectories.poses import of_quaternions
from placecell.trajectories.trajectory import Trajectory

STANDS = 0.1
"""Largest extent of positions that counts as standing, meters."""
BASES = ("base_link", "base_footprint", "base", "body", "vehicle", "ego_vehicle", "imu_link")
"""Usual names of the robot's frame, for messages that do not state whose poses they hold."""
KINDS = (*POSES, *TRANSFORMS)


@dataclass(frozen=True, slots=True, eq=False)
class Extrinsic:
    """Pose of a sensor on the robot.

    Attributes:
        transform: from the sensor's frame to the robot's, float64 (4, 4), meters.
        base: name of the robot's frame.
        sensor: name of the sensor's frame.
        found: whether the bag states it; the identity is assumed otherwise.
        how: where it was found, or why it was not.
    """

    transform: Float64
    base: str
    sensor: str
    found: bool
    how: str


@dataclass(frozen=True, slots=True, eq=False)
class BagPoses:
    """Poses of a bag.

    Attributes:
        body: poses of the frame that the messages state; None if the bag has none of use.
        extrinsic: pose of the sensor in that frame.
        remarks: what was chosen, and why.
    """

    body: Trajectory | None
    extrinsic: Extrinsic
    remarks: tuple[str, ...]

    @property
    def sensor(self) -> Trajectory | None:
        """Poses of the sensor, or those of the body if the sensor's pose on it is not known."""
        if self.body is None or not self.extrinsic.found:
            return self.body
        return replace(self.body.mounted(self.extrinsic.transform), frame=self.extrinsic.sensor)


def read_poses(
    bag: Bag,
    sensor: str = "",
    wanted: str | None = None,
    times: tuple[Float64, Float64] | None = None,
) -> BagPoses:
    """Read the poses of a bag.

    Without a wish, the order of preference is: topics whose times overlap with the scans'; the
    type (odometry, poses, tf, path); the number of messages. Poses that never move are not used.

    Args:
        bag: the bag.
        sensor: frame of the scans; "" if unknown.
        wanted: topic with the poses; `/tf` for the transforms.
        times: stamps and times of recording of the scans, float64 (scans,), seconds.

    Raises:
        DriveError: the topic has no poses, or the transforms form a loop.
    """
    tree = read_transforms(bag)
    candidates = [topic for topic in bag.topics if topic.type in POSES and len(topic)]
    names = [topic.name for topic in candidates] + ["/tf"] * bool(tree.edges)
    remarks = list(tree.remarks)
    if wanted is not None:
        body = wanted_poses(bag, tree, sensor, wanted, times, names)
        remarks += body.remarks
        if extent(body) < STANDS:
            remarks.append(f"{standing(bag, wanted, body)}; it is used because it was stated")
        return BagPoses(body, extrinsic(tree, body.frame, sensor), tuple(remarks))
    ranked: list[tuple[bool, int, int, str, Trajectory]] = []
    for topic in candidates:
        try:
            found = topic_poses(bag, topic, times)
        except DriveError as error:
            remarks.append(str(error))
            continue
        if extent(found) < STANDS:
            remarks.append(f"{standing(bag, topic.name, found)}, so it is not used")
            continue
        if found.stamps is None:  # A planner's path has no times.
            remarks.append(f"{bag.path}: the path {topic.name!r} has no times, so it is not used")
            continue
        rank = KINDS.index(topic.type) if topic.type != PATH else len(KINDS)
        ranked.append((not overlaps(found, times), rank, -len(found), topic.name, found))
    chain = tree_poses(tree, sensor) if tree.edges else None
    if chain is not None and extent(chain) >= STANDS:
        rank = KINDS.index(TRANSFORMS[0])
        ranked.append((not overlaps(chain, times), rank, -len(chain), "/tf", chain))
    if not ranked:
        return BagPoses(None, extrinsic(tree, "", sensor), tuple(remarks))
    ranked.sort(key=lambda each: each[:4])
    *_, name, body = ranked[0]
    others = [each[3] for each in ranked[1:]]
    more = f" Others: {', '.join(others)}. State another with --odometry" if others else ""
    world = f" in {body.world!r}" if body.world else ""
    whose = f" of {body.frame!r}" if body.frame else ""
    remarks.append(f"{bag.path}: poses{whose}{world} are read from the topic {name!r}.{more}")
    remarks += body.remarks
    return BagPoses(body, extrinsic(tree, body.frame, sensor), tuple(remarks))


def wanted_poses(
    bag: Bag,
    tree: TransformTree,
    sensor: str,
    wanted: str,
    times: tuple[Float64, Float64] | None,
    names: Sequence[str],
) -> Trajectory:
    """Return the poses of the topic that was stated.

    Raises:
        DriveError: it has none.
    """
    topic = bag.topic(wanted)
    if topic is not None and topic.type in POSES and len(topic):
        return topic_poses(bag, topic, times)
    if wanted.strip("/") == "tf" or (topic is not None and topic.type in TRANSFORMS):
        found = tree_poses(tree, sensor)
        if found is not None:
            return found
        frames = ", ".join(sorted(tree.frames)[:20]) or "none"
        raise DriveError(
            f"{bag.path}: the transforms have no moving chain of frames to the sensor's frame "
            f"{sensor!r}. Frames: {frames}. State a topic with poses: "
            f"{', '.join(name for name in names if name != '/tf') or 'the bag has none'}"
        )
    kind = f"has messages of type {topic.type}" if topic is not None else "is not in the bag"
    raise DriveError(
        f"{bag.path}: the topic {wanted!r} {kind}; expected poses (nav_msgs/Odometry, "
        "geometry_msgs/PoseStamped, PoseWithCovarianceStamped or TransformStamped, nav_msgs/Path, "
        f"tf). Topics with poses: {', '.join(names) or 'none'}"
    )


def topic_messages(bag: Bag, topic: BagTopic) -> Iterator[tuple[int, list[StampedPose]]]:
    """Yield time of recording and poses of each message; damaged ones are passed over.

    Messages of a path repeat it so far, so only the last one counts.

    Raises:
        DriveError: all messages are damaged.
    """
    error: DriveError | None = None
    read = 0
    last_first = topic.type == PATH
    messages: Iterable[tuple[int, bytes | memoryview | None]] = (
        ((index, None) for index in reversed(range(len(topic))))
        if last_first
        else enumerate(bag.contents(topic))
    )
    for index, data in messages:
        try:
            content = bag.read(topic, index) if data is None else data
            poses = list(POSES[topic.type](Wire(content, topic.encoding, bag.where(topic, index))))
        except DriveError as damage:
            error = error or damage
            continue
        read += 1
        yield int(topic.times[index]), poses
        if last_first:
            return
    if error and not read:
        raise error


def topic_poses(
    bag: Bag, topic: BagTopic, times: tuple[Float64, Float64] | None = None
) -> Trajectory:
    """Read the poses of a topic; poses with invalid numbers are left out.

    Raises:
        DriveError: no pose can be read.
    """
    if topic.encoding not in ("ros1", "cdr"):
        raise DriveError(
            f"{bag.path}: the topic {topic.name!r} is encoded as {topic.encoding!r}; expected "
            "'ros1' or 'cdr'. Give the poses as a file with --poses"
        )
    messages = list(topic_messages(bag, topic))
    poses = [pose for _, each in messages for pose in each]
    recorded = np.array([time for time, each in messages for _ in each], np.int64)
    usable, values = valid(poses)
    if not usable.any():
        raise DriveError(
            f"{bag.path}: no message of the topic {topic.name!r} has a pose with finite numbers "
            "and a rotation. Record it again, or give the poses as a file with --poses"
        )
    remarks = []
    if not usable.all():
        remarks.append(
            f"{bag.path}: {int((~usable).sum())} of {len(usable)} poses of {topic.name!r} have no "
            "finite numbers or no rotation; they are left out"
        )
    stamps_ns = np.array([pose.stamp_ns for pose in poses], np.int64)[usable]
    recorded = recorded[usable]
    one = len(np.unique(stamps_ns)) == 1 and len(stamps_ns) > 1
    transforms = of_quaternions(values[usable, :3], values[usable, 3:])
    first = poses[int(np.flatnonzero(usable)[0])]
    if one and topic.type == PATH:
        return Trajectory(transforms, None, first.child, first.parent, tuple(remarks))
    if one or not stamps_ns.all():
        remarks.append(
            f"{bag.path}: the headers of {topic.name!r} have no times; the times of recording are "
            "used"
        )
        stamps_ns = recorded
    recorded_s = recorded.astype(np.float64) * 1e-9
    stamps = stamps_ns.astype(np.float64) * 1e-9
    if times is not None and topic.type != PATH:
        shift = clock_shift(stamps, recorded_s, *times)
        if shift:
            remarks.append(
                f"{bag.path}: the clock of {topic.name!r} is {-shift:+.3f} s off the clouds' "
                "clock; both are compared by the times of recording"
            )
            stamps = stamps + shift
    stamps, index = np.unique(stamps, return_index=True)
    stated = [each.covariance for each in poses if each.covariance is not None]
    return Trajectory(
        transforms[index],
        stamps,
        first.child,
        first.parent,
        tuple(remarks),
        np.stack(stated)[usable][index] if len(stated) == len(poses) else None,
    )


def clock_shift(
    stamps: Float64, recorded: Float64, scans: Float64, scans_recorded: Float64
) -> float:
    """Return the seconds to add to stamps of another clock than the scans'; 0 if it is the same.

    The clocks differ if the stamps do not overlap with the scans', but the times of recording do.
    """
    if not len(scans) or overlap(stamps, scans) or not overlap(recorded, scans_recorded):
        return 0.0
    return float(np.median(recorded - stamps) - np.median(scans_recorded - scans))


def overlap(one: Float64, other: Float64) -> bool:
    """Return whether two ranges of times overlap."""
    return bool(one.min() <= other.max() and other.min() <= one.max())


def overlaps(trajectory: Trajectory, times: tuple[Float64, Float64] | None) -> bool:
    """Return whether a trajectory's times overlap with those of the scans, as far as known."""
    if trajectory.stamps is None or times is None or not len(times[0]):
        return True
    return overlap(trajectory.stamps, times[0])


def extent(trajectory: Trajectory) -> float:
    """Return the largest extent of the positions along an axis, meters."""
    return float(np.ptp(trajectory.poses[:, :3, 3], axis=0).max())


def standing(bag: Bag, name: str, trajectory: Trajectory) -> str:
    """Return the remark on poses that never move."""
    return (
        f"{bag.path}: the poses of {name!r} never move ({len(trajectory)} poses within "
        f"{extent(trajectory):.3f} m)"
    )


def tree_poses(tree: TransformTree, sensor: str) -> Trajectory | None:
    """Return the poses of the robot from the transforms; None if no frame moves.

    The chain leads from the sensor's frame up to the highest frame below which something moves,
    such as `map`. The robot's frame is the lowest one that moves.

    Raises:
        DriveError: the frames form a loop.
    """
    start = (
        sensor
        if sensor in tree.frames
        else next((name for name in BASES if name in tree.frames), "")
    )
    chain = tree.chain(start)
    moves = list(moving(chain))
    if not moves:
        return None
    edges = chain[moves[0] : moves[-1] + 1]
    dynamic = [chain[position] for position in moves]
    begin = max(edge.stamps[0] for edge in dynamic)
    end = min(edge.stamps[-1] for edge in dynamic)
    finest = max(dynamic, key=lambda edge: len(edge.stamps))
    stamps = finest.stamps[(finest.stamps >= begin) & (finest.stamps <= end)]
    if len(stamps) < 2:
        return None
    poses = np.tile(np.eye(4), (len(stamps), 1, 1))
    for edge in edges:
        poses = edge.at(stamps) @ poses
    names = [edges[0].child, *(edge.parent for edge in edges)]
    remark = f"The chain of transforms is {' <- '.join(reversed(names))}"
    return Trajectory(poses, stamps, edges[0].child, edges[-1].parent, (remark,))


def extrinsic(tree: TransformTree, base: str, sensor: str) -> Extrinsic:
    """Find the pose of the sensor on the robot in the transforms.

    Args:
        tree: the transforms.
        base: frame of the poses; "" if the messages do not state it.
        sensor: frame of the scans.

    Raises:
        DriveError: the frames form a loop.
    """
    assumed = ""
    if not base:
        base = next((name for name in BASES if name in tree.frames), "")
        assumed = f" (the messages do not state their frame; {base!r} is assumed)" if base else ""
    none = Extrinsic(np.eye(4), base, sensor, False, "")
    if not sensor:
        return replace(none, how="identity: the clouds do not state their frame")
    if not base:
        return replace(none, how="identity: the poses do not state their frame")
    if base == sensor:
        return replace(
            none, found=True, how=f"identity: the poses are those of {sensor!r}{assumed}"
        )
    edges = tree.between(base, sensor)
    if edges is None:
        return replace(
            none,
            how=f"identity: the bag has no transform from {base!r} to {sensor!r}{assumed}. State "
            "it with --extrinsic, if the sensor is mounted elsewhere",
        )
    joints = [edge for edge in (*edges[0], *edges[1]) if edge.moves]
    if joints:
        return replace(
            none,
            how=f"identity: the transform from {base!r} to {sensor!r} changes at the joint "
            f"{joints[0].child!r}{assumed}. State it with --extrinsic",
        )
    transform = np.linalg.inv(pose_of(edges[0])) @ pose_of(edges[1])
    return replace(
        none, transform=transform, found=True, how=f"tf: {path_text(base, *edges)}{assumed}"
    )


def path_text(base: str, up: Sequence[FrameEdge], down: Sequence[FrameEdge]) -> str:
    """Return the frames from the robot's to the sensor's, as text."""
    names = [base, *(edge.parent for edge in up), *(edge.child for edge in reversed(down))]
    return " -> ".join(names)
