"""Schemas of the optimization of a map's pose graph as JSON."""

from pydantic import BaseModel, Field

from placecell.pose_graph.bend import Verdict
from service.api.schemas.recognition import Request


class OptimizeRequest(Request):
    """Options of an optimization. An option of the body or of the query is enough."""

    dry_run: bool = Field(
        False,
        strict=True,
        description="Return what the optimization would move, and write nothing.",
    )
    frames: bool = Field(
        False, strict=True, description="Also return each capture before and after."
    )


class GraphLoopOut(BaseModel):
    """Loop: a capture that was localized at another one."""

    captures: tuple[int, int] = Field(
        description="Numbers of the two captures in `frames`, from 0."
    )
    times: tuple[float, float] = Field(description="Times of the two captures, seconds.")
    positions: tuple[tuple[float, float, float], tuple[float, float, float]] = Field(
        description="Positions of the two captures in the map after the optimization, meters."
    )
    verdict: Verdict = Field(
        description="`accepted`, or the reason of the rejection: `not-explained-by-drift`, "
        "`unsupported` (too few loops beside it agree), `inconsistent` (contradicts more loops "
        "than it agrees with), or `outlier` (does not fit the optimized poses)."
    )
    probability: float = Field(description="Probability of the localization, 0 to 1.")
    inliers: int = Field(description="Number of segments that agree.")
    meters: float = Field(description="Distance from the optimized poses, meters.")
    degrees: float = Field(description="Angle from the optimized poses, degrees.")


class GraphPartOut(BaseModel):
    """Part of the map: captures that odometry and loops connect."""

    robots: list[str]
    captures: int
    moved_m: float = Field(description="Largest movement of a capture, meters.")


class MovedCaptureOut(BaseModel):
    """Capture before and after the optimization."""

    robot: str
    time: float = Field(description="Time of the capture, seconds.")
    before: tuple[float, float, float] = Field(description="Sensor position before, meters.")
    after: tuple[float, float, float] = Field(description="Sensor position after, meters.")
    yaw: float = Field(description="Rotation about z, radians.")


class OptimizedOut(BaseModel):
    """Result of the optimization of a map, or of its dry run."""

    map: str
    dry_run: bool
    sequence: int | None = Field(
        description="Sequence number of the map after the optimization. Null for a dry run."
    )
    etag: str | None = Field(description="Entity tag of that version. Null for a dry run.")
    previous: int = Field(
        description="Version before. To undo the optimization: POST "
        "/maps/MAP/versions/PREVIOUS/restore."
    )
    captures: int = Field(description="Number of captures.")
    changed: int = Field(description="Number of segments that move.")
    loops_found: int
    loops_accepted: int
    loops: list[GraphLoopOut]
    residual_before_m: float = Field(
        description="Root mean square distance of the accepted loops before, meters."
    )
    residual_after_m: float = Field(description="The same after the optimization, meters.")
    moved_median_m: float = Field(description="Median movement of the captures, meters.")
    moved_max_m: float = Field(description="Largest movement of a capture, meters.")
    parts: list[GraphPartOut] = Field(
        description="Parts that no loop connects; they keep their places relative to each other."
    )
    frames: list[MovedCaptureOut] = Field(
        description="All captures before and after, in order of time, if the request asked for "
        "them."
    )
