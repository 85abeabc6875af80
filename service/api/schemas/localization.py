"""Schemas of `/localize` as JSON; `schemas.msgpack` has the msgpack form of the request."""

from typing import Annotated, Generic, Literal, Self

from placecell_client.maps.compact_map import COORDINATE_LIMIT
from pydantic import BaseModel, ConfigDict, Field, model_validator

from placecell.localization.acceptance import LARGEST_RISK
from placecell.localization.localize import HintedReason
from service.api.schemas.anchors import GeoPose
from service.api.schemas.hints import HintsIn, UsedHintsOut
from service.api.schemas.recognition import (
    EXAMPLE,
    Centroids,
    CentroidsT,
    ClassesT,
    Codes,
    CodesT,
    ItemErrorOut,
    Point,
    QueryClasses,
    QueryRequest,
    SegmentIn,
    SegmentT,
    SkippedOut,
)

Height = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=COORDINATE_LIMIT)]
Heights = Annotated[list[Height | None], Field(fail_fast=True, min_length=1)]

SessionId = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9._-]{1,64}$")]


class LocalizeQuery(
    QueryRequest[SegmentT, CodesT, ClassesT], Generic[SegmentT, CodesT, CentroidsT, ClassesT]
):
    """Segments or descriptors that a robot sees, and the maps to search, in either encoding."""

    centroids: CentroidsT | None = Field(
        None,
        description="Centroid of each code's segment, meters, in one frame of the robot with z up.",
    )
    heights: Heights | None = Field(
        None,
        description="Height of each code's segment, the vertical side of its box, meters; null "
        "where it is unknown. With heights, and `extents` in the map, the height of a pose is "
        "mostly better if the map's sensor sees objects up to another height.",
    )
    k: int = Field(25, ge=1, strict=True, description="Largest number of candidates per segment.")
    motion: Literal["yaw", "se3"] = Field(
        "yaw",
        description="Degrees of freedom of the pose: `yaw` is yaw and translation (gravity "
        "is known), `se3` is all six.",
    )
    session: SessionId | None = Field(
        None,
        description="Id of the robot's own choice for its requests in one odometry frame. Requests "
        "of the last seconds with the same id support each other.",
    )

    max_false_acceptance: float | None = Field(
        None,
        gt=0,
        le=LARGEST_RISK,
        strict=True,
        allow_inf_nan=False,
        description="Largest expected share of requests that get a false pose, off by more than "
        "3 m or 10 degrees. A larger value returns more poses. Null: 0.001, or the smallest value "
        "that the model's calibration supports.",
    )
    hints: HintsIn | None = Field(
        None,
        description="Where the robot is, as far as it knows. Hints narrow the answer; they never "
        "make a pose more probable.",
    )
    robot: SessionId | None = Field(
        None,
        description="Name of the robot. `GET /robots` then shows its pose in this answer. The key "
        "needs the right to report the robot's pose.",
    )

    @model_validator(mode="after")
    def _centroids_of_codes(self) -> Self:
        if (self.codes is None) != (self.centroids is None):
            raise ValueError("the request needs centroids with codes, and none with segments")
        if self.heights is not None and self.codes is None:
            raise ValueError("the request has segments, so it needs no heights")
        return self


class LocalizeRequest(LocalizeQuery[SegmentIn, Codes, Centroids, QueryClasses]):
    """Segments, or descriptors with centroids, that a robot sees, and the maps to search."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"segments": [EXAMPLE]}]})


class PoseOut(BaseModel):
    """Rigid transform: rotation @ point + translation."""

    translation: Point = Field(description="Translation x, y, z, meters.")
    rotation: tuple[float, float, float, float] = Field(
        description="Rotation as a unit quaternion x, y, z, w, with w not negative."
    )
    yaw: float = Field(description="Heading of the x axis about z, radians, -pi to pi.")


class InlierOut(BaseModel):
    """Segment that agrees with the pose."""

    query: int = Field(description="Index of the segment in the request.")
    id: int = Field(description="Id of the corresponding segment in the map.")
    residual: float = Field(description="Distance between the two segments under the pose, meters.")


class HypothesisOut(BaseModel):
    """Pose hypothesis: another pose that the robot may have."""

    pose: PoseOut
    score: float
    inliers: int = Field(description="Number of segments that agree with the pose.")


class RivalOut(HypothesisOut):
    """Best pose hypothesis in another map that is not known to show the same place."""

    map: str
    frame: str = Field(description="Name of the other map's frame; the pose is in this frame.")


class PossiblePlaceOut(BaseModel):
    """Place that the request's segments fit."""

    map: str
    frame: str = Field(description="Name of the map's frame.")
    position: Point = Field(
        description="Mean position of the segments that agree with the best hypothesis, as this "
        "place's hypothesis puts them, meters, in the map's frame."
    )
    yaw: float = Field(description="Heading of the request's x axis in the map's frame, radians.")
    score: float


