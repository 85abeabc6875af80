"""What the service tells of itself: `/info`, `/models` and its health, as JSON."""

from typing import Any, Literal

from pydantic import BaseModel, Field

from service.core.settings import Limits


class ModelOut(BaseModel):
    """The loaded model's manifest in short."""

    model_id: str
    name: str
    method: str
    network: str
    dimension: int
    code_bytes: int = Field(description="Of a stored descriptor: the length of `codes`.")
    per_byte: int = Field(description="How many dimensions share a byte of `codes`.")
    surroundings: bool = Field(
        description="Whether a segment's descriptor takes in the other segments of its request: "
        "then send all segments of a scan together."
    )
    step: float = Field(description="What one level is worth in the descriptor's unit.")
    pair_threshold: float = Field(description="Distance below which a pair is called a match.")
    preprocessing: dict[str, Any]


class MapFileOut(BaseModel):
    """The map file that this service reads and writes."""

    format: str
    version: int
    media_type: str


class CostsOut(BaseModel):
    """Costs of requests: seconds of one core per unit of work, for comparison with the limits.

    A recognition request costs the sum of its parts. A request above `limits.cost_seconds`, or an
    alignment above `limits.alignment_seconds`, is refused with a 413.
    """

    machine: str = Field(description="Machine on which the rates were measured.")
    point: float = Field(description="Seconds per point of a segment.")
    segment: float = Field(description="Seconds per described segment.")
    near_voxel: float = Field(
        description="Seconds per pair of a segment and another segment's voxel within 40 m, if "
        "the model uses the neighborhood."
    )
    compared: float = Field(description="Seconds per pair of a query and a map segment.")
    compared_k: float = Field(
        description="Seconds per pair of a query and a map segment, for each candidate (k)."
    )
    candidate: float = Field(description="Seconds per candidate of a query.")


class InfoResponse(BaseModel):
    """What the service is, and how much it takes at once."""

    version: str
    model: ModelOut = Field(description="The default one.")
    models: list[ModelOut] = Field(description="All that are loaded, the default one first.")
    limits: Limits
    costs: CostsOut
    map_file: MapFileOut
    up: Literal["z"] = "z"


class ReloadResponse(BaseModel):
    """What is loaded now."""

    model_id: str = Field(description="Of the default model.")
    models: list[str] = Field(description="Ids of all, the default one first.")


class HealthResponse(BaseModel):
    """That the service is there."""

    status: Literal["alive", "ready"]
    warnings: list[str] | None = Field(
        default=None,
        description="Problems that need an operator although the service works; absent if none.",
    )
