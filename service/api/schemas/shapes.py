"""Schemas of the shapes of stored segments as JSON."""

from pydantic import BaseModel, Field

from service.api.schemas.recognition import ClassOut


class ShapeOut(BaseModel):
    """Shape of a stored segment, decoded from its code and its box."""

    map: str
    id: int
    model_id: str = Field(description="Model of the code and of the decoder.")
    bytes: int = Field(
        description="Bytes of the map that the shape was decoded from: the code, the centroid and, "
        "if the map has them, extents and number of points."
    )
    voxel_m: float = Field(description="Edge length of a voxel, meters.")
    centroid: tuple[float, float, float] = Field(
        description="Stored centroid in the map's frame, meters."
    )
    class_: ClassOut | None = Field(
        serialization_alias="class", description="Stored class of the segment; null if unknown."
    )
    points: list[tuple[float, float, float]] = Field(
        description="Centers of the occupied voxels in the map's frame, meters, to 1 cm."
    )


class ShapesOut(BaseModel):
    """Shapes of several stored segments of a map."""

    map: str
    shapes: list[ShapeOut] = Field(description="Shapes, by ascending id of their segments.")
    missing: list[int] = Field(
        description="Ids that the map does not have: the segments were removed or replaced."
    )
