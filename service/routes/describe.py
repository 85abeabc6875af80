"""`/describe`: segments in, descriptors out."""

from fastapi import APIRouter, Request, Response

from service.bodies import JSON, parse, read_body
from service.openapi import json_body
from service.problems import documented
from service.schemas import DescribeRequest, DescribeResponse, DescriptorOut
from service.state import State, StateOf

router = APIRouter(tags=["recognition"])


@router.post(
    "/describe",
    summary="Descriptors of a scan's segments",
    response_model=DescribeResponse,
    responses=documented(400, 413, 415, 422),
    openapi_extra=json_body(DescribeRequest),
)
async def describe(request: Request, state: StateOf) -> Response:
    """One result a segment, in order: its descriptor, or why it could not be used.

    If no segment can be used, the answer is a 422 instead.
    """
    body = await read_body(request, {JSON})
    return Response(await state.compute(_describe, state, body), media_type=JSON)


def _describe(state: State, body: bytes) -> str:
    request = parse(DescribeRequest, body, state.settings.limits)
    described = state.describer.describe(request.segments)
    codes = described.codes.tolist()
    descriptors = described.descriptors.tolist()
    centroids = described.centroids.tolist()
    response = DescribeResponse(
        model_id=state.model_id,
        dimension=state.describer.manifest.dimension,
        descriptors=[
            DescriptorOut(codes=codes[row], descriptor=descriptors[row], centroid=centroids[row])
            if isinstance(row, int)
            else row
            for row in described.rows
        ],
    )
    return response.model_dump_json()
