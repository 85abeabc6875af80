"""Fakes of the link and of the engine, and scans of a made-up street."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from placecell_client import CompactMap, Delta, MapCopy, decode_delta
from placecell_client.maps.edit import apply

from placecell.core.types import Float32, Float64
from robot.agent import RobotAgent
from robot.core.link import FixAnswer, FixRequest, RefusedError
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import AgentSettings
from robot.core.status import AgentStatus, Fix
from robot.core.usable_segments import UsableSegments
from robot.core.worker import InlineWorker
from robot.outputs.output import NoOutput

MODEL = "fake-0123"


class FakeEngine:
    """Engine whose descriptors are the segments' sizes, and whose pulled map is a pose."""

    model_id = MODEL
    preprocessing = "1"

    def __init__(self) -> None:
        self.pulled: CompactMap | None = None
        self.local_pose: Float64 | None = None
        self.mapped: Callable[[Float64], float | None] = lambda _: 0.0
        self.asked: list[FixRequest] = []
        self.classified: list[bool] = []
        self.replaced: tuple[CompactMap, CompactMap] | None = None

    def take_replaced(self) -> tuple[CompactMap, CompactMap] | None:
        replaced, self.replaced = self.replaced, None
        return replaced

    @property
    def has_map(self) -> bool:
        return self.pulled is not None

    def describe(
        self, clouds: Sequence[ArrayLike], sensors: ArrayLike, classified: bool = True
    ) -> UsableSegments:
        arrays = [np.asarray(cloud, np.float64) for cloud in clouds]
        codes = np.array([[len(each) % 128] * 4 for each in arrays], np.int8).reshape(-1, 4)
        centroids = np.array([each.mean(axis=0) for each in arrays]).reshape(-1, 3)
        classes = np.full(len(arrays), 1 + 31 * 3 + 27, np.uint8) if classified else None
        self.classified.append(classified)
        return UsableSegments(codes, centroids, np.arange(len(arrays)), classes)

    def set_map(self, content: CompactMap, etag: str) -> None:
        self.pulled = content

    def meters_from_map(self, position: Float64) -> float | None:
        return self.mapped(position)

    def localize(self, request: FixRequest) -> FixAnswer:
        self.asked.append(request)
        return answer_of(request, self.local_pose, "local")

    def close(self) -> None: ...


def answer_of(request: FixRequest, transform: Float64 | None, source: Any) -> FixAnswer:
    """Return an answer with a pose, or without one."""
    if transform is None:
        return FixAnswer(request, source, None, None, 0.1, "nothing agrees")
    covariance = np.diag([0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-5])
    return FixAnswer(request, source, transform, covariance, 0.99, "")


def owners_of(content: CompactMap, ids: ArrayLike) -> set[str]:
    """Return the robots of some segments of a map."""
    return {content.robots[each] for each in content.robot[np.isin(content.ids, ids)].tolist()}


class FakeLink:
    """Link to a service in memory.

    Attributes:
        transform: answer to all requests; None: not localized.
        failure: error that each call raises; None: none does.
        maps: segments of each map.
    """

    def __init__(self) -> None:
        self.transform: Float64 | None = None
        self.failure: Exception | None = None
        self.maps: dict[str, CompactMap] = {}
        self.asked: list[FixRequest] = []
        self.uploads: list[tuple[str, bytes]] = []
        self.reports: list[AgentStatus] = []
        self.lost_answers = 0
        self.closed = False

    def localize(self, request: FixRequest) -> FixAnswer:
        self._fail()
        self.asked.append(request)
        return answer_of(request, self.transform, "service")

    def upload(self, name: str, delta: bytes, robot: str, create: bool) -> None:
        self._fail()
        edit: Delta = decode_delta(delta)
        stored = self.maps.get(name)
        if stored is None and not create:
            raise RefusedError("no such map", 404, "unknown-map")
        if stored is not None and stored.frame != edit.changed.frame:
            raise RefusedError("another frame", 409, "other-frame")
        if stored is not None and owners_of(stored, edit.removed) - {robot, *edit.changed.robots}:
            raise RefusedError("segments of others", 409, "id-taken")
        self.maps[name] = edit.changed if stored is None else apply(stored, edit)
        self.uploads.append((name, delta))
        if self.lost_answers:
            self.lost_answers -= 1
            from robot.core.link import LinkError

            raise LinkError("the answer was lost")

    def pull(self, copy: MapCopy) -> MapCopy:
        self._fail()
        stored = self.maps.get(copy.name)
        if stored is None:
            raise RefusedError("no such map", 404, "unknown-map")
        return MapCopy(copy.name, stored, f"0000-{len(stored)}")

    def report(self, robot: str, status: AgentStatus, pose: MapToOdom | None) -> None:
        self._fail()
        self.reports.append(status)

    def close(self) -> None:
        self.closed = True

    def _fail(self) -> None:
        if self.failure is not None:
            raise self.failure


