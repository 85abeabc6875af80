"""Schemas of `/robots`."""

from typing import Annotated, Literal, Self

import numpy as np
from placecell_client.hints import check_covariance
from pydantic import BaseModel, Field, model_validator

from service.api.schemas.recognition import (
    Covariance,
    Name,
    Point,
    Quaternion,
    Request,
    Time,
)

# Lists, as some readers of OpenAPI do not understand the schema of a nullable tuple.
Position = Annotated[list[float], Field(min_length=3, max_length=3)]
Rotation = Annotated[list[float], Field(min_length=4, max_length=4)]
State = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9][A-Za-z0-9._ -]{0,63}$")]


class RobotReportIn(Request):
    """Pose and state of a robot."""

    map: Name | None = Field(
        None, description="Name of the map of the pose. Null: the robot has no pose now."
    )
    position: Point | None = Field(
        None, description="Position of the sensor in the map's frame, x, y, z, meters."
    )
    orientation: Quaternion = Field(
        (0.0, 0.0, 0.0, 1.0),
        description="Orientation of the sensor in the map's frame, a unit quaternion x, y, z, w.",
    )
    covariance: Covariance | None = Field(
        None,
        description="Covariance of the pose, 3 x 3 (x, y, z), 4 x 4 (and yaw) or 6 x 6 (and "
        "rotations about x, y, z), meters and radians.",
    )
    probability: Annotated[float, Field(strict=True, ge=0, le=1)] | None = Field(
        None, description="Probability that the pose is right. Null: not known."
    )
    state: State = Field(
        "localized", description="State of the robot, such as `localized` or `lost`."
    )
    reason: Annotated[str, Field(strict=True, max_length=200)] = Field(
        "", description="Reason for the state, in words."
    )
    time: Time | None = Field(None, description="Time of the robot's clock, Unix seconds.")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.map is None) != (self.position is None):
            raise ValueError("a pose needs both map and position; a robot without one has neither")
        if not 0.9 < float(np.linalg.norm(self.orientation)) < 1.1:
            raise ValueError("the orientation needs a unit quaternion x, y, z, w")
        if self.covariance is not None:
            check_covariance(self.covariance)
        return self


class RobotOut(BaseModel):
    """Last report of a robot, with its last pose."""

    robot: str
    map: str | None = Field(description="Name of the map. Null: the robot had no pose yet.")
    position: Position | None = Field(
        description="Last position of the sensor in the map's frame, x, y, z, meters."
    )
    orientation: Rotation | None = Field(
        description="Last orientation of the sensor, a quaternion x, y, z, w."
    )
    covariance: list[list[float]] | None = Field(
        description="Covariance of the pose: x, y, z, and yaw or rotations about x, y, z. Null: "
        "not known."
    )
    probability: float | None = Field(
        description="Probability that the pose is right. Null: not known."
    )
    state: str
    reason: str = Field(description="Reason for the state. Empty if there is none.")
    time: float | None = Field(description="Time of the robot's clock, Unix seconds.")
    age: float = Field(description="Time since the report, seconds.")
    pose_age: float | None = Field(
        description="Time since the report of the pose, seconds. Null without a pose."
    )
    source: Literal["report", "localize"] = Field(
        description="`report` by the robot itself, or its last `/localize`."
    )


class RobotsResponse(BaseModel):
    """Robots by name."""

    robots: list[RobotOut]
    next: str | None = Field(
        description="Value of `after` for the next page. Null if this page is the last one."
    )
