"""Link to the service: calls for the agent, with errors that say whether to try again."""

from dataclasses import dataclass
from typing import Protocol

from placecell_client import MapCopy
from placecell_client.hints import Hints, SensorPose

from placecell.core.types import Float64, Int8, UInt8
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus, FixSource


class LinkError(Exception):
    """Failed call that may succeed later: the service cannot be reached, or is too busy.

    Attributes:
        retry_after: seconds that the service asks to wait; None if it does not.
        was_reached: whether the service answered.
    """

    def __init__(
        self, message: str, retry_after: float | None = None, was_reached: bool = False
    ) -> None:
        super().__init__(message)
        self.retry_after = retry_after
        self.was_reached = was_reached


class RefusedError(Exception):
    """Refused call: the same call would be refused again.

    Attributes:
        status: HTTP status.
        kind: kind of the problem, such as `unknown-map` or `other-frame`.
    """

    def __init__(self, message: str, status: int, kind: str) -> None:
        super().__init__(message)
        self.status = status
        self.kind = kind


@dataclass(frozen=True, slots=True, eq=False)
class FixRequest:
    """Request for the robot's pose.

    Attributes:
        time: time of the scan, seconds.
        meters: distance driven until the scan.
        odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
        part: number of jumps of the odometry frame before the scan.
        model_id: id of the model of the descriptors.
        codes: descriptors of the segments around the robot, int8 (n, code bytes).
        centroids: their centroids in the odometry frame, float64 (n, 3), meters.
        map: name of the map to search.
        session: id of the odometry frame; requests of one session support each other.
        classes: class of each segment, uint8 (n,); None if the model has no semantic head.
        ignore: classes of segments to leave out, in the map and in the request.
        heights: vertical sides of the segments' boxes, meters, float64 (n,); None if they are not
            known.
    """

    time: float
    meters: float
    odom_pose: Float64
    part: int
    model_id: str
    codes: Int8
    centroids: Float64
    map: str
    session: str
    classes: UInt8 | None = None
    ignore: tuple[str, ...] = ()
    heights: Float64 | None = None

    @property
    def hints(self) -> Hints:
        """Return the sensor's position, from which the sides of the segments are seen."""
        x, y, z = self.odom_pose[:3, 3].tolist()
        return Hints(sensor=SensorPose((x, y, z)))


@dataclass(frozen=True, slots=True, eq=False)
class FixAnswer:
    """Answer to a request.

    Attributes:
        request: the request.
        source: where the pose was computed.
        transform: transform from the odometry frame into the map, float64 (4, 4); None if the robot
            is not localized.
        covariance: covariance of the sensor's pose in the map, float64 (6, 6), or None.
        probability: probability that the best pose is right.
        reason: why there is no pose; empty if there is one.
    """

    request: FixRequest
    source: FixSource
    transform: Float64 | None
    covariance: Float64 | None
    probability: float
    reason: str


class Link(Protocol):
    """Calls to the service; each blocks, and raises `LinkError` or `RefusedError`."""

    def localize(self, request: FixRequest) -> FixAnswer:
        """Request the pose of the robot."""

    def upload(self, name: str, delta: bytes, robot: str, create: bool) -> None:
        """Store an edit in a map.

        Args:
            name: name of the map.
            delta: delta file.
            robot: robot whose segments the edit may remove. A delta file that only removes segments
                names none.
            create: create the map if it does not exist.
        """

    def pull(self, copy: MapCopy) -> MapCopy:
        """Update a copy of a map."""

    def report(self, robot: str, status: AgentStatus, pose: MapToOdom | None) -> None:
        """Report the pose and the state of the robot.

        Args:
            robot: name of the robot.
            status: state of the agent.
            pose: pose of the sensor in the map, as `transform`; None if it is not known.
        """

    def close(self) -> None:
        """Close the connections."""
