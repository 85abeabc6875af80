"""JSON requests whose arrays are parsed without the interpreter's lock; see `json_arrays`.

The schemas of `service.api.schemas` define valid requests and describe errors. The schemas here
accept the same bodies with each array cut out, and return the same values as NumPy arrays.
"""

from typing import Annotated, Any, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict, PlainValidator, ValidationError, ValidationInfo

from placecell.core.types import Float64, Int8
from service.api.body.json_arrays import CENTROIDS, NAMES, POINTS, Arrays, cut_arrays, moved
from service.api.schemas.localization import LocalizeQuery, LocalizeRequest
from service.api.schemas.recognition import (
    DescribeRequest,
    MatchQuery,
    MatchRequest,
    Point,
    QueryClasses,
    Request,
    ScanRequest,
)
from service.core.problems import Problem, errors_of, invalid, invalid_values
from service.core.settings import Limits

Schema = TypeVar("Schema", bound=BaseModel)

CODE_VALUES = 1_000
"""Largest number of values of a code that are kept. Codes of all models are shorter."""
REST_BYTES = 2_048
"""Largest size of a body outside its arrays, bytes per segment."""


def _arrays(info: ValidationInfo) -> Arrays:
    assert isinstance(info.context, Arrays)
    return info.context


def _points(value: object, info: ValidationInfo) -> Float64:
    if value == []:
        return np.zeros((0, 3))
    found = _arrays(info).rows(value, POINTS)
    if found is None:
        raise ValueError("no points")
    return found


def _centroids(value: object, info: ValidationInfo) -> Float64:
    found = _arrays(info).rows(value, CENTROIDS)
    if found is None:
        raise ValueError("no centroids")
    return found


def _codes(value: object, info: ValidationInfo) -> Int8 | list[list[int]]:
    found = _arrays(info).code_rows(value)
    if found is None:
        raise ValueError("no codes")
    return found


class CutSegment(Request):
    """`SegmentIn` with its points cut out."""

    model_config = ConfigDict(arbitrary_types_allowed=True)

    points: Annotated[Float64, PlainValidator(_points)]
    sensor: Point


CutCodes = Annotated[Any, PlainValidator(_codes)]
CutCentroids = Annotated[Any, PlainValidator(_centroids)]


class CutDescribeRequest(ScanRequest[CutSegment]):
    """`DescribeRequest` with its arrays cut out."""


class CutMatchRequest(MatchQuery[CutSegment, CutCodes, CutCentroids, QueryClasses]):
    """`MatchRequest` with its arrays cut out."""


class CutLocalizeRequest(LocalizeQuery[CutSegment, CutCodes, CutCentroids, QueryClasses]):
    """`LocalizeRequest` with its arrays cut out."""


CUT: dict[type[BaseModel], type[BaseModel]] = {
    DescribeRequest: CutDescribeRequest,
    MatchRequest: CutMatchRequest,
    LocalizeRequest: CutLocalizeRequest,
}


def read_json(schema: type[Schema], body: bytes, limits: Limits) -> Any:
    """Parse a JSON body by its schema, with arrays as NumPy arrays.

    Raises:
        Problem: 413 if the body holds too many values, 400 if it is not JSON, 422 if it does not
            match the schema.
    """
    arrays = cut_arrays(
        body,
        points=limits.points,
        segments=limits.segments,
        values=CODE_VALUES * limits.segments,
    )
    if arrays.syntax is not None:
        what, offset = arrays.syntax
        raise not_json(f"{what} at line {body.count(10, 0, offset) + 1} "
                       f"column {offset - body.rfind(10, 0, offset)}")  # fmt: skip
    _check_amounts(arrays, limits)
    arrays.cut()
    if len(arrays.text) > REST_BYTES * (limits.segments + 32):
        raise Problem(
            413,
            "too-many-values",
            f"The body has {len(arrays.text)} bytes outside its points and codes; the limit is "
            f"{REST_BYTES * (limits.segments + 32)}. Remove spaces and unknown keys.",
        )
    try:
        return CUT[schema].model_validate_json(arrays.text, context=arrays)
    except ValidationError:
        return _told(schema, arrays)


def _told(schema: type[Schema], arrays: Arrays) -> Schema:
    """Raise the problem of an invalid body.

    Only the text and the first invalid row of each kind are parsed again, which takes little time.

    Raises:
        Problem: the problems of `read_json`.
    """
    try:
        named = arrays.named()
    except ValueError as error:
        raise Problem(422, "invalid-request", f"The body: {error}.") from error
    try:
        schema.model_validate_json(named)
    except ValidationError as error:
        found = errors_of(error)
        for item in found:
            item["loc"] = _moved(item["loc"], arrays)
            item["msg"] = moved(str(item["msg"]), arrays, named)
        raise invalid_values(found) from error
    # The two parsers disagree. The result of the plain schema counts.
    try:
        return schema.model_validate_json(arrays.body)
    except ValidationError as error:
        raise invalid(error) from error


def _moved(place: tuple[int | str, ...], arrays: Arrays) -> tuple[int | str, ...]:
    """Return an error's location in the body, though `named` shows one row of an array only."""
    for kind, name in enumerate(NAMES):
        if name not in place:
            continue
        at = place.index(name) + 1
        if len(place) > at and place[at] == 0:
            return (*place[:at], arrays.row_of(kind), *place[at + 1 :])
    return place


def _check_amounts(arrays: Arrays, limits: Limits) -> None:
    segments, points, codes = arrays.amounts
    for kind, what, amount, limit in (
        ("points", "points", points, limits.points),
        ("segments", "segments", segments, limits.segments),
        ("segments", "queries", codes, limits.segments),
    ):
        if amount > limit:
            detail = f"{amount} {what} in a request; the limit is {limit}. Send several requests."
            raise Problem(413, f"too-many-{kind}", detail)
    # A segment needs five values and those of its sensor. The rest is for the names of maps.
    limit = 16 * limits.segments + 1_000
    if not arrays.complete:
        raise Problem(
            413,
            "too-many-values",
            "The body holds too many values in its points, codes and centroids. The limits are "
            f"{limits.points} points and {limits.segments} segments.",
        )
    if arrays.values > limit:
        raise Problem(
            413,
            "too-many-values",
            f"The body holds {arrays.values} lists, objects and values outside its points and "
            f"codes; the limit is {limit}. Remove unknown keys.",
        )


def not_json(reason: str) -> Problem:
    """Return the problem of a body that is not JSON."""
    return Problem(400, "not-json", f"The body is not JSON: {reason}.")
