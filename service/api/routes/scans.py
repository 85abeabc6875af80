"""`/scans`: a point cloud file in, its segments out."""

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from placecell.core.types import Float32
from service.api.admission.admission import client_of
from service.api.body.body import MSGPACK, OCTETS, answer_type, render
from service.api.body.msgpack_codec import Items
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.openapi import file_body, packed_response
from service.api.schemas.scans import PackedScanResponse, ScanResponse
from service.clouds.segmented_scan import SegmentedScan, segment_scan
from service.clouds.uploaded_cloud import NAMELESS, UploadedCloud, read_uploaded_cloud
from service.core.cost import check_cost, cost_of_segmenting
from service.core.settings import Limits
from service.core.timing import Timing

router = APIRouter(tags=["recognition"])

SHOWN_POINTS = 50_000
"""Largest number of points of a scan in the answer, besides those of its segments."""

FileName = Annotated[
    str,
    Query(
        max_length=200,
        description="Name of the file. Its ending tells a format without a signature: `.bin`, "
        "`.csv`, `.xyz`. Problems show it; no file of this name is opened.",
    ),
]


@router.post(
    "/scans",
    summary="Segment a point cloud file",
    response_model=ScanResponse,
    responses=packed_response(PackedScanResponse)
    | documented(400, 401, 406, 408, 413, 415, 422, 429, 503, 504),
    openapi_extra=file_body(OCTETS),
)
async def segment_file(
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    timing: TimingOf,
    name: FileName = NAMELESS,
) -> Response:
    """Return the segments of one scan, for `/localize` and `/match`, and its points to show.

    The body is a point cloud file: PCD, PLY, LAS, LAZ, KITTI's .bin, NumPy, CSV or other text. The
    content tells the format, and the name's ending where the content does not. The points are
    leveled by the ground that the scan shows. One scan has fewer segments than the local maps of a
    drive.
    """
    del principal  # any key may segment
    answer = answer_type(request)
    limits = state.settings.limits
    async with state.lanes.recognition.admit(request, (OCTETS,), timing, limits.scan_bytes) as body:
        content = await state.run(_segmented, body.content, name, limits, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def read_and_segment(
    content: bytes, name: str, limits: Limits, timing: Timing
) -> tuple[UploadedCloud, SegmentedScan]:
    """Read a point cloud file and segment it, within the limits.

    Raises:
        Problem: 413 if the file is too large or too much work, 415 or 422 if it cannot be read.
    """
    timing.lap("queue")
    cloud = read_uploaded_cloud(content, name, limits.scan_points)
    timing.lap("decode")
    check_cost(cost_of_segmenting(cloud.scan.read), limits.cost_seconds)
    scan = segment_scan(cloud)
    timing.lap("segment")
    return cloud, scan


def _segmented(content: bytes, name: str, limits: Limits, answer: str, timing: Timing) -> bytes:
    cloud, scan = read_and_segment(content, name, limits, timing)
    is_packed = answer == MSGPACK
    shown = np.arange(len(scan.voxels))[:: -(-len(scan.voxels) // SHOWN_POINTS) or 1]
    labels = scan.labels[shown]
    # The same as a `ScanResponse`, without its checks: the values are our own.
    response = {
        "format": cloud.format,
        "points": cloud.scan.read,
        "dropped_points": cloud.scan.read - len(cloud.scan.points),
        "segments": Items(len(scan.clouds), _items(scan, is_packed)),
        "sensors": [[0.0, 0.0, 0.0]] * len(scan.clouds),
        "cloud": {
            "points": _points(np.round(scan.voxels[shown], 2), 2, is_packed),
            "labels": labels.astype("<i4").tobytes() if is_packed else labels.tolist(),
        },
        "transform": scan.transform.tolist(),
        "sensor_height": scan.sensor_height,
        "problems": list(scan.problems),
    }
    rendered = render(response, answer)
    timing.lap("encode")
    return rendered


def _items(scan: SegmentedScan, is_packed: bool) -> Iterator[dict[str, Any]]:
    for points in scan.clouds:
        low, high = points.min(axis=0), points.max(axis=0)
        yield {
            "points": _points(points, 3, is_packed),
            "centroid": np.round(points.mean(axis=0, dtype=np.float64), 3).tolist(),
            "extents": np.round((high - low).astype(np.float64), 3).tolist(),
        }


def _points(points: Float32, digits: int, is_packed: bool) -> Any:
    """Return points for an answer: a blob, or rows rounded to some digits."""
    if is_packed:
        return points.astype("<f4").tobytes()
    return np.round(points.astype(np.float64), digits).tolist()
