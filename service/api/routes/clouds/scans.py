"""`/scans` and `/maps/{map}/scans`: a point cloud file in, its segments out or into a map."""

import time
from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from placecell_client import MapFileError, encode_delta
from placecell_client.maps.compact_map import COORDINATE_LIMIT, TIME_LIMIT

from placecell.core.types import Float32
from service.api.admission.admission import client_of
from service.api.body.body import MSGPACK, OCTETS, answer_type, render
from service.api.body.msgpack_codec import Items
from service.api.body.problem_json import documented
from service.api.dependencies import MapWrite, MapWriteOf, PrincipalOf, StateOf, TimingOf
from service.api.openapi import file_body, packed_response
from service.api.responses import outcome_of
from service.api.schemas.maps import AddedScanOut
from service.api.schemas.scans import PackedScanResponse, ScanResponse
from service.clouds.scan_capture import LevelPose, ScanOrigin, check_segmented, edit_with, ids_from
from service.clouds.segmented_scan import SegmentedScan, segment_scan
from service.clouds.uploaded_cloud import NAMELESS, UploadedCloud, read_uploaded_cloud
from service.core.cost import check_cost, cost_of_segmenting
from service.core.problems import invalid_value
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.scan import Scan
from service.maps.writes.writer import EditOptions

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


_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": AddedScanOut, "description": "The map is new."}
}
Meters = Annotated[
    float,
    Query(
        ge=-COORDINATE_LIMIT,
        le=COORDINATE_LIMIT,
        description="Position of the sensor in the map's frame, meters.",
    ),
]


@router.post(
    "/maps/{map}/scans",
    tags=["sharing"],
    summary="Add a scan to a map",
    response_model=AddedScanOut,
    responses=_NEW_RESPONSE
    | documented(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507),
    openapi_extra=file_body(OCTETS),
)
async def add_scan(
    write: MapWriteOf,
    robot: Annotated[
        str | None,
        Query(max_length=200, description="Robot that saw the scan. Default: the key's robot."),
    ] = None,
    name: FileName = NAMELESS,
    create: Annotated[bool, Query(description="Create the map if it does not exist.")] = False,
    deduplicate: Annotated[
        bool, Query(description="Do not store segments that were seen before, as in an edit.")
    ] = False,
    x: Meters = 0.0,
    y: Meters = 0.0,
    z: Meters = 0.0,
    yaw: Annotated[
        float,
        Query(
            ge=-100,
            le=100,
            description="Angle of the sensor about the z axis in the map's frame, radians.",
        ),
    ] = 0.0,
    scan_time: Annotated[
        float | None,
        Query(
            alias="time",
            ge=-TIME_LIMIT,
            le=TIME_LIMIT,
            description="Time of the scan, seconds on the clock of the map's captures. Default: "
            "now, Unix seconds.",
        ),
    ] = None,
) -> Response:
    """Segment a point cloud file, describe its segments, and add them to the map as one capture.

    The body is a file as for `/scans`. The segments get reserved ids, in one version that can be
    undone as any other. Sending the file again adds them again, unless `deduplicate` is set.
    """
    robot = robot or write.principal.key.robot
    if not robot:
        raise invalid_value("/query/robot", "The robot is missing. Name the robot of the scan.")
    seconds = time.time() if scan_time is None else scan_time
    origin = ScanOrigin(robot, seconds, LevelPose(x, y, z, yaw))
    options = EditOptions(robot=robot, create=create, deduplicate=deduplicate, only_new=True)
    limits = write.state.settings.limits
    async with write.receive(write.state.lanes.edits, (OCTETS,), limits.scan_bytes) as content:
        return await _added(write, content, name, origin, options)


async def _added(
    write: MapWrite, content: bytes, name: str, origin: ScanOrigin, options: EditOptions
) -> Response:
    """Add a scan to the map of a write."""
    state, timing = write.state, write.timing
    maps = state.engine.maps
    snapshot = maps.find(write.name) if options.create else maps.get(write.name)
    before = None if snapshot is None else snapshot.layers.base
    model = state.engine.models.named(None if snapshot is None else snapshot.model_id)
    limits = state.settings.limits
    _, scan = await state.run(read_and_segment, content, name, limits, timing)
    check_segmented(scan)
    clouds = Scan.from_clouds(scan.clouds, np.zeros(3))
    prepared = await state.run(model.describer.prepare, clouds, timing)
    descriptors = await model.describer.describe(prepared, timing)
    count = len(descriptors.usable)
    first = 0
    if snapshot is not None:
        first = await write.run(write.writer.reserve, write.name, count, limits.reserved_ids)
    frame = write.name if snapshot is None else snapshot.frame
    delta = edit_with(scan, descriptors, origin, model, frame, first, before)
    try:
        file = encode_delta(delta)
    except MapFileError as error:
        raise invalid_value("/query", f"The scan cannot be stored: {error}.") from error
    result = await write.commit("edit", write.writer.edit, write.name, file, options)
    added = AddedScanOut(
        **outcome_of(result).model_dump(),
        ids=ids_from(first, count).tolist(),
        unusable=len(scan.clouds) - count,
        problems=list(scan.problems),
    )
    return JSONResponse(
        added.model_dump(mode="json"),
        status_code=201 if result.is_new else 200,
        headers={"ETag": f'"{result.snapshot.tag}"'},
    )


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
