"""Errors of the odometry: the variances of the way from one capture to the next.

A message of ROS may state the covariance of the pose since the odometry began. What it grew by is
that of the way. Neither KISS-ICP nor a file of poses tells a covariance, and many drivers leave
that of their messages empty or constant. Then a model gives the variances from what was driven:
each grows with the distance, and that of the heading also with the angle by which the robot turned.
Errors of different stretches are independent, so variances add up.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from placecell.trajectories.covariance import lever_arm


@dataclass(frozen=True, slots=True)
class OdometryModel:
    """Standard deviations of the odometry; they grow with the square roots of distance and angle.

    Distances and the growth along them are those that the service assumes of a map that states no
    covariance (`placecell.pose_graph.parameters`).

    Attributes:
        position: horizontal position along each axis after one meter, meters.
        height: height after one meter, meters.
        yaw: heading after one meter, radians.
        yaw_of_turn: heading after a turn by one radian, radians.
    """

    position: float = 0.05
    height: float = 0.02
    yaw: float = float(np.radians(0.05))
    yaw_of_turn: float = float(np.radians(0.2))

    def variances(self, before: Float64, after: Float64) -> Float64:
        """Return the variances of a step: of x and y, m^2; of z, m^2; of the heading, rad^2.

        Args:
            before: pose of the sensor before the step, float64 (4, 4).
            after: pose of the sensor after it, in the same frame, float64 (4, 4).
        """
        meters = float(np.linalg.norm(after[:3, 3] - before[:3, 3]))
        turned = before[:2, :2].T @ after[:2, :2]
        radians = abs(float(np.arctan2(turned[1, 0] - turned[0, 1], turned[0, 0] + turned[1, 1])))
        return np.array(
            [
                self.position**2 * meters,
                self.height**2 * meters,
                self.yaw**2 * meters + self.yaw_of_turn**2 * radians,
            ]
        )


Certain = tuple[Float64, Float64]
"""Pose (4, 4) and its covariance (6, 6)."""


def stated_variances(before: Certain, after: Certain, model: Float64) -> Float64:
    """Return the variances of a step by the covariances of its ends.

    An error of the heading before the step moves its end sideways. This is no error of the step, so
    it is subtracted: Q = C' - J C J^T. A covariance that did not grow is that of single poses and
    states nothing of the step; then the model's variances stay. Planar odometry states no growth of
    the height; then the model's variance of the height stays.

    Args:
        before: pose of the sensor before the step, with its covariance.
        after: pose of the sensor after it, in the same frame, with its covariance.
        model: variances by the model, as `OdometryModel.variances`.

    Returns:
        The variances of x and y, m^2; of z, m^2; of the heading, rad^2.
    """
    arm = lever_arm(after[0][:3, 3] - before[0][:3, 3])
    grown = np.diag(after[1] - arm @ before[1] @ arm.T)
    if not (grown[[0, 1, 5]] > 0).all():
        return model
    return np.array([grown[:2].mean(), grown[2] if grown[2] > 0 else model[1], grown[5]])
