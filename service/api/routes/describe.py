"""`/describe`: segments in, descriptors out."""

from typing import Any

from fastapi import APIRouter, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import ENCODINGS, MSGPACK, Body, answer_type, parse, render
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, TimingOf
from service.api.openapi import body_of, packed_response
from service.api.query_parsing import read_scan
from service.api.responses import listed_classes, segment_error
from service.api.schemas.msgpack import PackedDescribeRequest, PackedDescribeResponse
from service.api.schemas.recognition import DescribeRequest, DescribeResponse
from service.api.state import State
from service.core.timing import Timing
from service.inference.describer import Descriptors, PreparedScan
from service.inference.model_registry import Model

router = APIRouter(tags=["recognition"])


@router.post(
    "/describe",
    summary="Describe the segments of a scan",
    response_model=DescribeResponse,
    responses=packed_response(PackedDescribeResponse)
    | documented(400, 401, 406, 408, 409, 413, 415, 422, 429, 503, 504),
    openapi_extra=body_of(DescribeRequest, PackedDescribeRequest),
)
async def describe(
    request: Request, state: StateOf, principal: PrincipalOf, timing: TimingOf
) -> Response:
    """Return one result per segment, in order: its descriptor, or the reason why it has none.

    If no segment can be described, the answer is a 422. If the model has a semantic head, `classes`
    has the class of each segment.
    """
    del principal  # any key may describe
    answer = answer_type(request)
    async with state.lanes.recognition.admit(request, ENCODINGS, timing) as body:
        model, prepared = await state.run(_read, state, body, timing)
        request.state.model_id = model.id
        descriptors = await model.describer.describe(prepared, timing)
        content = await state.run(_written, model, descriptors, answer, timing)
    return await state.answers.respond(content, client_of(request), answer)


def _read(state: State, body: Body, timing: Timing) -> tuple[Model, PreparedScan]:
    timing.lap("queue")
    request = parse(DescribeRequest, PackedDescribeRequest, body, state.settings.limits)
    model = state.engine.models.named(request.model)
    scan = read_scan(request.segments, request.origin)
    return model, model.describer.prepare(scan, timing)


def _written(model: Model, descriptors: Descriptors, answer: str, timing: Timing) -> bytes:
    timing.lap("queue")
    item = _packed if answer == MSGPACK else _listed
    # The same as a `DescribeResponse`, without its checks: the values are our own.
    response = {
        "model_id": model.id,
        "dimension": model.manifest.dimension,
        "descriptors": [
            segment_error(descriptors.errors[index])
            if index in descriptors.errors
            else item(descriptors, index)
            for index in range(len(descriptors))
        ],
        "dropped_points": descriptors.dropped_points,
    }
    classes = descriptors.classes
    if classes is not None:
        response["classes"] = classes.tobytes() if answer == MSGPACK else listed_classes(classes)
    content = render(response, answer)
    timing.lap("encode")
    return content


def _listed(descriptors: Descriptors, index: int) -> dict[str, Any]:
    assert descriptors.values is not None
    assert descriptors.centroids is not None
    return {
        "codes": descriptors.codes[index].tolist(),
        "descriptor": descriptors.values[index].tolist(),
        "centroid": descriptors.centroids[index].tolist(),
    }


def _packed(descriptors: Descriptors, index: int) -> dict[str, Any]:
    assert descriptors.values is not None
    assert descriptors.centroids is not None
    return {
        "codes": descriptors.codes[index].tobytes(),
        "descriptor": descriptors.values[index].astype("<f4").tobytes(),
        "centroid": descriptors.centroids[index].tolist(),
    }
