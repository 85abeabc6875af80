"""What goes over the wire of `/localize`, as JSON; `packed_schemas` has the request as msgpack."""

from typing import Annotated, Generic, Literal, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, model_validator

from placecell.localization.localize import Reason
from service.api.schemas.recognition import (
    EXAMPLE,
    Codes,
    CodesT,
    ItemErrorOut,
    Point,
    QueryRequest,
    SegmentIn,
    SegmentT,
    SkippedOut,
)

CentroidsT = TypeVar("CentroidsT")

SessionId = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9._-]{1,64}$")]


class LocalizeQuery(QueryRequest[SegmentT, CodesT], Generic[SegmentT, CodesT, CentroidsT]):
    """What a robot sees, and where it may be, in either encoding."""

    centroids: CentroidsT | None = Field(
        None, description="Of the codes, metres, all in one z-up frame of the robot's."
    )
    k: int = Field(25, ge=1, strict=True, description="Candidates a segment, at most.")
    motion: Literal["yaw", "se3"] = Field(
        "yaw", description="Yaw and translation, for gravity is known; or all six degrees."
    )
    session: SessionId | None = Field(
        None,
        description="Any id that the robot alone uses, for requests in one odometry frame: those "
        "of the last seconds support each other, one that is sent again once.",
    )

    @model_validator(mode="after")
    def _centroids_of_codes(self) -> Self:
        if (self.codes is None) != (self.centroids is None):
            raise ValueError("give centroids with codes, and not with segments")
        return self


class LocalizeRequest(
    LocalizeQuery[SegmentIn, Codes, Annotated[list[Point], Field(fail_fast=True, min_length=1)]]
):
    """What a robot sees, as segments or as descriptors with centroids, and where it may be."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE]}]})


class PoseOut(BaseModel):
    """A rigid transform: rotation @ point + translation."""

    translation: Point = Field(description="Metres.")
    rotation: tuple[float, float, float, float] = Field(
        description="Unit quaternion x, y, z, w; w is not negative."
    )
    yaw: float = Field(description="Radians, -pi to pi: where the x axis points, from above.")


class InlierOut(BaseModel):
    """A segment that agrees with the pose."""

    query: int = Field(description="Index of the segment in the request.")
    id: int = Field(description="Of the map's segment that it was found as.")
    residual: float = Field(description="Metres between the two, by the pose.")


class HypothesisOut(BaseModel):
    """Another place where the robot may be."""

    pose: PoseOut
    score: float
    inliers: int = Field(description="How many segments agree with it.")


class RivalOut(HypothesisOut):
    """Best pose in another map that is not known to show the same place."""

    map: str
    frame: str = Field(description="Name of the other map's frame, in which the pose is given.")


class LocalisationOut(BaseModel):
    """What one map says of the robot's place."""

    map: str
    frame: str = Field(description="Name of the map's frame.")
    localised: bool
    reason: Reason | None = Field(description="Why the robot is not localised; null if it is.")
    detail: str = Field(description="The reason in words; empty if there is none.")
    probability: float = Field(
        description="Probability that the best hypothesis is right: within 1 m and 3 degrees, in "
        "the right map. All maps of the request are judged together."
    )
    pose: PoseOut | None = Field(
        description="Of the request's frame in the map's; null if the robot is not localised."
    )
    covariance: list[list[float]] | None = Field(
        description="Of small changes along the map's axes, the translation's (metres) and the "
        "rotation's (radians) applied after the pose's own: x, y, z, yaw; or x, y, z, and about "
        "x, y, z. It is of the frame's origin: large where the robot is far from that."
    )
    score: float = Field(
        description="Evidence for the pose: the sum over its inliers. Scores are comparable "
        "between maps of one model in one answer."
    )
    inliers: list[InlierOut]
    others: list[HypothesisOut] = Field(
        description="Second-best hypothesis; the best one first where the robot is not localised."
    )
    rival: RivalOut | None = Field(
        description="Best pose in another map of the request. Null if no other map has one. Maps "
        "with the same segments are no rivals: a merged map and its sources are one place."
    )


class UnusableOut(BaseModel):
    """A segment that could not be used, while others of the request were."""

    query: int = Field(description="Index of the segment in the request.")
    error: ItemErrorOut


class LocalizeResponse(BaseModel):
    """Answers of all maps, the most probable first; equally probable ones by score."""

    model_id: str
    localisations: list[LocalisationOut]
    unusable: list[UnusableOut]
    dropped_points: int = Field(
        default=0, description="Number of non-finite points (msgpack only) that were left out."
    )
    skipped: list[SkippedOut] = Field(description="Maps whose model is not loaded, or not asked.")
