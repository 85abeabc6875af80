"""Route of `/maps/{map}/optimize`: removes the drift of a map."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query, Response

from placecell.core.types import Int64
from placecell.pose_graph import BentMap
from service.api.body.body import JSON, read_json_body
from service.api.body.problem_json import documented
from service.api.dependencies import MapWriteOf
from service.api.openapi import json_body
from service.api.schemas.pose_graph import (
    GraphLoopOut,
    GraphPartOut,
    MovedCaptureOut,
    OptimizedOut,
    OptimizeRequest,
)
from service.merging.bending import OptimizedMap, movement, parts_listed

router = APIRouter(tags=["sharing"])


@router.post(
    "/maps/{map}/optimize",
    summary="Remove the drift of a map",
    responses=documented(
        400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 501, 503, 504, 507
    ),
    openapi_extra=json_body(OptimizeRequest, required=False),
)
async def optimize(
    write: MapWriteOf,
    response: Response,
    dry_run: Annotated[
        bool, Query(description="Return what the optimization would move, and write nothing.")
    ] = False,
    frames: Annotated[
        bool, Query(description="Also return each capture before and after.")
    ] = False,
) -> OptimizedOut:
    """Find loops in a map, and move its captures to the poses that fit odometry and loops best.

    The service localizes the captures of the map in other parts of the same map. Loops that drift
    does not explain, that no other loops support, or that contradict the others are rejected.
    Segments move with their captures. Roll and pitch stay. The result is one version: `dry_run`
    returns what it would change, and restoring the version before undoes it. The options may also
    stand in a JSON body. 501: the service has no solver (`pip install "placecell[pose-graph]"`).
    """
    state = write.state
    async with write.receive(state.lanes.alignments, (JSON,)) as body:
        if body:
            asked = await write.run(read_json_body, OptimizeRequest, body)
            dry_run, frames = dry_run or asked.dry_run, frames or asked.frames
        result = await write.run(
            state.engine.optimize_map,
            write.name,
            dry_run=dry_run,
            principal=write.principal,
            conditions=write.writer.conditions,
        )
    if result.written is not None:
        write.record_result("optimize", result.written)
        response.headers["ETag"] = f'"{result.written.snapshot.tag}"'
    return optimized_of(write.name, result, frames)


def optimized_of(name: str, result: OptimizedMap, frames: bool) -> OptimizedOut:
    """Return the answer about an optimization."""
    bent, written = result.bent, result.written
    median, largest = movement(bent).tolist()
    snapshot = None if written is None else written.snapshot
    order = _by_time(bent)
    numbers = np.argsort(order)
    return OptimizedOut(
        map=name,
        dry_run=written is None,
        sequence=None if snapshot is None else snapshot.head.sequence,
        etag=None if snapshot is None else snapshot.tag,
        previous=result.previous,
        captures=len(bent.frames),
        changed=0 if result.content is None else len(result.content),
        loops_found=len(bent.loops),
        loops_accepted=bent.accepted,
        loops=[
            GraphLoopOut(
                captures=(int(numbers[each.loop.one]), int(numbers[each.loop.other])),
                times=(
                    float(bent.frames.times[each.loop.one]),
                    float(bent.frames.times[each.loop.other]),
                ),
                positions=(
                    _point(bent.positions[each.loop.one]),
                    _point(bent.positions[each.loop.other]),
                ),
                verdict=each.verdict,
                probability=each.loop.probability,
                inliers=each.loop.inliers,
                meters=each.meters,
                degrees=each.degrees,
            )
            for each in bent.loops
        ],
        residual_before_m=bent.before,
        residual_after_m=bent.after,
        moved_median_m=median,
        moved_max_m=largest,
        parts=[
            GraphPartOut(robots=robots, captures=captures, moved_m=moved)
            for robots, captures, moved in parts_listed(result)
        ],
        frames=_frames(result, order) if frames else [],
    )


def _by_time(bent: BentMap) -> Int64:
    """Return the captures in order of time."""
    return np.lexsort((*bent.frames.positions.T, bent.frames.times))


def _frames(result: OptimizedMap, order: Int64) -> list[MovedCaptureOut]:
    bent = result.bent
    return [
        MovedCaptureOut(
            robot=result.robots[row],
            time=float(bent.frames.times[row]),
            before=_point(bent.frames.positions[row]),
            after=_point(bent.positions[row]),
            yaw=float((bent.yaws[row] - bent.frames.yaws[row] + np.pi) % (2 * np.pi) - np.pi),
        )
        for row in order.tolist()
    ]


def _point(position: np.ndarray) -> tuple[float, float, float]:
    x, y, z = position.tolist()
    return x, y, z
