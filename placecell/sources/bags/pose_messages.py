"""Messages with poses and transforms."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from placecell.core.types import Float64
from placecell.sources.bags.wire import Wire
from placecell.trajectories.covariance import stated_covariance


@dataclass(frozen=True, slots=True, eq=False)
class StampedPose:
    """Pose of a frame in another one.

    Attributes:
        stamp_ns: time, nanoseconds; 0 if the driver did not set it.
        parent: frame that the pose leads to.
        child: frame whose pose it is; "" if the message does not state it.
        values: x, y, z, and quaternion x, y, z, w: float64 (7,).
        covariance: covariance of x, y, z and the rotations about the parent's axes, float64 (6, 6);
            None if the message states none of use.
    """

    stamp_ns: int
    parent: str
    child: str
    values: Float64
    covariance: Float64 | None = None


def frame_name(text: str) -> str:
    """Return a frame's name without the leading slash of the old tf."""
    return text.strip().lstrip("/")


def odometry(wire: Wire) -> Iterator[StampedPose]:
    """Read a nav_msgs/Odometry."""
    found = next(transform_stamped(wire))
    yield replace(found, covariance=stated_covariance(wire.doubles(36)))


def pose_stamped(wire: Wire) -> Iterator[StampedPose]:
    """Read a geometry_msgs/PoseStamped or PoseWithCovarianceStamped."""
    stamp, parent = wire.header()
    yield StampedPose(stamp, parent, "", wire.doubles(7))


def path(wire: Wire) -> Iterator[StampedPose]:
    """Read a nav_msgs/Path."""
    _, parent = wire.header()
    for each in wire.sequence(lambda: next(pose_stamped(wire)), 64):
        yield StampedPose(each.stamp_ns, each.parent or parent, "", each.values)


def transform_stamped(wire: Wire) -> Iterator[StampedPose]:
    """Read a geometry_msgs/TransformStamped."""
    stamp, parent = wire.header()
    child = frame_name(wire.string())
    yield StampedPose(stamp, parent, child, wire.doubles(7))


def transforms(wire: Wire) -> Iterator[StampedPose]:
    """Read a tf2_msgs/TFMessage or tf/tfMessage."""
    yield from wire.sequence(lambda: next(transform_stamped(wire)), 64)


POSES: dict[str, Callable[[Wire], Iterator[StampedPose]]] = {
    "nav_msgs/Odometry": odometry,
    "geometry_msgs/PoseStamped": pose_stamped,
    "geometry_msgs/PoseWithCovarianceStamped": pose_stamped,
    "geometry_msgs/TransformStamped": transform_stamped,
    "nav_msgs/Path": path,
}
"""Reader of each type of message with poses, best first."""
TRANSFORMS = ("tf2_msgs/TFMessage", "tf/tfMessage", "tf2_msgs/tfMessage")
PATH = "nav_msgs/Path"
