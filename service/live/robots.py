"""Robots: the last pose and state that each robot reported, in memory."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from threading import Lock
from time import monotonic
from typing import Literal

from service.core.auth import Principal
from service.core.problems import Problem

Vector = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class RobotPose:
    """Pose of a robot's sensor in a map.

    Attributes:
        map: name of the map.
        position: x, y, z in the map's frame, meters.
        orientation: quaternion x, y, z, w.
        covariance: covariance of the pose, rows for x, y, z, and yaw or rotations about x, y, z;
            None if it is not known.
        probability: probability that the pose is right; None if it is not known.
    """

    map: str
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    covariance: tuple[Vector, ...] | None = None
    probability: float | None = None


@dataclass(frozen=True, slots=True)
class RobotReport:
    """Report of one robot.

    Attributes:
        robot: name of the robot.
        pose: its pose; None if it has none now.
        state: its state, such as `localized`.
        reason: reason for the state; empty if there is none.
        time: time of the robot's clock, Unix seconds; None if it gave none.
        source: `report` by the robot itself, or its last `/localize`.
    """

    robot: str
    pose: RobotPose | None
    state: str
    reason: str
    time: float | None
    source: Literal["report", "localize"]


@dataclass(frozen=True, slots=True)
class RobotStatus:
    """Last report of a robot, with its last pose.

    Attributes:
        report: the report; its pose is that of an earlier one if it had none.
        age: time since the report, seconds.
        pose_age: time since the report of the pose, seconds; None without a pose.
    """

    report: RobotReport
    age: float
    pose_age: float | None


@dataclass(frozen=True, slots=True)
class _Entry:
    report: RobotReport
    author: str
    at: float
    pose_at: float | None


class Robots:
    """Last reports of all robots. Safe to use from many threads.

    A robot without a report for longer than the memory is dropped. If there are too many robots,
    the API key that reports most of them loses its oldest one.
    """

    def __init__(self, most: int, seconds: float, clock: Callable[[], float] = monotonic) -> None:
        """Create it without robots.

        Args:
            most: largest number of robots.
            seconds: time after its last report when a robot is dropped, seconds.
            clock: monotonic clock, seconds.
        """
        self._most = most
        self._seconds = seconds
        self._clock = clock
        self._lock = Lock()
        self._entries: dict[str, _Entry] = {}  # the last reported robot is at the end

    def __len__(self) -> int:
        with self._lock:
            self._drop_old(self._clock())
            return len(self._entries)

    def report(self, report: RobotReport, principal: Principal) -> RobotStatus:
        """Replace a robot's last report.

        Raises:
            Problem: 403 if the key may not report this robot, or another key reports it from a map
                outside the scope of this one.
        """
        principal.check_reports(report.robot)
        with self._lock:
            now = self._clock()
            self._drop_old(now)
            before = self._entries.pop(report.robot, None)
            if before is not None and not _sees(principal, before):
                self._entries[report.robot] = before
                raise Problem(
                    403,
                    "forbidden",
                    f"Another key reports the robot {report.robot!r:.80}. Choose another name.",
                )
            pose_at: float | None = now
            if report.pose is None:
                pose_at = None if before is None else before.pose_at
                report = replace(report, pose=None if before is None else before.report.pose)
            entry = _Entry(report, principal.name, now, pose_at)
            self._entries[report.robot] = entry
            if len(self._entries) > self._most:
                self._drop_one()
            return _status(entry, now)

    def all(self, principal: Principal) -> list[RobotStatus]:
        """Return the robots that a key may see, by name."""
        with self._lock:
            now = self._clock()
            self._drop_old(now)
            entries = [each for each in self._entries.values() if _sees(principal, each)]
        return [_status(each, now) for each in sorted(entries, key=lambda each: each.report.robot)]

    def get(self, robot: str, principal: Principal) -> RobotStatus:
        """Return a robot; 404 if it did not report, or if the key may not see it."""
        with self._lock:
            now = self._clock()
            self._drop_old(now)
            entry = self._entries.get(robot)
        if entry is None or not _sees(principal, entry):
            raise Problem(
                404,
                "unknown-robot",
                f"No robot {robot!r:.80} reported within the last {self._seconds:g} s. "
                "GET /robots lists the robots.",
            )
        return _status(entry, now)

    def _drop_old(self, now: float) -> None:
        while self._entries:
            name, oldest = next(iter(self._entries.items()))
            if now - oldest.at <= self._seconds:
                return
            del self._entries[name]

    def _drop_one(self) -> None:
        """Drop the oldest robot of the key with most robots."""
        ((most, _),) = Counter(each.author for each in self._entries.values()).most_common(1)
        del self._entries[next(name for name, each in self._entries.items() if each.author == most)]


def _sees(principal: Principal, entry: _Entry) -> bool:
    """Return whether a key may see a robot: it may read the map, or it reported the robot."""
    pose = entry.report.pose
    if principal.covers_all or principal.name == entry.author:
        return True
    return pose is not None and principal.covers(pose.map)


def _status(entry: _Entry, now: float) -> RobotStatus:
    pose_age = None if entry.pose_at is None else now - entry.pose_at
    return RobotStatus(entry.report, now - entry.at, pose_age)
