"""Schemas of msgpack bodies: those of JSON, with arrays as binary blobs.

`docs/reference/msgpack.md` describes it byte by byte, for clients in any language.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from placecell_client.maps.compact_map import COORDINATE_LIMIT
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    PlainValidator,
    ValidationError,
    WithJsonSchema,
    field_validator,
    model_validator,
)
from pydantic_core import InitErrorDetails

from placecell.core.segment_classes import HIGHEST
from placecell.core.types import Float32, Float64, Int8, UInt8
from service.api.schemas.localization import LocalizeQuery
from service.api.schemas.recognition import (
    DescriptorsResponse,
    MatchQuery,
    Point,
    Request,
    ScanRequest,
)


@dataclass(frozen=True, slots=True)
class Pairs:
    """Key-value pairs of a msgpack map as read, before the check for duplicate keys."""

    items: list[tuple[object, object]]


def _points(blob: object) -> Float32:
    """Decode the points of a blob, float32 (n, 3); some may not be finite."""
    return np.asarray(_coordinates(blob, np.dtype("<f4"), infinite=True), np.float32)


def _centroids(blob: object) -> Float64:
    """Decode the centroids of a blob, float64 (n, 3)."""
    return np.asarray(_coordinates(blob, np.dtype("<f8")), np.float64)


def _coordinates(
    blob: object, kind: "np.dtype[np.floating[Any]]", *, infinite: bool = False
) -> "NDArray[np.floating[Any]]":
    """Decode the points of a blob, (n, 3), without a check per point.

    Args:
        blob: the bytes.
        kind: type of a coordinate.
        infinite: accept NaN and infinity.

    Raises:
        ValueError: the blob holds no such points; location and message are those of JSON.
    """
    data = _bin(blob)
    size = 3 * kind.itemsize
    if len(data) % size:
        raise ValueError(
            f"found {len(data)} bytes, expected a multiple of {size}: x, y, z as {kind.name}"
        )
    points = np.frombuffer(data, kind).reshape(-1, 3)
    # Written so that NaN fails too.
    if not (
        points.max(initial=0) <= COORDINATE_LIMIT and points.min(initial=0) >= -COORDINATE_LIMIT
    ):
        wrong = ~(np.abs(points) <= COORDINATE_LIMIT)
        if infinite:
            wrong &= np.isfinite(points)
        if wrong.any():
            row, axis = (int(place) for place in np.argwhere(wrong)[0])
            raise _out_of_range((row, axis), float(points[row, axis]))
    return points


def _codes(blob: object) -> Int8:
    """Decode the codes of a blob, int8 (q * c,); only the model knows c, the bytes of a code."""
    data = _bin(blob)
    if not data:
        raise ValueError("expected at least one code, found 0 bytes")
    return np.frombuffer(data, np.int8)


def _classes(blob: object) -> UInt8:
    """Decode the classes of a blob, uint8 (q,)."""
    classes = np.frombuffer(_bin(blob), np.uint8)
    if not len(classes):
        raise ValueError("expected at least one class, found 0 bytes")
    if classes.max() > HIGHEST:
        raise ValueError(f"found the byte {classes.max()}, expected 0 to {HIGHEST}")
    return classes


def _bin(value: object) -> bytes:
    if not isinstance(value, bytes):
        raise ValueError("expected binary data (bin)")
    return value


def _out_of_range(place: tuple[int, int], value: float) -> ValidationError:
    error = InitErrorDetails(type="finite_number", loc=place, input=value)
    if np.isfinite(value):
        limit = COORDINATE_LIMIT
        if value > 0:
            error |= {"type": "less_than_equal", "ctx": {"le": limit}}
        else:
            error |= {"type": "greater_than_equal", "ctx": {"ge": -limit}}
    return ValidationError.from_exception_data("points", [error])


_BLOB = WithJsonSchema({"type": "string", "format": "binary"})
PointsBlob = Annotated[Float32, PlainValidator(_points), _BLOB]
CentroidsBlob = Annotated[Float64, PlainValidator(_centroids), _BLOB]
CodesBlob = Annotated[Int8, PlainValidator(_codes), _BLOB]
ClassesBlob = Annotated[UInt8, PlainValidator(_classes), _BLOB]


def _keyed(value: object) -> dict[str, object]:
    """Return a msgpack map as a dictionary.

    Raises:
        ValueError: it is no map, or its keys are not distinct strings.
    """
    if not isinstance(value, Pairs):
        raise ValueError("expected a map")
    content: dict[str, object] = {}
    for key, item in value.items:
        if not isinstance(key, str):
            raise ValueError("expected strings as keys")
        if key in content:
            raise ValueError(f"found the key {key!r:.100} twice")
        content[key] = item
    return content


class PackedRequest(Request):
    """Request as a msgpack map whose keys are distinct strings."""

    model_config = ConfigDict(arbitrary_types_allowed=True)

    @model_validator(mode="before")
    @classmethod
    def _keys(cls, value: object) -> dict[str, object]:
        return _keyed(value)


class PackedSegment(PackedRequest):
    """Segment: the points of one object and the position of the sensor that saw it."""

    points: PointsBlob = Field(
        description="float32, little-endian: x, y, z of the first point in meters, then of the "
        "next. Points with NaN or infinity are left out and counted in the answer."
    )
    sensor: Point = Field(
        description="Sensor position at capture, meters, in the frame of the points."
    )


class PackedDescribeRequest(PackedRequest, ScanRequest[PackedSegment]):
    """`DescribeRequest` as msgpack."""


class PackedMatchRequest(
    PackedRequest, MatchQuery[PackedSegment, CodesBlob, CentroidsBlob, ClassesBlob]
):
    """`MatchRequest` as msgpack; codes are int8, centroids are little-endian float64 x, y, z."""


def _unpaired(value: object) -> object:
    """Convert the maps in a value to dictionaries."""
    if isinstance(value, Pairs):
        return {key: _unpaired(item) for key, item in _keyed(value).items()}
    return value


class PackedLocalizeRequest(
    PackedRequest, LocalizeQuery[PackedSegment, CodesBlob, CentroidsBlob, ClassesBlob]
):
    """`LocalizeRequest` as msgpack; codes are int8, centroids are little-endian float64 x, y, z."""

    @field_validator("hints", mode="before")
    @classmethod
    def _hints(cls, value: object) -> object:
        return _unpaired(value)


class PackedDescriptor(BaseModel):
    """Descriptor of one segment."""

    codes: bytes = Field(description="Stored descriptor, `code_bytes` values of int8.")
    descriptor: bytes = Field(
        description="Descriptor before it was rounded to `codes`, d values "
        "of little-endian float32."
    )
    centroid: Point = Field(description="Mean of the points, meters, in the frame of the request.")


class PackedDescribeResponse(DescriptorsResponse[PackedDescriptor, bytes]):
    """`DescribeResponse` as msgpack."""