class FakeClock:
    """Monotonic clock that a test moves."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Recorder(NoOutput):
    """Output that keeps states and fixes."""

    def __init__(self) -> None:
        self.states: list[str] = []
        self.links: list[str] = []
        self.fixes: list[Fix] = []

    def fix(self, fix: Fix) -> None:
        self.fixes.append(fix)

    def status(self, status: AgentStatus) -> None:
        if self.states[-1:] != [status.state.value]:
            self.states.append(status.state.value)
        self.links.append(status.link.value)


class Street:
    """Street with poles and boxes at random places, seen by a sensor that sees all around it."""

    def __init__(self, seed: int = 0, meters: float = 200.0) -> None:
        rng = np.random.default_rng(seed)
        count = int(meters * 1.2)
        centers = np.column_stack(
            [
                rng.uniform(-40, meters + 40, count),
                rng.choice([-1, 1], count) * rng.uniform(4, 25, count),
            ]
        )
        parts = []
        for center in centers:
            size = rng.uniform(0.4, 1.5, 2)
            points = rng.uniform(-0.5, 0.5, (260, 3)) * [*size, 0.0] + [*center, 0.0]
            points[:, 2] = rng.uniform(-1.4, 1.0, len(points))
            parts.append(points)
        ground = rng.uniform([-40, -30], [meters + 40, 30], (int(meters * 150), 2))
        parts.append(np.column_stack([ground, np.full(len(ground), -1.7)]))
        self.points: Float64 = np.concatenate(parts)

    def scan(self, pose: Float64) -> Float32:
        """Return the points within 30 m of a sensor, float32 (n, 3), in its frame."""
        near = self.points[np.linalg.norm(self.points[:, :2] - pose[:2, 3], axis=1) < 30.0]
        return np.asarray((near - pose[:3, 3]) @ pose[:3, :3], dtype=np.float32)


def at(x: float, y: float = 0.0, yaw: float = 0.0) -> Float64:
    """Return a level pose, (4, 4)."""
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    pose[:2, 3] = x, y
    return pose


def new_agent(
    settings: AgentSettings,
    link: FakeLink | None,
    engine: FakeEngine | None = None,
    recorder: Recorder | None = None,
    clock: FakeClock | None = None,
) -> RobotAgent:
    """Return an agent without threads."""
    return RobotAgent(
        settings,
        link,
        [recorder] if recorder is not None else [],
        clock or FakeClock(),
        engine or FakeEngine(),  # type: ignore[arg-type]
        InlineWorker,
    )


def drive(
    agent: RobotAgent,
    street: Street,
    places: Sequence[float],
    odometry: Callable[[float], Float64] = at,
    first_time: float = 0.0,
) -> None:
    """Drive along a street: a scan at each place, with the pose of the odometry."""
    for number, place in enumerate(places):
        time = round(first_time + 0.1 * number, 6)
        agent.on_scan(street.scan(at(place)), time, odometry(place))
        agent.wait(1.0)
