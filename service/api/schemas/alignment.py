"""Schemas of map alignment and of merging as JSON."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from placecell.localization.localize import Reason
from service.api.schemas.localization import PoseOut
from service.core.settings import NAMED_MAPS
from service.maps.store import NAME_PATTERN


class LaidOut(BaseModel):
    """Alignment hypothesis: a possible pose of the second map in the first."""

    pose: PoseOut = Field(description="Pose of the second map's frame in the first map's frame.")
    score: float = Field(
        description="Evidence: the sum over the agreeing pairs of the match probability, weighted "
        "down with their distance."
    )
    agreement: float = Field(
        description="Share of the segments expected to agree in the overlap that do agree, 0 to 1."
    )
    pairs: int = Field(description="Number of pairs of segments that agree with the pose.")


class PairOut(BaseModel):
    """Pair of segments that agrees with the pose."""

    id: int = Field(description="Id of the segment in the first map.")
    other_id: int = Field(description="Id of the segment in the second map.")
    residual: float = Field(description="Distance between the two segments under the pose, meters.")


class OverlapOut(BaseModel):
    """Share of each map's area that the other map covers too, 0 to 1."""

    of_map: float
    of_other: float


class AlignmentOut(BaseModel):
    """Alignment of two maps."""

    map: str
    etag: str = Field(description="Entity tag of the version that was aligned.")
    frame: str = Field(description="Name of the frame of the first map.")
    other: str
    other_etag: str
    other_frame: str
    aligned: bool
    reason: Reason | None = Field(
        description="Reason why the maps are not aligned. Null if they are."
    )
    detail: str = Field(description="Reason in words. Empty if there is none.")
    pose: PoseOut | None = Field(
        description="Pose of the second map's frame in the first map's frame. Null if they are not "
        "aligned."
    )
    covariance: list[list[float]] | None = Field(
        description="Covariance of the pose, in the form of `/localize`, at the origin of the "
        "second frame."
    )
    overlap: OverlapOut | None
    score: float = Field(description="Value of the best hypothesis, aligned or not; see `others`.")
    agreement: float = Field(
        description="Value of the best hypothesis, aligned or not; see `others`."
    )
    pairs: int = Field(description="Number of pairs of segments that agree with the pose.")
    inliers: list[PairOut] = Field(description="The agreeing pairs, if the request asked for them.")
    others: list[LaidOut] = Field(
        description="Further hypotheses: the second-best one, after the best one if the maps are "
        "not aligned."
    )


class MergeRequest(BaseModel):
    """Maps to merge into one map."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"examples": [{"maps": ["yard", "hall"], "dry_run": True}]},
    )

    maps: Annotated[
        list[Annotated[str, Field(strict=True, pattern=NAME_PATTERN)]], Field(fail_fast=True)
    ] = Field(
        min_length=1,
        max_length=NAMED_MAPS,
        description="Names of the maps to merge. A new merged map takes the frame of the first one "
        "and needs at least two.",
    )
    dry_run: bool = Field(
        False, strict=True, description="Return what the merge would do, and write nothing."
    )
    deduplicate: bool = Field(
        True,
        strict=True,
        description="Leave out segments that another map holds already, seen from the same side or "
        "with nearly the same descriptor.",
    )
    rigid: bool = Field(
        True,
        strict=True,
        description="Move each map as a whole. `false` also removes drift: the merged map is "
        "optimized (`/optimize`) before it is written. 501 if the service has no solver.",
    )
    motion: Literal["yaw", "se3"] = Field(
        "yaw",
        description="Degrees of freedom of the alignment: `yaw` is yaw and translation "
        "(level frames), `se3` is all six.",
    )


class MergePairOut(BaseModel):
    """Alignment of two of the merged maps."""

    map: str
    other: str
    aligned: bool
    rejected: bool = Field(
        description="True if the alignment was rejected, because loops over it do not close."
    )
    proven: bool = Field(description="True if the alignment is part of a loop that closes.")
    reason: Reason | None
    detail: str
    pose: PoseOut | None = Field(description="Pose of the other map's frame in the map's frame.")
    overlap: OverlapOut | None
    score: float
    agreement: float
    pairs: int


class LoopOut(BaseModel):
    """Loop of alignments: from map to map, back to the first one."""

    maps: list[str]
    meters: float = Field(description="Translation error of the loop, meters.")
    degrees: float = Field(description="Rotation error of the loop, degrees.")
    closes: bool


class MergedPartOut(BaseModel):
    """Result of the merge for one map."""

    map: str
    etag: str = Field(description="Entity tag of the version that was merged.")
    merged: bool = Field(
        description="False if the map could not be aligned to the merged map and was left out."
    )
    pose: PoseOut | None = Field(description="Pose of the map's frame in the merged map's frame.")
    added: int = Field(description="Number of segments added to the merged map.")
    known: int = Field(description="Number of segments that were merged before and stay unchanged.")
    repeats: int = Field(
        description="Number of segments left out as duplicates of another map's (`deduplicate`)."
    )
    removed: int = Field(
        description="Number of earlier merged segments that the map removed or replaced since."
    )


class CarriedAnchorOut(BaseModel):
    """Outcome of one anchor of a merged map."""

    map: str = Field(description="Name of the map that has the anchor.")
    anchor: str | None = Field(
        description="Name of the anchor. Null: the place of the map on the Earth."
    )
    outcome: Literal["carried", "kept", "conflict"] = Field(
        description="`carried` into the merged map; `kept`, as the merged map has it already; or "
        "`conflict`, as the merged map has another one, which stays."
    )
    meters: float | None = Field(
        description="Distance from the one that stays, meters. Null if it was carried."
    )


class MergedOut(BaseModel):
    """Result of a merge, or of its dry run."""

    map: str = Field(description="Name of the merged map.")
    frame: str = Field(description="Name of the coordinate frame.")
    dry_run: bool
    sequence: int | None = Field(
        description="Sequence number of the merged map after the merge. Null for a dry run."
    )
    etag: str | None = Field(description="Entity tag of that version. Null for a dry run.")
    previous: int | None = Field(
        description="Version of the merged map before the merge. To undo the merge: POST "
        "/maps/MAP/versions/PREVIOUS/restore. If it is null the map is new: DELETE /maps/MAP."
    )
    segments: int = Field(description="Number of segments in the merged map after the merge.")
    changed: int = Field(description="Number of segments added or replaced.")
    removed: int
    parts: list[MergedPartOut] = Field(
        description="Result for each map, in the order of the request."
    )
    alignments: list[MergePairOut] = Field(description="Alignment of each pair of the maps.")
    loops: list[LoopOut]
    anchors: list[CarriedAnchorOut] = Field(
        description="Outcome of each anchor of the merged maps."
    )
