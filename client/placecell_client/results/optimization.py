"""Results of optimizing the pose graph of a map."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class GraphLoop:
    """Loop: a capture that was localized at another one.

    Attributes:
        captures: Numbers of the two captures in `frames`, from 0.
        times: Times of the two captures, seconds.
        positions: Positions of the two captures after the optimization, meters.
        verdict: `accepted`, or the reason of the rejection: `not-explained-by-drift`,
            `unsupported`, `inconsistent` or `outlier`.
        probability: Probability of the localization, 0 to 1.
        inliers: Number of segments that agree.
        meters: Distance from the optimized poses, meters.
        degrees: Angle from the optimized poses, degrees.
    """

    captures: tuple[int, int]
    times: tuple[float, float]
    positions: tuple[tuple[float, float, float], tuple[float, float, float]]
    verdict: str
    probability: float
    inliers: int
    meters: float
    degrees: float


@dataclass(frozen=True, slots=True)
class GraphPart:
    """Part of a map: captures that odometry and loops connect.

    Attributes:
        robots: Names of the robots.
        captures: Number of captures.
        moved_m: Largest movement of a capture, meters.
    """

    robots: tuple[str, ...]
    captures: int
    moved_m: float


@dataclass(frozen=True, slots=True)
class MovedCapture:
    """Capture before and after an optimization.

    Attributes:
        robot: Name of the robot.
        time: Time of the capture, seconds.
        before: Sensor position before, meters.
        after: Sensor position after, meters.
        yaw: Rotation about z, radians.
    """

    robot: str
    time: float
    before: tuple[float, float, float]
    after: tuple[float, float, float]
    yaw: float


@dataclass(frozen=True, slots=True)
class Optimization:
    """Result of the optimization of a map, or of its dry run.

    Attributes:
        map: Name of the map.
        dry_run: Whether nothing was written.
        sequence: Sequence number of the map's version; None for a dry run.
        etag: ETag of that version; None for a dry run.
        previous: Sequence number of the version before. Pass it to `Client.restore_map` to undo the
            optimization. Equal to `sequence` if nothing moved.
        captures: Number of captures.
        changed: Number of segments that move.
        loops_found: Number of loops that were found.
        loops_accepted: Number of those that are part of the graph.
        loops: All loops.
        residual_before_m: Root mean square distance of the accepted loops before, meters.
        residual_after_m: The same after the optimization, meters.
        moved_median_m: Median movement of the captures, meters.
        moved_max_m: Largest movement of a capture, meters.
        parts: Parts that no loop connects, the largest first.
        frames: All captures before and after, if the request asked for them.
    """

    map: str
    dry_run: bool
    sequence: int | None
    etag: str | None
    previous: int
    captures: int
    changed: int
    loops_found: int
    loops_accepted: int
    loops: tuple[GraphLoop, ...]
    residual_before_m: float
    residual_after_m: float
    moved_median_m: float
    moved_max_m: float
    parts: tuple[GraphPart, ...]
    frames: tuple[MovedCapture, ...]


def optimization_of(content: dict[str, Any]) -> Optimization:
    """Build an optimization from the service's response."""
    plain = {name: content[name] for name in Optimization.__slots__ if name not in LISTS}
    return Optimization(
        **plain,
        loops=tuple(
            GraphLoop(
                tuple(item["captures"]),
                tuple(item["times"]),
                (tuple(item["positions"][0]), tuple(item["positions"][1])),
                *(item[name] for name in GraphLoop.__slots__[3:]),
            )
            for item in content["loops"]
        ),
        parts=tuple(
            GraphPart(tuple(item["robots"]), item["captures"], item["moved_m"])
            for item in content["parts"]
        ),
        frames=tuple(
            MovedCapture(
                item["robot"],
                item["time"],
                tuple(item["before"]),
                tuple(item["after"]),
                item["yaw"],
            )
            for item in content["frames"]
        ),
    )


LISTS = frozenset({"loops", "parts", "frames"})
"""Fields that are lists."""
