"""Results about robots: their last pose and state."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class RobotState:
    """Last report of a robot, with its last pose.

    Attributes:
        robot: Name of the robot.
        map: Name of the map of the pose; None if the robot had no pose yet.
        position: Position of the sensor in the map's frame, meters, float64 (3,); None without a
            pose.
        orientation: Orientation of the sensor, quaternion x, y, z, w, float64 (4,); None without a
            pose.
        covariance: Covariance of the pose: x, y, z, and yaw or rotations about x, y, z, float64;
            None if it is not known.
        probability: Probability that the pose is right; None if it is not known.
        state: State of the robot, such as `localized`.
        reason: Reason for the state; empty if there is none.
        time: Time of the robot's clock, Unix seconds; None if it gave none.
        age: Time since the report, seconds.
        pose_age: Time since the report of the pose, seconds; None without a pose.
        source: `report` by the robot itself, or its last `localize`.
    """

    robot: str
    map: str | None
    position: NDArray[np.float64] | None
    orientation: NDArray[np.float64] | None
    covariance: NDArray[np.float64] | None
    probability: float | None
    state: str
    reason: str
    time: float | None
    age: float
    pose_age: float | None
    source: str

    @classmethod
    def of(cls, content: dict[str, Any]) -> "RobotState":
        """Build from the service's JSON; unknown fields are ignored."""
        values = {name: content[name] for name in cls.__slots__}
        for name in ("position", "orientation", "covariance"):
            if values[name] is not None:
                values[name] = np.array(values[name], dtype=np.float64)
        return cls(**values)
