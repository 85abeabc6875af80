"""`/describe`: segments in, descriptors out."""

from fastapi import APIRouter, Request, Response

from service.bodies import ENCODINGS, MSGPACK, Body, answer_type, parse, read_body, render
from service.describer import Described, Scan
from service.openapi import body_of, packed_response
from service.packed_schemas import PackedDescribeRequest, PackedDescribeResponse, PackedDescriptor
from service.problems import documented
from service.schemas import DescribeRequest, DescribeResponse, DescriptorOut
from service.state import State, StateOf

router = APIRouter(tags=["recognition"])


@router.post(
    "/describe",
    summary="Descriptors of a scan's segments",
    response_model=DescribeResponse,
    responses=packed_response(PackedDescribeResponse) | documented(400, 406, 413, 415, 422),
    openapi_extra=body_of(DescribeRequest, PackedDescribeRequest),
)
async def describe(request: Request, state: StateOf) -> Response:
    """One result a segment, in order: its descriptor, or why it could not be used.

    If no segment can be used, the answer is a 422 instead.
    """
    answer = answer_type(request)
    body = await read_body(request, ENCODINGS)
    return Response(await state.compute(_describe, state, body, answer), media_type=answer)


def _describe(state: State, body: Body, answer: str) -> bytes:
    request = parse(DescribeRequest, PackedDescribeRequest, body, state.settings.limits)
    described = state.describer.describe(Scan.of(request.segments, request.origin))
    response = _packed if answer == MSGPACK else _listed
    return render(response(state, described), answer)


def _listed(state: State, described: Described) -> DescribeResponse:
    codes = described.codes.tolist()
    descriptors = described.descriptors.tolist()
    centroids = described.centroids.tolist()
    return DescribeResponse(
        model_id=state.model_id,
        dimension=state.describer.manifest.dimension,
        descriptors=[
            DescriptorOut(codes=codes[row], descriptor=descriptors[row], centroid=centroids[row])
            if isinstance(row, int)
            else row
            for row in described.rows
        ],
    )


def _packed(state: State, described: Described) -> PackedDescribeResponse:
    descriptors = described.descriptors.astype("<f4")
    centroids = described.centroids.tolist()
    return PackedDescribeResponse(
        model_id=state.model_id,
        dimension=state.describer.manifest.dimension,
        descriptors=[
            PackedDescriptor(
                codes=described.codes[row].tobytes(),
                descriptor=descriptors[row].tobytes(),
                centroid=centroids[row],
            )
            if isinstance(row, int)
            else row
            for row in described.rows
        ],
    )
