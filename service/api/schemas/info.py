"""Schemas of `/info`, `/models` and the health routes as JSON."""

from typing import Any, Literal

from pydantic import BaseModel, Field

from service.core.settings import Limits


class AcceptanceOut(BaseModel):
    """Calibration of the acceptance of poses; see `max_false_acceptance` of `/localize`."""

    max_false_acceptance: float = Field(
        description="Default: largest expected share of requests that get a false pose."
    )
    smallest: float = Field(description="Smallest `max_false_acceptance` that a request may have.")
    threshold: float = Field(description="Probability that a pose must exceed by default.")
    queries: int = Field(description="Number of calibration queries.")


class ModelOut(BaseModel):
    """Summary of a loaded model's manifest."""

    model_id: str
    name: str
    method: str
    network: str
    dimension: int
    code_bytes: int = Field(description="Bytes of a stored descriptor: the length of `codes`.")
    per_byte: int = Field(description="Number of dimensions that share a byte of `codes`.")
    surroundings: bool = Field(
        description="True if a segment's descriptor depends on its neighborhood. Then send all "
        "segments of a scan in one request."
    )
    step: float = Field(
        description="Quantizer step: the descriptor's change for one level of `codes`."
    )
    pair_threshold: float = Field(
        description="Descriptor distance below which a pair counts as a match."
    )
    preprocessing: dict[str, Any]
    acceptance: AcceptanceOut | None = Field(
        description="Calibration of `max_false_acceptance`. Null if the model has none."
    )


class MapFileOut(BaseModel):
    """Map file format that this service reads and writes."""

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
    scanned: float = Field(description="Seconds per point of a point cloud file.")
    supported: float = Field(
        description="Seconds per pair of a candidate and a candidate of a neighbor of the query, "
        "to re-rank: at most 320 pairs per candidate."
    )


class InfoResponse(BaseModel):
    """Version, models, limits and costs of the service."""

    version: str
    model: ModelOut = Field(description="Default model.")
    models: list[ModelOut] = Field(description="All loaded models, the default model first.")
    limits: Limits
    costs: CostsOut
    map_file: MapFileOut
    up: Literal["z"] = "z"


class KeyResponse(BaseModel):
    """Scope of the key that sent the request."""

    name: str = Field(
        description="Name of the key's principal; `anyone` on a service without keys. Empty if the "
        "key is not known."
    )
    role: Literal["none", "read", "write", "admin"] = Field(
        description="`none`: the request has no known key. `read`: read maps and "
        "recognize. `write`: also write, merge and delete maps. `admin`: also reload models and "
        "free ids."
    )
    may_write: bool = Field(description="True if the key may write maps in its scope.")
    maps: list[str] = Field(description="Patterns of the names of its maps, with * and ?.")
    robot: str | None = Field(
        description="Robot whose segments alone the key may write; null for all robots."
    )
    open: bool = Field(
        description="True if the service has no keys, so that every client may do everything."
    )


class ReloadResponse(BaseModel):
    """Models that are loaded after a reload."""

    model_id: str = Field(description="Id of the default model.")
    models: list[str] = Field(description="Ids of all loaded models, the default model first.")


class HealthResponse(BaseModel):
    """Health of the service."""

    status: Literal["alive", "ready"]
    warnings: list[str] | None = Field(
        default=None,
        description="Problems that need an operator although the service works; absent if none.",
    )
