"""`/maps/{map}/segments/{id}/shape`: what a stored segment looks like."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Path, Request, Response

from placecell.shapes.decoder import ShapeDecoder
from service.api.admission.admission import client_of
from service.api.body.body import JSON
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf
from service.api.path_parameters import Name
from service.api.responses import listed_classes
from service.api.schemas.recognition import ClassOut
from service.api.schemas.shapes import ShapeOut
from service.api.state import State
from service.clouds.map_shapes import decoded_points
from service.core.problems import Problem
from service.maps.snapshot import MapSnapshot

router = APIRouter(tags=["maps"])

CENTROID_BYTES = 6
"""Bytes of a centroid in a map file."""


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
    points, _ = decoded_points(content, decoder)
    (listed,) = [None] if content.classes is None else listed_classes(content.classes)
    optional = 3 * (content.extents is not None) + 2 * (content.points is not None)
    x, y, z = content.centroids[0].tolist()
    shape = ShapeOut(
        map=snapshot.name,
        id=segment,
        model_id=snapshot.model_id,
        bytes=content.codes.shape[1] + CENTROID_BYTES + optional,
        voxel_m=decoder.voxel,
        centroid=(x, y, z),
        class_=None if listed is None else ClassOut(**listed),
        points=points.astype(np.float64).round(2).tolist(),
    )
    return shape.model_dump_json(by_alias=True).encode()


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
