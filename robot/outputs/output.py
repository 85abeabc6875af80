"""Interface of the outputs: what the agent reports while it runs."""

from collections.abc import Iterable
from typing import Protocol

from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus, Fix


class AgentOutput(Protocol):
    """Receiver of what the agent does; calls come one at a time, from the thread of the scans."""

    def scan(
        self, time: float, points: Float32, odom_pose: Float64, map_to_odom: MapToOdom | None
    ) -> None:
        """Receive a processed scan.

        Args:
            time: time of the scan, seconds.
            points: float32 (n, 3), meters, in the sensor's frame.
            odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
            map_to_odom: where the odometry frame lies in the map; None if it is not known.
        """

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Receive the segments around the robot at a keyframe, in the odometry frame.

        Args:
            time: time of the keyframe's scan, seconds.
            segments: the segments.
            ids: id of each segment, which it keeps while it grows, int64 (segments,).
        """

    def fix(self, fix: Fix) -> None:
        """Receive a fix, accepted or not."""

    def status(self, status: AgentStatus) -> None:
        """Receive a change of the state or of the link."""

    def close(self) -> None:
        """Receive the end of the run."""


class NoOutput:
    """Output that ignores everything; a base for outputs that need only some calls."""

    def scan(
        self, time: float, points: Float32, odom_pose: Float64, map_to_odom: MapToOdom | None
    ) -> None:
        """Ignore a scan."""

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Ignore segments."""

    def fix(self, fix: Fix) -> None:
        """Ignore a fix."""

    def status(self, status: AgentStatus) -> None:
        """Ignore a status."""

    def close(self) -> None:
        """Ignore the end."""


class OutputGroup:
    """Several outputs as one."""

    def __init__(self, outputs: Iterable[AgentOutput]) -> None:
        self.outputs = tuple(outputs)

    def scan(
        self, time: float, points: Float32, odom_pose: Float64, map_to_odom: MapToOdom | None
    ) -> None:
        """Pass a scan on."""
        for each in self.outputs:
            each.scan(time, points, odom_pose, map_to_odom)

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Pass segments on."""
        for each in self.outputs:
            each.segments(time, segments, ids)

    def fix(self, fix: Fix) -> None:
        """Pass a fix on."""
        for each in self.outputs:
            each.fix(fix)

    def status(self, status: AgentStatus) -> None:
        """Pass a status on."""
        for each in self.outputs:
            each.status(status)

    def close(self) -> None:
        """Close all outputs."""
        for each in self.outputs:
            each.close()
