"""`/describe`: segments in, descriptors out."""

from typing import Any

from fastapi import APIRouter, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, MSGPACK, Body, answer_type, parse, render
from service.api.body.problem_json import documented
from service.api.openapi import body_of, packed_response
from service.api.schemas.msgpack import PackedDescribeRequest, PackedDescribeResponse
from service.api.schemas.recognition import DescribeRequest, DescribeResponse
from service.api.state import HolderOf, State, StateOf, TimingOf
from service.core.timing import Timing
from service.inference.describer import Described, Prepared
from service.inference.model_registry import Model
from service.inference.scan import Scan

router = APIRouter(tags=["recognition"])


@router.post(
    "/describe",
    summary="Descriptors of a scan's segments",
    response_model=DescribeResponse,
    responses=packed_response(PackedDescribeResponse)
    | documented(400, 401, 406, 408, 409, 413, 415, 422, 429, 503, 504),
    openapi_extra=body_of(DescribeRequest, PackedDescribeRequest),
)
async def describe(
    request: Request, state: StateOf, holder: HolderOf, timing: TimingOf
) -> Response:
    """One result a segment, in order: its descriptor, or why it could not be used.

    If no segment can be used, the answer is a 422 instead.
    """
    del holder  # any key will do
    answer = answer_type(request)
    async with state.recognition.admit(request, ENCODINGS, timing) as body:
        model, prepared = await state.compute(_read, state, body, timing)
        request.state.model_id = model.id
        described = await model.describer.describe(prepared, timing)
        content = await state.compute(_written, model, described, prepared, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def _read(state: State, body: Body, timing: Timing) -> tuple[Model, Prepared]:
    timing.lap("queue")
    request = parse(DescribeRequest, PackedDescribeRequest, body, state.settings.limits)
    model = state.models.named(request.model)
    return model, model.describer.prepare(Scan.of(request.segments, request.origin), timing)


def _written(
    model: Model, described: Described, prepared: Prepared, answer: str, timing: Timing
) -> bytes:
    timing.lap("queue")
    item = _packed if answer == MSGPACK else _listed
    # What `DescribeResponse` says, without its checks: the values are our own.
    response = {
        "model_id": model.id,
        "dimension": model.manifest.dimension,
        "descriptors": [
            item(described, row) if isinstance(row, int) else row.model_dump()
            for row in described.rows
        ],
        "dropped_points": prepared.dropped_points,
    }
    content = render(response, answer)
    timing.lap("encode")
    return content


def _listed(described: Described, row: int) -> dict[str, Any]:
    return {
        "codes": described.codes[row].tolist(),
        "descriptor": described.descriptors[row].tolist(),
        "centroid": described.centroids[row].tolist(),
    }


def _packed(described: Described, row: int) -> dict[str, Any]:
    return {
        "codes": described.codes[row].tobytes(),
        "descriptor": described.descriptors[row].astype("<f4").tobytes(),
        "centroid": described.centroids[row].tolist(),
    }
