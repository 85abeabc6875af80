"""Schemas of the hints of `/localize`, in both encodings."""

from typing import Annotated, Literal, Self

from placecell_client.hints import GeoHint, Hints, LastPoseHint, NearHint, SensorPose, YawHint
from pydantic import BaseModel, Field, model_validator

from service.api.schemas.recognition import (
    Coordinate,
    Covariance,
    Finite,
    Name,
    Point,
    Positive,
    Quaternion,
    Request,
)
from service.core.settings import NAMED_MAPS

Tags = Annotated[list[Name], Field(fail_fast=True, min_length=1, max_length=32)]
Latitude = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-90, le=90)]
Longitude = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-180, le=180)]


class NearIn(Request):
    """The sensor is near a position."""

    position: Annotated[list[Coordinate], Field(min_length=2, max_length=3)] = Field(
        description="Position x, y, z in a map's frame, meters; x, y for any height."
    )
    radius: Positive = Field(description="Largest distance from the position, meters.")
    map: Name | None = Field(
        None,
        description="Name of the map that the robot is in. Null: the position is meant in the "
        "frame of every searched map.",
    )

    def hint(self) -> NearHint:
        """Return the same for the engine."""
        return NearHint(self.position, self.radius, self.map)


class YawIn(Request):
    """The sensor has about this heading."""

    radians: Finite = Field(
        description="Heading of the sensor's x axis in the map's frame, radians, counter-clockwise "
        "from the map's x axis."
    )
    tolerance: Positive = Field(description="Largest difference of the heading, radians.")

    def hint(self) -> YawHint:
        """Return the same for the engine."""
        return YawHint(self.radians, self.tolerance)


class LastPoseIn(Request):
    """The robot was last known at a pose; either with a radius or with a covariance."""

    map: Name = Field(description="Name of the map.")
    position: Point = Field(
        description="Last position of the sensor in the map's frame, x, y, z, meters."
    )
    orientation: Quaternion | None = Field(
        None, description="Last orientation of the sensor as a quaternion x, y, z, w. Null: any."
    )
    radius: Positive | None = Field(
        None, description="Largest distance that the robot may have moved since, meters."
    )
    covariance: Covariance | None = Field(
        None,
        description="Covariance of the pose, 3 x 3 (x, y, z), 4 x 4 (and yaw) or 6 x 6 (and "
        "rotations about x, y, z). Three standard deviations are searched; with an orientation, "
        "this includes the heading.",
    )
    yaw_tolerance: Positive | None = Field(
        None,
        description="Largest difference of the heading from `orientation`, radians. Null: that of "
        "the covariance, or any heading.",
    )

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        self.hint()
        return self

    def hint(self) -> LastPoseHint:
        """Return the same for the engine; ValueError if the values contradict each other."""
        return LastPoseHint(
            map=self.map,
            position=self.position,
            orientation=self.orientation,
            radius=self.radius,
            covariance=self.covariance,
            yaw_tolerance=self.yaw_tolerance,
        )


class GeoIn(Request):
    """The sensor is near a position on the Earth."""

    lat: Latitude = Field(description="Latitude (WGS 84), degrees, north positive.")
    lon: Longitude = Field(description="Longitude (WGS 84), degrees, east positive.")
    accuracy: Positive = Field(
        description="Standard deviation of the position along an axis, meters. Three of them are "
        "searched, together with the accuracy of the map's anchor."
    )

    def hint(self) -> GeoHint:
        """Return the same for the engine."""
        return GeoHint(self.lat, self.lon, self.accuracy)


class SensorIn(Request):
    """Pose of the sensor in the frame of the request's segments."""

    position: Point = Field(description="Position x, y, z, meters.")
    yaw: Finite = Field(
        0.0, description="Heading of the sensor's x axis, radians, counter-clockwise."
    )

    def hint(self) -> SensorPose:
        """Return the same for the engine."""
        return SensorPose(self.position, self.yaw)


class HintsIn(Request):
    """Where the robot is, as far as it knows. A pose that contradicts a hint is not returned.

    A hint never makes a pose more probable: places outside the hints compete as without hints.
    """

    near: NearIn | None = Field(None, description="The sensor is near a position.")
    yaw: YawIn | None = Field(None, description="The sensor has about this heading.")
    last_pose: LastPoseIn | None = Field(None, description="The robot was last known at a pose.")
    geo: GeoIn | None = Field(
        None,
        description="The sensor is near a position on the Earth. Only maps with a WGS 84 anchor "
        "are narrowed.",
    )
    maps: Annotated[list[Name], Field(fail_fast=True, max_length=NAMED_MAPS)] | None = Field(
        None, min_length=1, description="Names of the maps that the robot may be in."
    )
    tags: Tags | None = Field(None, description="The robot is in a map that has all of these tags.")
    sensor: SensorIn | None = Field(
        None,
        description="Pose of the sensor in the frame of the segments, which `near`, `yaw`, "
        "`last_pose` and `geo` are about. Give it if the frame is an odometry frame. Default: the "
        "median of the sensor positions, or the origin of the frame for codes; heading 0.",
    )

    def hints(self) -> Hints:
        """Return the same for the engine."""
        return Hints(
            near=None if self.near is None else self.near.hint(),
            yaw=None if self.yaw is None else self.yaw.hint(),
            last_pose=None if self.last_pose is None else self.last_pose.hint(),
            geo=None if self.geo is None else self.geo.hint(),
            maps=self.maps,
            tags=self.tags,
            sensor=None if self.sensor is None else self.sensor.hint(),
        )


HintName = Literal["near", "yaw", "last_pose", "geo", "maps", "tags"]


class UnusedHintOut(BaseModel):
    """Hint that could not narrow a map."""

    hint: HintName
    map: str
    reason: str


class OutsideOut(BaseModel):
    """Place outside the hints that is more probable than every place within them."""

    map: str
    frame: str = Field(description="Name of the map's frame.")
    position: Point = Field(description="Position of the sensor in the map's frame, meters.")
    yaw: float = Field(description="Heading of the sensor in the map's frame, radians.")
    probability: float = Field(description="Probability that this place is right.")


class UsedHintsOut(BaseModel):
    """Effect of the hints."""

    used: list[HintName] = Field(description="Hints that narrowed something.")
    unused: list[UnusedHintOut] = Field(description="Hints that could not narrow a map.")
    maps: list[str] = Field(description="Names of the searched maps that the hints allow.")
    outside: OutsideOut | None = Field(
        description="Place outside the hints that fits better. Null if there is none."
    )
