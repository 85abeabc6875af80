"""Schemas of `/describe` and `/match` as JSON; `schemas.msgpack` has the msgpack form."""

from typing import Annotated, Generic, Literal, Self, TypeVar

from placecell_client.maps.compact_map import COORDINATE_LIMIT, TIME_LIMIT
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, JsonValue, model_validator

from service.core.settings import NAMED_MAPS

Coordinate = Annotated[
    float, Field(strict=True, allow_inf_nan=False, ge=-COORDINATE_LIMIT, le=COORDINATE_LIMIT)
]
Point = tuple[Coordinate, Coordinate, Coordinate]
Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Time = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-TIME_LIMIT, le=TIME_LIMIT)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
UnitPart = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-2, le=2)]
Quaternion = tuple[UnitPart, UnitPart, UnitPart, UnitPart]
Covariance = Annotated[
    list[Annotated[list[Finite], Field(min_length=3, max_length=6)]],
    Field(min_length=3, max_length=6),
]
Name = Annotated[str, Field(strict=True)]
ClassName = Literal["building", "vegetation", "pole", "vehicle", "person", "fence", "sign", "other"]
IgnoredName = Literal[
    "building", "vegetation", "pole", "vehicle", "person", "fence", "sign", "other", "movable"
]


def _listed(value: object) -> object:
    """Return a single name as a list."""
    return [value] if isinstance(value, str) else value


ClassNames = Annotated[
    list[ClassName],
    Field(min_length=1, max_length=32),
    BeforeValidator(_listed, json_schema_input_type=ClassName | list[ClassName]),
]
IgnoredNames = Annotated[
    list[IgnoredName],
    Field(max_length=32),
    BeforeValidator(_listed, json_schema_input_type=IgnoredName | list[IgnoredName]),
]
Code = Annotated[int, Field(strict=True, ge=-128, le=127)]
Centroids = Annotated[list[Point], Field(fail_fast=True, min_length=1)]
Codes = Annotated[
    list[Annotated[list[Code], Field(fail_fast=True)]], Field(fail_fast=True, min_length=1)
]

SegmentT = TypeVar("SegmentT")
CodesT = TypeVar("CodesT")
CentroidsT = TypeVar("CentroidsT")
DescriptorT = TypeVar("DescriptorT")
ClassesT = TypeVar("ClassesT")

# fail_fast: a list of a million wrong values is one error, not a million.


class Request(BaseModel):
    """Base of all requests; an unknown field is an error."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SegmentIn(Request):
    """Segment: the points of one object and the position of the sensor that saw it."""

    points: Annotated[list[Point], Field(fail_fast=True)] = Field(
        description="Points x, y, z in meters, z up, in one frame for all segments of the request."
    )
    sensor: Point = Field(
        description="Sensor position at capture, meters, in the frame of the points."
    )


class ClassIn(Request):
    """Class of a segment, as `/describe` returns it."""

    name: ClassName
    probability: float = Field(
        strict=True, allow_inf_nan=False, ge=0, le=1, description="Probability of this class."
    )


QueryClasses = Annotated[list[ClassIn | None], Field(fail_fast=True, min_length=1)]


class ScanRequest(Request, Generic[SegmentT]):
    """Segments of one scan, in either encoding."""

    model: Name | None = Field(
        None, description="Id or name of a loaded model. Default: the default model of the service."
    )
    segments: Annotated[list[SegmentT], Field(fail_fast=True)] = Field(min_length=1)
    origin: Point | None = Field(
        None,
        description="Offset in meters that is added to all points and sensor positions. It "
        "keeps large coordinates exact when the points are float32.",
    )


class QueryRequest(Request, Generic[SegmentT, CodesT, ClassesT]):
    """Queries, as segments or as descriptors, and the maps to search, in either encoding."""

    segments: Annotated[list[SegmentT], Field(fail_fast=True)] | None = Field(None, min_length=1)
    origin: Point | None = Field(None, description="Offset of the segments, as for `/describe`.")
    model_id: Name | None = Field(None, description="Id of the model that made `codes`.")
    codes: CodesT | None = Field(
        None, description="Stored descriptors, as `/describe` returns them in `codes`."
    )
    maps: Annotated[list[Name], Field(fail_fast=True, max_length=NAMED_MAPS)] | None = Field(
        None,
        min_length=1,
        description=f"Names of at most {NAMED_MAPS:,} maps. Default: all maps of loaded models.",
    )
    tags: Annotated[list[Name], Field(fail_fast=True, max_length=32)] | None = Field(
        None, min_length=1, description="Search only maps that have all of these tags."
    )
    k: int = Field(10, ge=1, strict=True, description="Largest number of candidates per query.")
    classes: ClassNames | None = Field(
        None,
        description="Search only map segments of these classes. A segment whose class is unknown "
        "has none of them. Queries of other classes are left out; queries of an unknown class are "
        "searched. Null: all segments.",
    )
    ignore: IgnoredNames | None = Field(
        None,
        description="Leave out map segments and queries of these classes; `movable` names vehicle "
        "and person. A segment whose class is unknown is never left out.",
    )
    query_classes: ClassesT | None = Field(
        None,
        description="Class of each code's segment, as `/describe` returns it in `classes`. Only "
        "`classes` and `ignore` use it.",
    )

    @model_validator(mode="after")
    def _one_kind_of_query(self) -> Self:
        codes = self.codes is not None and self.model_id is not None
        for_codes = codes and self.segments is None and self.origin is None
        for_segments = self.segments is not None and self.codes is None and self.model_id is None
        if not for_codes and not for_segments:
            raise ValueError("the request needs either segments, or model_id and codes")
        if self.query_classes is not None and not for_codes:
            raise ValueError("the request has segments, so it needs no query_classes")
        return self


EXAMPLE: dict[str, JsonValue] = {
    "points": [[8.0, 2.0 + step / 8, step / 4] for step in range(12)],
    "sensor": [0.0, 0.0, 1.8],
}
"""Example of a segment, as small as one may be."""


class DescribeRequest(ScanRequest[SegmentIn]):
    """Segments of one scan."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE]}]})


