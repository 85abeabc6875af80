"""What `/describe` and `/match` take and answer, as JSON; `packed_schemas` has it as msgpack."""

from typing import Annotated, Generic, Self, TypeVar

from placecell_client.maps.compact_map import COORDINATE_LIMIT
from pydantic import BaseModel, ConfigDict, Field, JsonValue, model_validator

from service.core.settings import NAMED_MAPS

Coordinate = Annotated[
    float, Field(strict=True, allow_inf_nan=False, ge=-COORDINATE_LIMIT, le=COORDINATE_LIMIT)
]
Point = tuple[Coordinate, Coordinate, Coordinate]
Name = Annotated[str, Field(strict=True)]
Code = Annotated[int, Field(strict=True, ge=-128, le=127)]
Codes = Annotated[
    list[Annotated[list[Code], Field(fail_fast=True)]], Field(fail_fast=True, min_length=1)
]

SegmentT = TypeVar("SegmentT")
CodesT = TypeVar("CodesT")
DescriptorT = TypeVar("DescriptorT")

# fail_fast: a list of a million wrong values is one error, not a million.


class Request(BaseModel):
    """What all requests share: a field that is not known is an error."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SegmentIn(Request):
    """A segment: the points of one object, and where it was seen from."""

    points: Annotated[list[Point], Field(fail_fast=True)] = Field(
        description="x, y, z in metres, z up; one frame for all segments of the request."
    )
    sensor: Point = Field(description="Where the sensor was at capture, in the same frame.")


class ScanRequest(Request, Generic[SegmentT]):
    """The segments of one scan, in either encoding."""

    model: Name | None = Field(
        None, description="Id or name of a loaded model; the default one unless said."
    )
    segments: Annotated[list[SegmentT], Field(fail_fast=True)] = Field(min_length=1)
    origin: Point | None = Field(
        None, description="Added to all points and sensors, metres; for coordinates as float32."
    )


class QueryRequest(Request, Generic[SegmentT, CodesT]):
    """Queries, as segments or as descriptors, and where to look for them, in either encoding."""

    segments: Annotated[list[SegmentT], Field(fail_fast=True)] | None = Field(None, min_length=1)
    origin: Point | None = Field(None, description="Of the segments, as for `/describe`.")
    model_id: Name | None = Field(None, description="Of the model that made the codes.")
    codes: CodesT | None = Field(None, description="Stored descriptors, as `/describe` gives them.")
    maps: Annotated[list[Name], Field(fail_fast=True, max_length=NAMED_MAPS)] | None = Field(
        None,
        min_length=1,
        description=f"Names of at most {NAMED_MAPS:,} maps; default: all maps of loaded models.",
    )
    k: int = Field(10, ge=1, strict=True, description="Candidates a query, at most.")

    @model_validator(mode="after")
    def _one_kind_of_query(self) -> Self:
        codes = self.codes is not None and self.model_id is not None
        for_codes = codes and self.segments is None and self.origin is None
        for_segments = self.segments is not None and self.codes is None and self.model_id is None
        if not for_codes and not for_segments:
            raise ValueError("give either segments, or model_id and codes")
        return self


EXAMPLE: dict[str, JsonValue] = {
    "points": [[8.0, 2.0 + step / 8, step / 4] for step in range(12)],
    "sensor": [0.0, 0.0, 1.8],
}
"""A segment that can be described: the smallest, for the eye."""


class DescribeRequest(ScanRequest[SegmentIn]):
    """The segments of one scan."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE]}]})


class MatchRequest(QueryRequest[SegmentIn, Codes]):
    """Queries, as segments or as descriptors, and where to look for them."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE], "k": 5}]})


class ItemErrorOut(BaseModel):
    """Why one segment could not be used, while others of the request were."""

    type: str
    title: str
    detail: str


class Failed(BaseModel):
    """In the place of a segment that could not be used."""

    error: ItemErrorOut


class DescriptorOut(BaseModel):
    """A segment's descriptor."""

    codes: list[int] = Field(description="The stored form, int8, for maps and for `/match`.")
    descriptor: list[float] = Field(description="Before it was rounded to codes.")
    centroid: Point = Field(description="Mean of the points, metres, in the request's frame.")


class DescriptorsResponse(BaseModel, Generic[DescriptorT]):
    """Descriptors in the order of the segments, in either encoding."""

    model_id: str
    dimension: int
    descriptors: list[DescriptorT | Failed]
    dropped_points: int = Field(
        default=0, description="Points that were not finite, in msgpack, and were left out."
    )


class DescribeResponse(DescriptorsResponse[DescriptorOut]):
    """Descriptors in the order of the segments."""


class CandidateOut(BaseModel):
    """A segment of a map that looks like the query."""

    map: str
    id: int
    robot: str
    distance: float = Field(description="Euclidean, between stored descriptors.")
    probability: float | None = Field(None, description="Null: the model has no classifier.")
    centroid: Point = Field(description="Metres, in the map's frame.")
    frame: str = Field(description="Name of the map's frame.")
    model_id: str = Field(
        description="Model that made the map. Its pair classifier gives the probability and its "
        "descriptors the distance; neither is calibrated against another model's."
    )


class CandidatesOut(BaseModel):
    """Candidates of one query, nearest first; those of several models by probability."""

    candidates: list[CandidateOut]


class SkippedOut(BaseModel):
    """A map that was not searched: its model is not loaded, or not the one that made the codes."""

    map: str
    model_id: str


class MatchResponse(BaseModel):
    """Candidates in the order of the queries."""

    model_id: str
    queries: list[CandidatesOut | Failed]
    dropped_points: int = Field(
        default=0, description="Points that were not finite, in msgpack, and were left out."
    )
    searched: list[str]
    skipped: list[SkippedOut] = Field(description="Maps whose model is not loaded, or not asked.")
