"""The node: messages in, the agent in the middle, messages out.

A middleware calls the `on_...` methods from its own threads. One thread calls `step` or `run`, and
only this thread calls the agent.
"""

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.odometry.deskew import deskew
from placecell.sources.bags.pointcloud2 import PointCloud2, decode
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import silent
from placecell.trajectories.covariance import mounted
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import AgentSettings
from robot.core.status import AgentStatus
from robot.node.diagnostics import diagnostic_of
from robot.node.frames import StaticFrames
from robot.node.messages import CertainPose, NodePublisher, StampedTransform
from robot.node.odometry_buffer import OdometryBuffer
from robot.node.scan_queue import PairedScan, ScanQueue, WaitingScan
from robot.node.settings import NodeSettings
from robot.node.sweep_clock import SweepClock


class NodeAgent(Protocol):
    """Agent as the node uses it; `robot.agent.RobotAgent` is one."""

    settings: AgentSettings
    status: AgentStatus
    map_to_odom: MapToOdom | None
    messages: list[str]

    def on_scan(
        self,
        points: Float32,
        time_s: float,
        odom_pose: Float64,
        odom_covariance: Float64 | None = None,
    ) -> None:
        """Process a scan."""

    def drop_scan(self) -> None:
        """Count a scan that came too late and is not processed."""

    def on_initial_pose(self, map_pose: Float64, covariance: Float64) -> None:
        """Take a pose that a person gave."""

    def localize_now(self) -> None:
        """Request a pose at the next scan."""


