"""What the service answers about how maps lie to each other."""

from typing import Literal

from pydantic import BaseModel, Field

from service.localise_schemas import PoseOut


class LaidOut(BaseModel):
    """A way to lay the second map on the first."""

    pose: PoseOut = Field(description="Of the second map's frame in the first's.")
    score: float = Field(
        description="What the pairs that agree are worth together: of each how likely the two are "
        "the same, the less, the farther apart they are."
    )
    agreement: float = Field(
        description="Of what should agree where both robots were, how much does, 0 to 1."
    )
    pairs: int = Field(description="Segments of the one that agree with one of the other.")


class PairOut(BaseModel):
    """Two segments that agree."""

    id: int = Field(description="Of the first map.")
    other_id: int = Field(description="Of the second map.")
    residual: float = Field(description="Metres between the two, by the pose.")


class OverlapOut(BaseModel):
    """How much of the two maps is of the same places: of where each robot was, 0 to 1."""

    of_map: float
    of_other: float


class AlignmentOut(BaseModel):
    """How two maps lie to each other."""

    map: str
    etag: str = Field(description="Of the version that was looked at.")
    frame: str = Field(description="Name of the first map's frame.")
    other: str
    other_etag: str
    other_frame: str
    aligned: bool
    reason: Literal["too-few-segments", "inconsistent", "ambiguous"] | None = Field(
        description="Why the maps are not aligned; null if they are."
    )
    detail: str = Field(description="The reason in words; empty if there is none.")
    pose: PoseOut | None = Field(
        description="Of the second map's frame in the first's; null if they are not aligned."
    )
    covariance: list[list[float]] | None = Field(
        description="Of the pose, as `/localize` tells it; of the second frame's origin."
    )
    overlap: OverlapOut | None
    score: float = Field(description="Of the best way, aligned or not; as in `others`.")
    agreement: float = Field(description="Of the best way, aligned or not; as in `others`.")
    pairs: int = Field(description="That agree with the pose.")
    inliers: list[PairOut] = Field(description="These pairs, if they were asked for.")
    others: list[LaidOut] = Field(
        description="The second-best way; the best one first where the maps are not aligned."
    )
