"""Interface of the outputs: what the agent reports while it runs."""

from collections.abc import Callable, Iterable
from contextlib import suppress
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
    """Several outputs as one. An output that cannot be written ends alone: the robot drives on."""

    def __init__(
        self, outputs: Iterable[AgentOutput], tell: Callable[[str], None] = lambda _: None
    ) -> None:
        """Combine outputs.

        Args:
            outputs: the outputs.
            tell: receives a line if an output ends early.
        """
        self.outputs = tuple(outputs)
        self._tell = tell

    def scan(
        self, time: float, points: Float32, odom_pose: Float64, map_to_odom: MapToOdom | None
    ) -> None:
        """Pass a scan on."""
        self._each(lambda output: output.scan(time, points, odom_pose, map_to_odom))

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Pass segments on."""
        self._each(lambda output: output.segments(time, segments, ids))

    def fix(self, fix: Fix) -> None:
        """Pass a fix on."""
        self._each(lambda output: output.fix(fix))

    def status(self, status: AgentStatus) -> None:
        """Pass a status on."""
        self._each(lambda output: output.status(status))

    def close(self) -> None:
        """Close all outputs."""
        self._each(lambda output: output.close())
        self.outputs = ()

    def _each(self, call: Callable[[AgentOutput], None]) -> None:
        for each in self.outputs:
            try:
                call(each)
            except OSError as error:
                self._end(each, error)

    def _end(self, output: AgentOutput, error: OSError) -> None:
        """Leave out an output that fails, such as one on a full disk."""
        self.outputs = tuple(each for each in self.outputs if each is not output)
        with suppress(OSError):
            output.close()
        name = getattr(output, "path", None) or type(output).__name__
        why = error.strerror or str(error) or type(error).__name__
        self._tell(f"{name} ends here, and the robot goes on: it cannot be written ({why})")