class RobotNode:
    """Node of a robot: runs the agent on what a middleware receives."""

    def __init__(
        self,
        agent: NodeAgent,
        publisher: NodePublisher,
        settings: NodeSettings | None = None,
        tell: Callable[[str], None] = silent,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Create the node; nothing runs before `step` or `run`.

        Args:
            agent: the agent.
            publisher: receiver of transforms, poses and diagnostics.
            settings: settings of the node.
            tell: receives the agent's lines for the user.
            clock: monotonic clock, seconds.
        """
        self.settings = settings or NodeSettings()
        self._agent = agent
        self._publisher = publisher
        self._tell = tell
        self._clock = clock
        self._changed = threading.Condition()
        self._odometry = OdometryBuffer()
        self._frames = StaticFrames()
        self._queue = ScanQueue(self.settings.queue, self.settings.odometry_wait)
        self._calls: deque[Callable[[], None]] = deque()
        self._sweep = SweepClock()
        self._mount: Float64 | None = self.settings.mount
        self._map_to_odom: MapToOdom | None = None
        self._last_cloud: PointCloud2 | None = None
        self._sent_transform_ns = 0
        self._heard_cloud = self._heard_odometry = clock()
        self._reported = clock() - self.settings.diagnostics_seconds
        self._reported_state = ""
        self._clouds = self._damaged = self._told_late = 0
        self._problem = ""

    # Messages, from any thread.

    def on_cloud(self, cloud: PointCloud2) -> None:
        """Receive a scan."""
        with self._changed:
            self._clouds += 1
            self._heard_cloud = self._clock()
            self._last_cloud = cloud
            self._queue.add(WaitingScan(cloud, self._heard_cloud))
            self._changed.notify_all()

    def on_odometry(self, transform: StampedTransform) -> None:
        """Receive a pose of the robot's base in the odometry frame."""
        with self._changed:
            self._heard_odometry = self._clock()
            if self._odometry.add(transform):
                self._queue.clear()
                self._sent_transform_ns = 0
            self._changed.notify_all()
            correction = self._map_to_odom
        if correction is not None and self.settings.publish_transform:
            self._publish_transform(transform, correction)

    def on_static_transform(self, transform: StampedTransform) -> None:
        """Receive a transform between two frames of the robot."""
        with self._changed:
            self._frames.add(transform)
            self._mount = self.settings.mount
            self._changed.notify_all()

    def on_initial_pose(self, pose: CertainPose) -> None:
        """Receive a pose of the robot's base in the map that a person gave."""

        def give() -> None:
            if pose.frame not in ("", self.settings.map_frame):
                self._problem = (
                    f"The initial pose is in the frame {pose.frame!r}, expected "
                    f"{self.settings.map_frame!r}. Set the fixed frame of RViz to it."
                )
                return
            mount = self._find_mount()
            if mount is not None:
                self._agent.on_initial_pose(np.asarray(pose.pose @ mount), pose.covariance)

        self._call(give)

    def on_localize(self) -> None:
        """Receive the request to localize at the next scan."""
        self._call(self._agent.localize_now)

    def _call(self, function: Callable[[], None]) -> None:
        with self._changed:
            self._calls.append(function)
            self._changed.notify_all()

    # The agent's thread.

    def run(self, stop: threading.Event) -> None:
        """Process messages until the event is set; the agent stays open."""
        while not stop.is_set():
            self.step(0.1)

    def step(self, timeout: float) -> bool:
        """Process what has arrived; wait at most `timeout` seconds for something.

        Returns:
            Whether a scan was processed.
        """
        with self._changed:
            calls, posed = self._work()
            if not calls and posed is None and timeout > 0:
                self._changed.wait(timeout)
                calls, posed = self._work()
            late = self._queue.late
        for call in calls:
            call()
        for _ in range(late - self._told_late):
            self._agent.drop_scan()
        self._told_late = late
        processed = posed is not None and self._process(posed)
        self._report()
        return processed

    def _work(self) -> tuple[list[Callable[[], None]], PairedScan | None]:
        """Return the calls and the scan to process now; the lock is held."""
        calls = list(self._calls)
        self._calls.clear()
        return calls, self._queue.take(self._odometry, self._clock())

    def _process(self, posed: PairedScan) -> bool:
        """Give a scan to the agent, and publish the pose; return whether that was possible."""
        cloud, time_s = posed.scan.cloud, posed.scan.time
        mount = self._find_mount()
        if mount is None:
            return False
        where = "The cloud"
        try:
            clock = self._sweep.add(cloud, where) if self.settings.deskew else None
            scan = decode(cloud, where, clock)
        except DriveError as error:
            self._damaged += 1
            self._problem = str(error)
            return False
        points = scan.points
        if scan.times is not None and len(scan.times):
            first, last = float(scan.times.min()), float(scan.times.max())
            with self._changed:
                motion = self._odometry.motion(time_s + first, time_s + last, mount)
            if motion is not None and motion.covers(time_s + first, time_s + last):
                points = deskew(points, scan.times, time_s, motion)
        self._problem = ""
        covariance = posed.covariance
        if covariance is not None:
            covariance = mounted(covariance, posed.odom_pose, mount)
        self._agent.on_scan(points, time_s, np.asarray(posed.odom_pose @ mount), covariance)
        for message in self._agent.messages:
            self._tell(message)
        correction = self._agent.map_to_odom
        with self._changed:
            self._map_to_odom = correction
        if correction is not None:
            pose = correction.pose(posed.odom_pose)
            self._publisher.pose(
                CertainPose(cloud.stamp_ns, self.settings.map_frame, pose, correction.covariance)
            )
        return True

    def _find_mount(self) -> Float64 | None:
        """Return the pose of the sensor on the robot's base; None if it is not known."""
        with self._changed:
            last, cloud = self._odometry.last, self._last_cloud
            if self._mount is None and last is not None and cloud is not None:
                self._mount = self._frames.pose(cloud.frame, last.child)
            if self._mount is None:
                base = "the odometry" if last is None else repr(last.child)
                sensor = "the clouds" if cloud is None else repr(cloud.frame)
                self._problem = (
                    f"No transform from {base} to {sensor} is known. Publish it on /tf_static, or "
                    "set the extrinsic."
                )
            return self._mount

    def _publish_transform(self, odometry: StampedTransform, correction: MapToOdom) -> None:
        """Publish `map -> odom` for the time of an odometry message, at a bounded rate."""
        if odometry.stamp_ns - self._sent_transform_ns < 1e9 / self.settings.transform_hz:
            return
        self._sent_transform_ns = odometry.stamp_ns
        ahead = round(self.settings.transform_tolerance * 1e9)
        self._publisher.transform(
            StampedTransform(
                odometry.stamp_ns + ahead,
                self.settings.map_frame,
                odometry.parent,
                correction.transform,
            )
        )

    def _report(self) -> None:
        """Publish the diagnostics, if it is time or the state has changed."""
        now = self._clock()
        state = self._agent.status.state.value
        due = now - self._reported >= self.settings.diagnostics_seconds
        if not due and state == self._reported_state:
            return
        self._reported, self._reported_state = now, state
        with self._changed:
            counts = (
                ("clouds", self._clouds),
                ("clouds_late", self._queue.late),
                ("clouds_without_odometry", self._queue.unpaired),
                ("clouds_damaged", self._damaged),
            )
            problem = self._silence(now) or self._problem
            last = self._odometry.last
            stamp_ns = last.stamp_ns if last is not None else 0
            if self._last_cloud is not None:
                stamp_ns = max(stamp_ns, self._last_cloud.stamp_ns)
        robot = self._agent.settings.robot
        self._publisher.diagnostic(
            diagnostic_of(self._agent.status, robot, stamp_ns, problem, counts)
        )

    def _silence(self, now: float) -> str:
        """Return the problem of a topic that is silent; empty if there is none."""
        for name, heard in (("clouds", self._heard_cloud), ("odometry", self._heard_odometry)):
            if now - heard > self.settings.silence_seconds:
                return f"No {name} for {now - heard:.0f} s. Check the topic's name and the driver."
        last, cloud = self._odometry.last, self._last_cloud
        apart = 0.0
        if last is not None and cloud is not None:
            apart = (cloud.stamp_ns - last.stamp_ns) * 1e-9
        if abs(apart) > self.settings.silence_seconds:
            return (
                f"The clouds' clock is {apart:+.1f} s off the odometry's clock. Check that both "
                "drivers use the same clock, and use_sim_time."
            )
        return ""
