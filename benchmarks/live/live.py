"""Live localization: one robot maps a town, another drives it the other way and is kidnapped."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from benchmarks.live.town_drive import LiveScan, TownDrive
from placecell.core.types import Float64
from robot.agent import INSIDE_METERS, RobotAgent
from robot.core.settings import AgentSettings
from robot.core.status import AgentState
from robot.localization.local_engine import LocalEngine
from robot.service_link import ServiceLink, robot_client
from service.child_process import running_service
from town import City, Odometry, sensor

WRONG = (3.0, 10.0)
"""Error of a pose that is wrong, meters and degrees."""


@dataclass(frozen=True, slots=True)
class LivePlan:
    """Plan of a measurement. Lengths are in meters.

    Attributes:
        meters: length of the drive of the localized robot.
        kidnaps: number of times that it is carried away.
        gap: length of the part of the route that is not mapped, in the middle.
        spacing: distance between two scans.
        sensor_name: name of the sensor.
        columns: azimuth steps of the sensor; None: its own.
        seed: seed of town, routes and noise.
        route: length of the route that is mapped; None: all streets.
    """

    meters: float = 5000.0
    kidnaps: int = 20
    gap: float = 200.0
    spacing: float = 1.0
    sensor_name: str = "hdl-64e"
    columns: int | None = None
    seed: int = 7
    route: float | None = None


@dataclass(slots=True)
class LegResult:
    """Result of one start or kidnap.

    Attributes:
        inside: distance driven inside the map until the pose was known, meters.
        outside: distance driven outside the map until then, meters.
        localized: whether the pose was known at last.
    """

    inside: float = 0.0
    outside: float = 0.0
    localized: bool = False


def run_live(
    plan: LivePlan, tell: Callable[[str], None] = lambda _: None, server: str | None = None
) -> dict[str, Any]:
    """Run the measurement; return its figures.

    Args:
        plan: the plan.
        tell: receives a line about the progress.
        server: address of a service; None starts one.
    """
    with ExitStack() as opened:
        folder = Path(opened.enter_context(TemporaryDirectory(prefix="placecell-live-")))
        url = server or opened.enter_context(running_service(folder / "data"))
        engine = LocalEngine()
        opened.callback(engine.close)
        lidar = sensor(plan.sensor_name)
        if plan.columns is not None:
            lidar = replace(lidar, columns=plan.columns)
        # Each leg is driven on streets of the map; the town is as large as the drive is long.
        city = City.build(plan.seed, max(500.0, plan.meters / 2))
        route = city.route(city.planner.every_street())
        mapper = TownDrive(city, route, lidar, 2 * plan.seed, plan.spacing)
        if plan.route is not None:
            route = route.cut(0.0, plan.route)
        middle = route.length() / 2
        mapped = [
            (lidar.height, middle - plan.gap / 2),
            (middle + plan.gap / 2, route.length() - lidar.height),
        ]
        path = build(mapper, mapped, url, engine, tell)
        back = route.reversed()
        robot = TownDrive(city, back, lidar, 2 * plan.seed + 1, plan.spacing, Odometry())
        legs = legs_of(plan, back.length())
        tell(f"{len(legs)} legs of a route of {back.length():,.0f} m")
        return localized(robot, legs, path, url, engine, tell)


def legs_of(plan: LivePlan, length: float) -> list[tuple[float, float]]:
    """Return the legs of the robot; the first one crosses the part that is not mapped."""
    rng = np.random.default_rng([plan.seed, 31])
    around = min(plan.gap + 160.0, length - 20.0)
    first = (length / 2 - around / 2, length / 2 + around / 2)
    rest = max(plan.meters - around, 0.0) / max(plan.kidnaps, 1)
    legs = [first]
    while len(legs) <= plan.kidnaps:
        start = float(rng.uniform(10.0, length - rest - 10.0))
        if abs(start - legs[-1][1]) > 60.0:
            legs.append((start, start + rest))
    return legs


def build(
    mapper: TownDrive,
    legs: list[tuple[float, float]],
    url: str,
    engine: LocalEngine,
    tell: Callable[[str], None],
) -> Float64:
    """Let a robot map; return its path in the town frame, float64 (n, 2)."""
    settings = AgentSettings(map="town", robot="mapper", localize=False, keyframe_meters=2.0)
    with robot_client(url, timeout=60.0) as client:
        agent = RobotAgent(settings, ServiceLink(client), engine=engine)
        path = []
        for number, scan in enumerate(mapper.scans(legs)):
            agent.on_scan(scan.points, scan.time, scan.odom_pose)
            path.append(scan.true_pose[:2, 3])
            if number % 200 == 0:
                tell(f"mapped {agent.status.meters:,.0f} m")
        agent.finish()
        if not agent.wait_for_uploads(600.0):
            raise RuntimeError("The map could not be sent within 600 s.")
        tell(f"{agent.close()}")
    return np.array(path)


def localized(
    robot: TownDrive,
    legs: list[tuple[float, float]],
    path: Float64,
    url: str,
    engine: LocalEngine,
    tell: Callable[[str], None],
) -> dict[str, Any]:
    """Drive the legs, and compare each pose with the truth."""
    tree = cKDTree(path)
    judge = Judge()
    with robot_client(url) as client:
        settings = AgentSettings(map="town", robot="guest", upload=False, session="live")
        agent = RobotAgent(settings, ServiceLink(client), engine=engine)
        for number, scan in enumerate(robot.scans(legs)):
            agent.on_scan(scan.points, scan.time, scan.odom_pose)
            agent.wait(60.0)
            judge.add(scan, agent, float(tree.query(scan.true_pose[:2, 3])[0]))
            if number % 200 == 0:
                tell(f"{agent.status.meters:,.0f} m: {agent.status.state.value}")
        summary = agent.close()
    return judge.figures() | {
        "meters": round(summary.meters, 1),
        "scans": summary.scans,
        "scans_dropped": summary.scans_dropped,
        "fixes": summary.fixes,
        "fixes_refused": summary.fixes_refused,
        "kidnaps_noticed": summary.kidnaps,
        "kidnaps": len(legs) - 1,
    }


class Judge:
    """Compares each pose of the agent with the truth."""

    def __init__(self) -> None:
        self.legs: list[LegResult] = []
        self.offsets: list[float] = []
        self.angles: list[float] = []
        self.wrong = 0
        self.unsure = 0
        self._meters = 0.0
        self._last: LiveScan | None = None
        self._left_at: float | None = None
        self._returned_at: float | None = None
        self._left_noticed: float | None = None
        self._returned_noticed: float | None = None

    def add(self, scan: LiveScan, agent: RobotAgent, from_map: float) -> None:
        """Judge the agent's pose after a scan.

        Args:
            scan: the scan.
            agent: the agent.
            from_map: true distance from the mapped path, meters.
        """
        if self._last is None or scan.leg != self._last.leg:
            self.legs.append(LegResult())
        else:
            step = scan.true_pose[:3, 3] - self._last.true_pose[:3, 3]
            self._drive(float(np.linalg.norm(step)), from_map)
        self._last = scan
        self._judge_border(agent, from_map)
        found = agent.map_to_odom
        leg = self.legs[-1]
        if found is None or not agent.status.is_sure:
            self.unsure += leg.localized
            return
        offset, angle = errors(found.pose(scan.odom_pose), scan.true_pose)
        if offset > WRONG[0] or angle > WRONG[1]:
            self.wrong += 1
        if not leg.localized:
            # The pose of before the kidnap counts as wrong, not as localized.
            if offset > WRONG[0] or angle > WRONG[1]:
                return
            leg.localized = True
        if from_map <= INSIDE_METERS:
            self.offsets.append(offset)
            self.angles.append(angle)

    def _drive(self, meters: float, from_map: float) -> None:
        """Count driven meters, and those until the leg is localized."""
        self._meters += meters
        leg = self.legs[-1]
        if not leg.localized:
            if from_map <= INSIDE_METERS:
                leg.inside += meters
            else:
                leg.outside += meters

    def figures(self) -> dict[str, Any]:
        """Return the figures so far."""
        return {
            "meters_until_localized": [
                round(each.inside, 1) if each.localized else None for each in self.legs
            ],
            "meters_outside_before": [round(each.outside, 1) for each in self.legs],
            "worst_offset_m": round(max(self.offsets, default=0.0), 3),
            "worst_angle_deg": round(max(self.angles, default=0.0), 2),
            "median_offset_m": round(float(np.median(self.offsets)), 3) if self.offsets else None,
            "offset_p99_m": (
                round(float(np.quantile(self.offsets, 0.99)), 3) if self.offsets else None
            ),
            "wrong_but_sure": self.wrong,
            "poses_sure": len(self.offsets),
            "poses_unsure": self.unsure,
            "left_noticed": self._left_noticed is not None,
            "left_noticed_after_m": self._left_noticed,
            "returned_noticed": self._returned_noticed is not None,
            "returned_noticed_after_m": self._returned_noticed,
        }

    def _judge_border(self, agent: RobotAgent, from_map: float) -> None:
        """Note when the robot leaves the map in the first leg, and when it comes back."""
        if len(self.legs) > 1:
            return
        if self._left_at is None and from_map > INSIDE_METERS:
            self._left_at = self._meters
        if self._left_at is None:
            return
        if self._left_noticed is None and agent.status.state is AgentState.OUTSIDE:
            self._left_noticed = round(self._meters - self._left_at, 1)
        if self._returned_at is None and from_map <= INSIDE_METERS:
            self._returned_at = self._meters
        is_back = agent.status.state is AgentState.TRACKING and self._returned_at is not None
        if self._returned_at is not None and self._returned_noticed is None and is_back:
            self._returned_noticed = round(self._meters - self._returned_at, 1)


def errors(pose: Float64, true: Float64) -> tuple[float, float]:
    """Return the distance and the angle between two poses, meters and degrees."""
    offset = float(np.linalg.norm(pose[:3, 3] - true[:3, 3]))
    turn = Rotation.from_matrix(pose[:3, :3].T @ true[:3, :3]).magnitude()
    return offset, float(np.degrees(turn))
