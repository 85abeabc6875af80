"""What `/maps` answers, as JSON."""

from pydantic import BaseModel, Field


class MapOut(BaseModel):
    """A stored map."""

    name: str
    segments: int
    sequence: int = Field(description="Of its newest version; each write makes one.")
    etag: str = Field(description="Names this version, of all versions of all maps.")
    bytes: int = Field(description="That it takes in the service's store, with its old versions.")
    model_id: str
    frame: str = Field(description="Name of its coordinate frame.")
    robots: dict[str, int] = Field(description="How many segments each has in it.")
    sources: dict[str, int] = Field(
        description="Number of segments merged from each source map that is known and that the "
        "key opens."
    )
    time_span: tuple[float, float] | None = Field(description="Seconds; null without segments.")
    optional: list[str] = Field(description="Names of the optional columns that it has.")


class MapsResponse(BaseModel):
    """The stored maps, by name, and the model that is loaded."""

    model_id: str
    maps: list[MapOut]
    damaged: list[str] = Field(description="Maps that are stored but cannot be read.")


class WrittenOut(BaseModel):
    """What a write did."""

    map: str
    sequence: int = Field(description="Of the map's version after it.")
    etag: str = Field(description="Of that version.")
    segments: int = Field(description="In the map after it.")
    changed: int = Field(description="Segments added or replaced.")
    removed: int = Field(description="Segments removed.")
    repeats: int = Field(
        0, description="Segments that were not stored, for they were seen before (`deduplicate`)."
    )


class IdsOut(BaseModel):
    """Ids for new segments: `first` and those after it."""

    first: int
    count: int


class VersionOut(BaseModel):
    """A version of a map."""

    sequence: int
    etag: str
    time: float = Field(description="When it was written, Unix seconds of the service's clock.")
    author: str = Field(
        description="Name of the key; a key that does not open all maps sees `another key`."
    )
    operation: str = Field(examples=["put", "edit", "restore", "age"])
    changed: int = Field(description="Segments added or replaced.")
    removed: int = Field(description="Segments removed.")


class VersionsResponse(BaseModel):
    """The versions of a map, newest first."""

    map: str
    oldest: int = Field(description="Sequence of the oldest that is kept.")
    versions: list[VersionOut]


class CompactOut(BaseModel):
    """What a map keeps now."""

    oldest: int = Field(description="Sequence of the oldest version.")
    sequence: int = Field(description="Of the newest.")
    bytes: int = Field(description="That it takes in the service's store.")


class UploadOut(BaseModel):
    """A map file that is uploaded in parts and is not complete."""

    digest: str = Field(description="SHA-256 of the whole file, 64 hex digits.")
    bytes: int = Field(description="Received so far; the next part begins there.")
    time: float = Field(description="Of the last part, Unix seconds of the service's clock.")


class UploadsResponse(BaseModel):
    """The key's uploads for a map that are not complete."""

    map: str
    uploads: list[UploadOut]


class PartOut(BaseModel):
    """Result of an uploaded part."""

    digest: str = Field(description="SHA-256 of the whole file, 64 hex digits.")
    bytes: int = Field(description="Received so far; the next part begins there.")
