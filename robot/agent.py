"""The agent: turns scans and odometry into fixes in a map, and into edits of a map."""

import time
from collections.abc import Callable, Sequence

import numpy as np

from placecell.core.types import Float32, Float64
from robot.core.link import Link
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import AgentSettings
from robot.core.status import AgentStatus, Summary
from robot.outputs.output import AgentOutput, OutputGroup


class RobotAgent:
    """Agent of one robot. Give it each scan with the pose of the odometry, and close it.

        with Client("http://127.0.0.1:8000") as client:
            agent = RobotAgent(AgentSettings(map="yard"), ServiceLink(client))
            for points, time_s, odom_pose in scans:
                agent.on_scan(points, time_s, odom_pose)
                print(agent.status.state, agent.map_to_odom)
            print(agent.close())

    Calls come from one thread. The agent reads no clock but the one that is passed in, which only
    paces the link; times come with the scans.
    """

    def __init__(
        self,
        settings: AgentSettings,
        link: Link | None = None,
        outputs: Sequence[AgentOutput] = (),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Open the state folder.

        Args:
            settings: settings of the agent.
            link: link to the service; None: the robot never has one.
            outputs: receivers of poses, fixes, states and segments.
            clock: monotonic clock, seconds.
        """
        self.settings = settings
        self.status = AgentStatus(map=settings.searched_map)
        self.map_to_odom: MapToOdom | None = None
        self._link = link
        self._outputs = OutputGroup(outputs)
        self._clock = clock

    def on_scan(self, points: Float32, time_s: float, odom_pose: Float64) -> None:
        """Process a scan.

        Args:
            points: float32 (n, 3), meters, in the sensor's frame, deskewed.
            time_s: time of the scan, seconds.
            odom_pose: pose of the sensor in the odometry frame (z up), float64 (4, 4).
        """
        raise NotImplementedError

    def drop_scan(self) -> None:
        """Count a scan that came too late and is not processed."""
        raise NotImplementedError

    def on_initial_pose(self, map_pose: Float64, covariance: Float64) -> None:
        """Take a pose that a person gave as the pose of the robot at the last scan.

        Args:
            map_pose: pose of the sensor in the map, float64 (4, 4).
            covariance: covariance of x, y, z and the rotations about the map's axes, (6, 6).
        """
        raise NotImplementedError

    def localize_now(self) -> None:
        """Request a pose at the next scan, however near the last request was."""
        raise NotImplementedError

    def wait(self, seconds: float) -> bool:
        """Wait for the answer to the last request; return whether none is missing."""
        raise NotImplementedError

    def close(self) -> Summary:
        """Finish the uploads that the link allows, close the outputs, and return the summary."""
        raise NotImplementedError


def meters_between(before: Float64, after: Float64) -> float:
    """Return the distance between two poses, meters."""
    return float(np.linalg.norm(after[:3, 3] - before[:3, 3]))
