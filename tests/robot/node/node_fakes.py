"""Stand-ins for the node's agent, publisher and clock, and its messages."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.sources.bags.pointcloud2 import PointCloud2, PointField
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import AgentSettings
from robot.core.status import AgentState, AgentStatus
from robot.node.messages import CertainPose, Diagnostic, StampedTransform
from robot.node.node import NodeAgent

SECOND = 10**9
FIELDS = [PointField(axis, 4 * number, 7) for number, axis in enumerate("xyz")]


@dataclass
class FakeAgent:
    """Agent that keeps what it is given, and knows a fixed correction after some scans."""

    known_after: int = 1
    settings: AgentSettings = field(default_factory=lambda: AgentSettings("yard", robot="ann"))
    status: AgentStatus = field(default_factory=AgentStatus)
    map_to_odom: MapToOdom | None = None
    scans: list[tuple[Float32, float, Float64]] = field(default_factory=list)
    covariances: list[Float64 | None] = field(default_factory=list)
    initial_poses: list[tuple[Float64, Float64]] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    dropped: int = 0
    requests: int = 0

    def on_scan(
        self,
        points: Float32,
        time_s: float,
        odom_pose: Float64,
        odom_covariance: Float64 | None = None,
    ) -> None:
        self.scans.append((points, time_s, odom_pose))
        self.covariances.append(odom_covariance)
        self.messages = [f"scan {len(self.scans)}"]
        self.status = replace(
            self.status, state=AgentState.LOCALIZING, time=time_s, scans=len(self.scans)
        )
        if len(self.scans) >= self.known_after:
            self.status = replace(self.status, state=AgentState.TRACKING)
            self.map_to_odom = MapToOdom(moved(100, 50), 0.01 * np.eye(6), "yard", time_s)

    def drop_scan(self) -> None:
        self.dropped += 1

    def on_initial_pose(self, map_pose: Float64, covariance: Float64) -> None:
        self.initial_poses.append((map_pose, covariance))

    def localize_now(self) -> None:
        self.requests += 1


class Opened:
    """Opener of a stand-in agent; knows whether it was closed."""

    def __init__(self) -> None:
        self.agent = FakeAgent()
        self.parameters: Any = None
        self.closed = 0

    @contextmanager
    def __call__(self, parameters: Any) -> Iterator[NodeAgent]:
        self.parameters = parameters
        yield self.agent
        self.closed += 1


@dataclass
class FakePublisher:
    """Publisher that keeps what it is given."""

    transforms: list[StampedTransform] = field(default_factory=list)
    poses: list[CertainPose] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def transform(self, transform: StampedTransform) -> None:
        self.transforms.append(transform)

    def pose(self, pose: CertainPose) -> None:
        self.poses.append(pose)

    def diagnostic(self, diagnostic: Diagnostic) -> None:
        self.diagnostics.append(diagnostic)


@dataclass
class FakeClock:
    """Clock that stands still until it is moved."""

    now: float = 0.0

    def __call__(self) -> float:
        return self.now


def moved(x: float, y: float = 0.0, z: float = 0.0) -> Float64:
    """Return a translation, float64 (4, 4)."""
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def odometry(seconds: float, x: float, child: str = "base_link") -> StampedTransform:
    """Return a message of the odometry."""
    return StampedTransform(round(seconds * SECOND), "odom", child, moved(x))


def cloud(seconds: float, frame: str = "lidar", times: list[float] | None = None) -> PointCloud2:
    """Return a cloud of three points, 1 m ahead of the sensor; with times relative to the stamp."""
    points = np.array([[1, 0, 0], [1, 1, 0], [1, -1, 0]], np.float32)
    fields, columns = FIELDS, [points]
    if times is not None:
        fields = [*FIELDS, PointField("time", 12, 7)]
        columns.append(np.array(times, np.float32)[:, None])
    data = np.ascontiguousarray(np.concatenate(columns, axis=1))
    step = data.shape[1] * 4
    return PointCloud2(
        fields, False, step, 3 * step, 3, 1, data.tobytes(), round(seconds * SECOND), frame
    )
