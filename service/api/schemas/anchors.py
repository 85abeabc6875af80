"""Schemas of tags, WGS 84 anchors and named anchors of maps, and of GeoPose."""

from typing import Annotated, Self

import numpy as np
from pydantic import BaseModel, Field, model_validator

from service.api.schemas.recognition import Finite, Point, Positive, Quaternion, Request
from service.maps.store import NAME_PATTERN

Tag = Annotated[str, Field(strict=True, pattern=NAME_PATTERN)]
Latitude = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-90, le=90)]
Longitude = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-180, le=180)]
Height = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-20_000, le=20_000)]
Accuracy = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=10_000)]


class TagsIn(Request):
    """Tags of a map."""

    tags: list[Tag] = Field(max_length=1_000, description="All tags of the map; [] removes them.")


class TagsOut(BaseModel):
    """Tags of a map."""

    map: str
    tags: list[str]


class GeoAnchorIn(Request):
    """Place of a map on the Earth."""

    lat: Latitude = Field(description="Latitude (WGS 84), degrees, north positive.")
    lon: Longitude = Field(description="Longitude (WGS 84), degrees, east positive.")
    height: Height = Field(0.0, description="Height above the WGS 84 ellipsoid, meters.")
    yaw_deg: Finite = Field(
        0.0,
        ge=-360,
        le=360,
        description="Angle from east to the map's x axis, degrees, counter-clockwise: 0 if x "
        "points east, 90 if it points north.",
    )
    accuracy: Accuracy = Field(
        0.0, description="Standard deviation of the position along an axis, meters."
    )
    position: Point = Field(
        (0.0, 0.0, 0.0),
        description="Point of the map that is at this place, x, y, z in the map's frame, meters. "
        "Default: the origin.",
    )


class GeoAnchorOut(BaseModel):
    """Place of a map on the Earth."""

    map: str
    lat: float = Field(description="Latitude (WGS 84), degrees.")
    lon: float = Field(description="Longitude (WGS 84), degrees.")
    height: float = Field(description="Height above the WGS 84 ellipsoid, meters.")
    yaw_deg: float = Field(description="Angle from east to the map's x axis, degrees.")
    accuracy: float = Field(description="Standard deviation of the position along an axis, meters.")
    position: Point = Field(description="Point of the map that is at this place, meters.")
    frame: str = Field(description="Name of the map's frame when the anchor was written.")
    applies: bool = Field(
        description="False if the map has another frame now. The anchor is then not used."
    )
    author: str = Field(description="Name of the key that wrote it, as in the versions.")
    time: float = Field(description="Time of the write, Unix seconds.")


class GnssFixIn(Request):
    """GNSS fix of a robot in a map."""

    position: Point = Field(
        description="Position of the antenna in the map's frame, x, y, z, meters."
    )
    lat: Latitude = Field(description="Latitude (WGS 84), degrees.")
    lon: Longitude = Field(description="Longitude (WGS 84), degrees.")
    height: Height | None = Field(
        None, description="Height above the WGS 84 ellipsoid, meters. Null: not known."
    )
    accuracy: Positive = Field(
        description="Standard deviation of the position along an axis, meters."
    )


class FitRequest(Request):
    """GNSS fixes, and whether to write the anchor."""

    fixes: list[GnssFixIn] = Field(
        min_length=1, max_length=10_000, description="Fixes at different places."
    )
    dry_run: bool = Field(False, strict=True, description="Return the anchor, and write nothing.")


class ResidualOut(BaseModel):
    """Agreement of one fix with the anchor."""

    meters: float = Field(description="Horizontal distance from its place by the anchor, meters.")
    inlier: bool = Field(description="False if the fix was left out as an outlier.")


class FitOut(BaseModel):
    """Fitted anchor."""

    dry_run: bool
    anchor: GeoAnchorOut
    yaw_deviation_deg: float = Field(description="Standard deviation of the yaw, degrees.")
    inliers: int = Field(description="Number of fixes that agree with the anchor.")
    residuals: list[ResidualOut] = Field(description="Agreement of each fix, in order.")


class NamedAnchorIn(Request):
    """Pose in a map."""

    position: Point = Field(description="Position in the map's frame, x, y, z, meters.")
    orientation: Quaternion = Field(
        (0.0, 0.0, 0.0, 1.0), description="Orientation as a unit quaternion x, y, z, w."
    )

    @model_validator(mode="after")
    def _is_unit(self) -> Self:
        if not 0.9 < float(np.linalg.norm(self.orientation)) < 1.1:
            raise ValueError("the orientation needs a unit quaternion x, y, z, w")
        return self


class NamedAnchorOut(BaseModel):
    """Named pose in a map."""

    name: str
    position: Point = Field(description="Position in the map's frame, x, y, z, meters.")
    orientation: Quaternion = Field(description="Orientation as a quaternion x, y, z, w.")
    frame: str = Field(description="Name of the map's frame when the anchor was written.")
    applies: bool = Field(
        description="False if the map has another frame now. The pose is then of no use."
    )
    author: str = Field(description="Name of the key that wrote it, as in the versions.")
    time: float = Field(description="Time of the write, Unix seconds.")


class NamedAnchorsResponse(BaseModel):
    """Named anchors of a map, by name."""

    map: str
    anchors: list[NamedAnchorOut]
    next: str | None = Field(
        description="Value of `after` for the next page. Null if this page is the last one."
    )


class GeoPosition(BaseModel):
    """Position of a GeoPose."""

    lat: float = Field(description="Latitude (WGS 84), degrees.")
    lon: float = Field(description="Longitude (WGS 84), degrees.")
    h: float = Field(description="Height above the WGS 84 ellipsoid, meters.")


class GeoQuaternion(BaseModel):
    """Orientation of a GeoPose, relative to east, north and up at its position."""

    x: float
    y: float
    z: float
    w: float


class GeoPose(BaseModel):
    """Pose on the Earth: OGC GeoPose 1.0, Basic-Quaternion."""

    position: GeoPosition
    quaternion: GeoQuaternion
