"""`/maps/{map}/segments/{id}/shape` and `/maps/{map}/shapes`: what stored segments look like."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Path, Query, Request, Response
from placecell_client import CompactMap
from pydantic import Field

from placecell.shapes.decoder import ShapeDecoder
from service.api.admission.admission import client_of
from service.api.body.body import JSON
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf
from service.api.path_parameters import Name
from service.api.responses import listed_classes
from service.api.schemas.recognition import ClassOut
from service.api.schemas.shapes import ShapeOut, ShapesOut
from service.api.state import State
from service.clouds.map_shapes import decoded_points
from service.core.problems import Problem
from service.maps.snapshot import MapSnapshot

router = APIRouter(tags=["maps"])

CENTROID_BYTES = 6
"""Bytes of a centroid in a map file."""

MOST_SHAPES = 100
"""Largest number of shapes in one answer: some 0.2 s of processor time and 400 kB of JSON."""

SegmentId = Annotated[int, Field(ge=0, lt=1 << 32)]


@router.get(
    "/maps/{map}/segments/{id}/shape",
    summary="Decode the shape of a stored segment",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504),
    response_model=ShapeOut,
)
async def segment_shape(
    name: Name,
    segment: Annotated[int, Path(alias="id", ge=0, lt=1 << 32, description="Id of the segment.")],
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
) -> Response:
    """Return the points of a segment, as its stored code and box tell them.

    The map holds no points. The decoder of the map's model makes an occupancy grid from the code of
    the segment, turned by the bearing of the sensor. 409: the model has no decoder.
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        content = await state.run(_shape, state, snapshot, segment)
    headers = {"ETag": f'"{snapshot.tag}"'}
    return await state.answers.respond(content, client_of(request), JSON, headers)


@router.get(
    "/maps/{map}/shapes",
    summary="Decode the shapes of several segments",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504),
    response_model=ShapesOut,
)
async def segment_shapes(
    name: Name,
    ids: Annotated[
        list[SegmentId],
        Query(
            alias="id",
            min_length=1,
            max_length=MOST_SHAPES,
            description="Id of a segment; repeatable.",
        ),
    ],
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
) -> Response:
    """Return the shapes of several segments of a map, as `GET .../segments/{id}/shape` returns one.

    The newest version answers; an id that it does not have is listed in `missing`. 409: the model
    has no decoder.
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        content = await state.run(_shapes, state, snapshot, ids)
    headers = {"ETag": f'"{snapshot.tag}"'}
    return await state.answers.respond(content, client_of(request), JSON, headers)


def _shape(state: State, snapshot: MapSnapshot, segment: int) -> bytes:
    decoder = decoder_of(state, snapshot)
    content = snapshot.layers.take(np.array([segment], np.uint32))
    if not len(content):
        raise Problem(
            404,
            "unknown-segment",
            f"Map {snapshot.name} has no segment {segment}. It may have been removed or replaced; "
            "GET /maps/{map} returns the newest version.",
        )
    (shape,) = _decoded(snapshot, content, decoder)
    return shape.model_dump_json(by_alias=True).encode()


def _shapes(state: State, snapshot: MapSnapshot, segments: list[int]) -> bytes:
    decoder = decoder_of(state, snapshot)
    wanted = np.unique(np.array(segments, np.uint32))
    content = snapshot.layers.take(wanted)
    shapes = ShapesOut(
        map=snapshot.name,
        shapes=_decoded(snapshot, content, decoder),
        missing=np.setdiff1d(wanted, content.ids).tolist(),
    )
    return shapes.model_dump_json(by_alias=True).encode()


def _decoded(snapshot: MapSnapshot, content: CompactMap, decoder: ShapeDecoder) -> list[ShapeOut]:
    """Return the shapes of some segments of a map, in their order."""
    if not len(content):
        return []
    points, owners = decoded_points(content, decoder, chunk=1)
    # Owners ascend, so the points of each segment lie together.
    ends = np.searchsorted(owners, np.arange(1, len(content)))
    clouds = np.split(points.astype(np.float64).round(2), ends)
    listed = [None] * len(content) if content.classes is None else listed_classes(content.classes)
    optional = 3 * (content.extents is not None) + 2 * (content.points is not None)
    return [
        ShapeOut(
            map=snapshot.name,
            id=segment,
            model_id=snapshot.model_id,
            bytes=content.codes.shape[1] + CENTROID_BYTES + optional,
            voxel_m=decoder.voxel,
            centroid=(x, y, z),
            class_=None if told is None else ClassOut.model_validate(told),
            points=cloud.tolist(),
        )
        for segment, (x, y, z), told, cloud in zip(
            content.ids.tolist(), content.centroids.tolist(), listed, clouds, strict=True
        )
    ]


def decoder_of(state: State, snapshot: MapSnapshot) -> ShapeDecoder:
    """Return the decoder of a map's model.

    Raises:
        Problem: 409 if the model is not loaded, or has no decoder.
    """
    model = state.engine.models.find(snapshot.model_id)
    if model is None:
        raise state.engine.models.unknown(snapshot.model_id)
    decoder = state.engine.models.shape_decoder(model)
    if decoder is None:
        raise Problem(
            409,
            "no-shapes",
            f"Model {model.manifest.name} of map {snapshot.name} has no shape decoder. Train one "
            "with 'placecell train-shapes', or use a map of a model that has one.",
        )
    return decoder
