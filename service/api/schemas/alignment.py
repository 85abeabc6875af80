"""What the service answers about how maps lie to each other."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from placecell.localization.localize import Reason
from service.api.schemas.localization import PoseOut
from service.core.settings import NAMED_MAPS
from service.maps.store import NAME_PATTERN


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
    reason: Reason | None = Field(description="Why the maps are not aligned; null if they are.")
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


class MergeRequest(BaseModel):
    """What to merge into a site map."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"examples": [{"maps": ["yard", "hall"], "dry_run": True}]},
    )

    maps: Annotated[
        list[Annotated[str, Field(strict=True, pattern=NAME_PATTERN)]], Field(fail_fast=True)
    ] = Field(
        min_length=1,
        max_length=NAMED_MAPS,
        description="Names. A new site takes the frame of the first, and needs two or more.",
    )
    dry_run: bool = Field(False, strict=True, description="Only tell what would be done.")
    deduplicate: bool = Field(
        True,
        strict=True,
        description="Leave out what another map's segment shows already, from the same side or "
        "alike.",
    )
    motion: Literal["yaw", "se3"] = Field(
        "yaw", description="Yaw and translation, for frames are level; or all six degrees."
    )


class MergePairOut(BaseModel):
    """What was found of two of the maps."""

    map: str
    other: str
    aligned: bool
    rejected: bool = Field(description="Loops rule the alignment out.")
    proven: bool = Field(description="The alignment is part of a loop that closes.")
    reason: Reason | None
    detail: str
    pose: PoseOut | None = Field(description="Of the other map's frame in the map's.")
    overlap: OverlapOut | None
    score: float
    agreement: float
    pairs: int


class LoopOut(BaseModel):
    """A way around from map to map, back to the first."""

    maps: list[str]
    metres: float = Field(description="By which one misses where one began.")
    degrees: float = Field(description="By which one is turned then.")
    closes: bool


class MergedPartOut(BaseModel):
    """What became of a map."""

    map: str
    etag: str = Field(description="Of the version that was merged.")
    merged: bool = Field(description="False: it could not be laid on the site, and was left out.")
    pose: PoseOut | None = Field(description="Of the map's frame in the site's.")
    added: int = Field(description="Segments that are new in the site.")
    known: int = Field(description="Segments that were merged before, and stay as they are.")
    repeats: int = Field(
        description="Segments left out, for another map's segment shows the same (`deduplicate`)."
    )
    removed: int = Field(
        description="Segments merged before that the map no longer has, or has replaced."
    )


class MergedOut(BaseModel):
    """What a merge did, or would do."""

    map: str = Field(description="The site.")
    frame: str = Field(description="Name of its coordinate frame.")
    dry_run: bool
    sequence: int | None = Field(description="Of the site's version after it; null: dry run.")
    etag: str | None = Field(description="Of that version; null: dry run.")
    previous: int | None = Field(
        description="The site's version before. To undo: POST /maps/MAP/versions/PREVIOUS/restore; "
        "where it is null there was no site: DELETE /maps/MAP."
    )
    segments: int = Field(description="In the site after it.")
    changed: int = Field(description="Segments added or replaced.")
    removed: int
    parts: list[MergedPartOut] = Field(description="In the order of the request.")
    alignments: list[MergePairOut] = Field(description="Of each two of site and maps.")
    loops: list[LoopOut]