class MatchQuery(
    QueryRequest[SegmentT, CodesT, ClassesT], Generic[SegmentT, CodesT, CentroidsT, ClassesT]
):
    """Queries, as segments or as descriptors, and the maps to search, in either encoding."""

    centroids: CentroidsT | None = Field(
        None,
        description="Centroid of each code's segment, meters, in one frame of the robot with z up. "
        "Without centroids, the candidates of codes are not re-ranked.",
    )
    rerank: bool = Field(
        True,
        strict=True,
        description="Order the candidates of each query by the other queries that support them, "
        "and return the best k of 25. All queries must be from one scan.",
    )

    @model_validator(mode="after")
    def _centroids_only_with_codes(self) -> Self:
        if self.codes is None and self.centroids is not None:
            raise ValueError("the request has segments, so it needs no centroids")
        return self


class MatchRequest(MatchQuery[SegmentIn, Codes, Centroids, QueryClasses]):
    """Queries, as segments or as descriptors, and the maps to search."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE], "k": 5}]})


class ItemErrorOut(BaseModel):
    """Error of one segment that could not be used; the others were."""

    type: str
    title: str
    detail: str


class Failed(BaseModel):
    """Placeholder for a segment that could not be used, with the reason."""

    error: ItemErrorOut


class DescriptorOut(BaseModel):
    """Descriptor of one segment."""

    codes: list[int] = Field(
        description="Stored descriptor, int8 values, for map files and for `/match`."
    )
    descriptor: list[float] = Field(description="Descriptor before it was rounded to `codes`.")
    centroid: Point = Field(description="Mean of the points, meters, in the frame of the request.")


class ClassOut(BaseModel):
    """Class of a segment."""

    name: ClassName
    probability: float = Field(
        description="Calibrated probability of this class, 0 to 1, in steps of 1/30.", ge=0, le=1
    )


class DescriptorsResponse(BaseModel, Generic[DescriptorT, ClassesT]):
    """Descriptors in the order of the segments, in either encoding."""

    model_id: str
    dimension: int
    descriptors: list[DescriptorT | Failed]
    dropped_points: int = Field(
        default=0, description="Number of non-finite points (msgpack only) that were left out."
    )
    classes: ClassesT | None = Field(
        default=None,
        description="Class of each segment; null (0 in msgpack) where it is unknown. Absent if the "
        "model has no semantic head. In msgpack, one byte a segment: 0, or 1 + 31 x class + "
        "step, with the probability step / 30.",
    )


class DescribeResponse(DescriptorsResponse[DescriptorOut, list[ClassOut | None]]):
    """Descriptors in the order of the segments."""


class CandidateOut(BaseModel):
    """Segment of a map whose descriptor is near the query's."""

    map: str
    id: int
    robot: str
    distance: float = Field(description="Euclidean distance between the stored descriptors.")
    probability: float | None = Field(
        None,
        description="Probability that both are the same "
        "segment. Null if the model has no pair classifier.",
    )
    support: int | None = Field(
        None,
        description="Number of other queries, at most 32, that have a candidate at the same offset "
        "from this one as from the query, turned by one yaw. Null if the candidates were not "
        "re-ranked.",
    )
    centroid: Point = Field(description="Mean of the points, meters, in the frame of the map.")
    frame: str = Field(description="Name of the frame of the map.")
    model_id: str = Field(
        description="Id of the model that made the map. Distances and probabilities of different "
        "models are not comparable."
    )


class CandidatesOut(BaseModel):
    """Candidates of one query, best first: by distance and support, or by distance alone.

    If several models gave them, the order is by probability and support.
    """

    candidates: list[CandidateOut]


class SkippedOut(BaseModel):
    """Map that was not searched: its model is not loaded or did not make the codes."""

    map: str
    model_id: str


class MatchResponse(BaseModel):
    """Candidates in the order of the queries."""

    model_id: str
    queries: list[CandidatesOut | Failed]
    dropped_points: int = Field(
        default=0, description="Number of non-finite points (msgpack only) that were left out."
    )
    searched: list[str]
    skipped: list[SkippedOut] = Field(
        description="Maps that were not searched, because their "
        "model is not loaded or not the requested one."
    )


class MapCoverageOut(BaseModel):
    """Share of the segments that one map knows."""

    map: str
    frame: str = Field(description="Name of the frame of the map.")
    share: float = Field(
        description="Share of the usable segments whose best candidate in this map is more likely "
        "right than wrong, 0 to 1."
    )
    known: int = Field(description="Number of these segments.")
    probability: float = Field(
        description="Mean of the best match probability of each usable segment in this map; 0 for "
        "a segment without a candidate."
    )


class CoverageResponse(BaseModel):
    """Coverage by each searched map, the largest share first."""

    model_id: str
    segments: int = Field(description="Number of segments that could be used.")
    maps: list[MapCoverageOut]
    dropped_points: int = Field(
        default=0, description="Number of non-finite points (msgpack only) that were left out."
    )
    skipped: list[SkippedOut] = Field(
        description="Maps that were not searched, because their "
        "model is not loaded or not the requested one."
    )
