"""Schemas of `/maps` as JSON."""

from pydantic import BaseModel, Field

from placecell.descriptors.site_calibration import CalibrationState
from service.api.schemas.anchors import GeoAnchorOut
from service.api.schemas.recognition import Request


class MapOut(BaseModel):
    """Stored map."""

    name: str
    segments: int
    sequence: int = Field(
        description="Sequence number of the newest version; each write makes a new version."
    )
    etag: str = Field(
        description="Entity tag of the newest version, for If-Match and If-None-Match."
    )
    bytes: int = Field(description="Size in the store with its old versions, bytes.")
    model_id: str
    frame: str = Field(description="Name of the coordinate frame.")
    robots: dict[str, int] = Field(description="Number of segments of each robot.")
    sources: dict[str, int] = Field(
        description="Number of segments that were merged from each source map. Maps that the key "
        "may not read are left out."
    )
    time_span: tuple[float, float] | None = Field(
        description="Times of the first and the last "
        "observation, Unix seconds. Null if the map is empty."
    )
    optional: list[str] = Field(description="Names of the optional columns in the map.")
    tags: list[str] = Field(description="Tags of the map, sorted.")
    classes: dict[str, int] = Field(
        description="Number of segments of each class, and `unknown`; empty if the map has no "
        "classes."
    )


class CalibrationOut(BaseModel):
    """Calibration of the match probabilities of a map by its own segments, without labels."""

    state: CalibrationState = Field(
        description="`default`: the constants of the model give the probabilities. `collecting`: "
        "the map's segments normalize the distances. `calibrated`: they also determine `shift` and "
        "`scale`."
    )
    read: int = Field(
        description="Number of the map's first segments that the calibration was computed from. "
        "It is computed again when the map has grown by a fifth, or when one of them changes."
    )
    cohort: int = Field(
        description="Number of segments with which each query is compared to normalize distances."
    )
    negatives: int = Field(description="Number of pairs that are surely no match.")
    positives: int = Field(description="Number of segments that have other views in the map.")
    views: float = Field(description="Mean number of other views of a segment in the map.")
    shift: float = Field(
        description="Correction of a pair's log-likelihood ratio: shift + scale x ratio."
    )
    scale: float = Field(description="See `shift`.")
    log_prior: float = Field(
        description="Log odds that a segment of the map shows the object of a query: views divided "
        "by segments."
    )


class MirrorOut(BaseModel):
    """Mark of a map that is a read-only copy of another service's map."""

    source: str = Field(description="URL of the map that it is a copy of.")
    etag: str = Field(description="Entity tag of the version there that was copied last.")
    time: float = Field(description="Time of the last copy, Unix seconds.")


class MirrorIn(Request):
    """Mark of a map that is a read-only copy of another service's map."""

    source: str = Field(
        pattern=r"^https?://[!-?A-~]{1,1000}$",
        description="URL of the map that it is a copy of, without user or password.",
    )
    etag: str = Field(
        default="",
        pattern=r"^([0-9a-f]{16}-[0-9]{1,16})?$",
        description="Entity tag of the version there that was copied last, without quotes; empty "
        "before the first copy.",
    )


class MapDetailOut(MapOut):
    """Stored map, with the state of its calibration and its place on the Earth."""

    calibration: CalibrationOut | None = Field(
        description="Calibration of the match probabilities. Null if the model of the map is not "
        "loaded or states no constants for it."
    )
    anchor: GeoAnchorOut | None = Field(
        description="WGS 84 anchor, as `GET /maps/{map}/anchor` returns it. Null if there is none."
    )
    mirror: MirrorOut | None = Field(
        description="Source of a map that is a read-only copy of another service's map. Null for "
        "all other maps."
    )
    shapes: bool = Field(
        description="Whether the shapes of the segments can be decoded: the model of the map is "
        "loaded and has a shape decoder."
    )


class MapsResponse(BaseModel):
    """Stored maps, sorted by name, and the default model."""

    model_id: str
    maps: list[MapOut]
    damaged: list[str] = Field(description="Names of stored maps that cannot be read.")


class WrittenOut(BaseModel):
    """Result of a write."""

    map: str
    sequence: int = Field(description="Sequence number of the map's version after the write.")
    etag: str = Field(description="Entity tag of that version.")
    segments: int = Field(description="Number of segments in the map after the write.")
    changed: int = Field(description="Number of segments added or replaced.")
    removed: int = Field(description="Number of segments removed.")
    repeats: int = Field(
        0,
        description="Number of segments that were not stored, because they were stored before "
        "(`deduplicate`).",
    )


class IdsOut(BaseModel):
    """Reserved ids for new segments: `count` ids from `first` on."""

    first: int
    count: int


class AddedScanOut(WrittenOut):
    """Result of adding a scan to a map."""

    ids: list[int] = Field(description="Ids of the added segments, in the order of the scan.")
    unusable: int = Field(description="Number of segments that the model cannot describe.")
    problems: list[str] = Field(description="Oddities of the scan, and the assumptions made.")


class VersionOut(BaseModel):
    """Version of a map."""

    sequence: int
    etag: str
    time: float = Field(description="Time of the write, Unix seconds of the service's clock.")
    author: str = Field(
        description="Name of the key that wrote. A key that may not read all maps sees `another "
        "key` instead of other keys' names."
    )
    operation: str = Field(examples=["put", "edit", "restore", "age"])
    changed: int = Field(description="Number of segments added or replaced.")
    removed: int = Field(description="Number of segments removed.")


class VersionsResponse(BaseModel):
    """Versions of a map, newest first."""

    map: str
    oldest: int = Field(description="Sequence number of the oldest version that is kept.")
    versions: list[VersionOut]


class CompactOut(BaseModel):
    """Versions that a map keeps after compaction."""

    oldest: int = Field(description="Sequence number of the oldest version.")
    sequence: int = Field(description="Sequence number of the newest version.")
    bytes: int = Field(description="Size in the store, bytes.")


class UploadOut(BaseModel):
    """Unfinished upload of a map file in parts."""

    digest: str = Field(description="SHA-256 digest of the whole file, 64 hex digits.")
    bytes: int = Field(description="Number of bytes received; the next part begins there.")
    time: float = Field(description="Time of the last part, Unix seconds of the service's clock.")


class UploadsResponse(BaseModel):
    """Unfinished uploads of the key for a map."""

    map: str
    uploads: list[UploadOut]


class PartOut(BaseModel):
    """Result of an uploaded part."""

    digest: str = Field(description="SHA-256 digest of the whole file, 64 hex digits.")
    bytes: int = Field(description="Number of bytes received; the next part begins there.")
