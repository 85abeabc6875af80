"""Settings: from the environment (`PLACECELL_PORT`, `PLACECELL_LIMITS__K`, ...) or from code."""

from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field
from pydantic_settings import BaseSettings, SettingsConfigDict

from segments.models import DEFAULT_MODEL, MODELS_FOLDER

MEBIBYTE = 1 << 20


class Limits(BaseModel):
    """How much the service takes at once; `/info` shows them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    body_bytes: int = Field(default=16 * MEBIBYTE, ge=1, description="Bytes of a request's body.")
    map_bytes: int = Field(
        default=64 * MEBIBYTE, ge=1, description="Bytes of an uploaded map file."
    )
    segments: int = Field(default=1_000, ge=1, description="Segments, or descriptors, a request.")
    points: int = Field(
        default=500_000, ge=1, description="Points a request, over all its segments."
    )
    min_points: int = Field(
        default=10,
        ge=3,
        description="Points a segment, at least: fewer have no shape to describe. "
        "Models are trained on segments of 100 points or more.",
    )
    max_points: int = Field(default=50_000, ge=3, description="Points a segment, at most.")
    reach: float = Field(
        default=1_000.0,
        gt=0,
        description="Metres from a segment's sensor to its farthest point, at most.",
    )
    spread: float = Field(
        default=10_000.0,
        gt=0,
        description="Metres from the sensors' median to any one of them, at most.",
    )
    k: int = Field(default=100, ge=1, description="Candidates a query, at most.")


class Settings(BaseSettings):
    """Everything that can be set, each with a default that works from a checkout."""

    model_config = SettingsConfigDict(
        env_prefix="PLACECELL_", env_nested_delimiter="__", frozen=True, extra="forbid"
    )

    data_dir: Path = Field(Path("var"), description="Folder of the maps; one service owns it.")
    models_dir: Path = Field(MODELS_FOLDER, description="Folder of the models' folders.")
    model: str = Field(
        DEFAULT_MODEL,
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$",
        description="Name of the model to load.",
    )
    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(
        default=8000, ge=0, le=65_535, description="Port to listen on; 0: any free one."
    )
    workers: int = Field(
        default=2, ge=1, description="Requests computed at once; the others wait for their turn."
    )
    threads: int = Field(default=0, ge=0, description="Threads an inference; 0: one a core.")
    limits: Limits = Field(Limits(), description="How much is taken at once.")