class LocalizationOut(BaseModel):
    """Result of localization in one map."""

    map: str
    frame: str = Field(description="Name of the frame of the map.")
    localized: bool
    reason: HintedReason | None = Field(
        description="Reason why the robot is not localized. Null if it is."
    )
    detail: str = Field(description="Reason in words. Empty if there is none.")
    advice: str = Field(
        description="Instructions for a robot that is not localized. Empty if it is localized."
    )
    meters_to_drive: float | None = Field(
        description="Distance after which the robot sees as many segments as a sure pose usually "
        "needs, meters. Null if it sees enough, or if it is localized."
    )
    places: list[PossiblePlaceOut] = Field(
        description="The two places that look alike, if the reason is `ambiguous`. Otherwise empty."
    )
    places_apart: float | None = Field(
        description="Distance between the two places, meters. Null if there are none, or if they "
        "are in different maps."
    )
    probability: float = Field(
        description="Probability that the best hypothesis is right: in the right map, within 1 m "
        "and 3 degrees. All maps of the request are judged together."
    )
    threshold: float = Field(
        description="Probability that a pose must exceed to be returned. It follows from "
        "`max_false_acceptance` and the model's calibration."
    )
    max_false_acceptance: float | None = Field(
        description="Largest expected share of requests that get a false pose at this threshold. "
        "Null if the model has no calibration."
    )
    pose: PoseOut | None = Field(
        description="Pose of the request's frame in the map's frame. Null if the robot is not "
        "localized."
    )
    geopose: GeoPose | None = Field(
        description="The pose on the Earth: OGC GeoPose 1.0, Basic-Quaternion; the quaternion is "
        "relative to east, north and up. Null if the map has no WGS 84 anchor, or without a pose."
    )
    covariance: list[list[float]] | None = Field(
        description="Covariance of the pose for small changes along the axes of the map: x, y, z "
        "(meters) and yaw (radians); with `se3`, x, y, z and rotations about x, y, z. It "
        "belongs to the origin of the request's frame, so it grows with the robot's distance "
        "from that origin."
    )
    score: float = Field(
        description="Evidence for the pose, summed over its inliers. Scores are comparable between "
        "maps of one model in one answer."
    )
    inliers: list[InlierOut]
    others: list[HypothesisOut] = Field(
        description="Further hypotheses: the second-best one, after the best one if the robot is "
        "not localized."
    )
    rival: RivalOut | None = Field(
        description="Best pose hypothesis in another map of the request. Null if no other map has "
        "one. Maps that share segments are no rivals, for example a merged map and its sources."
    )


class UnusableOut(BaseModel):
    """Segment that could not be used; the others were."""

    query: int = Field(description="Index of the segment in the request.")
    error: ItemErrorOut


class LocalizeResponse(BaseModel):
    """Results of all searched maps: most probable first, then by score."""

    model_id: str
    localizations: list[LocalizationOut]
    unusable: list[UnusableOut]
    dropped_points: int = Field(
        default=0, description="Number of non-finite points (msgpack only) that were left out."
    )
    skipped: list[SkippedOut] = Field(
        description="Maps that were not searched, because their "
        "model is not loaded or not the requested one."
    )
    hints: UsedHintsOut | None = Field(
        None, description="Effect of the request's hints. Null if it has none."
    )
