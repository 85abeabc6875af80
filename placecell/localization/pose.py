"""Pose: a rigid transform between two frames."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Rigid transform from a source frame to a target frame: `rotation @ point + translation`.

    Attributes:
        rotation: float64 (3, 3), rotation matrix.
        translation: float64 (3,), meters, source frame's origin in the target frame.
    """

    rotation: Float64
    translation: Float64

    @classmethod
    def of_yaw(cls, yaw: float, translation: Float64) -> Self:
        """Build a rotation about z followed by a translation.

        Args:
            yaw: radians, counterclockwise seen from above.
            translation: (3,), meters.
        """
        cos, sin = np.cos(yaw), np.sin(yaw)
        return cls(
            np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]),
            np.asarray(translation, dtype=np.float64),
        )

    @classmethod
    def of_matrix(cls, matrix: Float64) -> Self:
        """Build a pose from a homogeneous transform (4, 4)."""
        return cls(np.array(matrix[:3, :3]), np.array(matrix[:3, 3]))

    @property
    def matrix(self) -> Float64:
        """Homogeneous transform, float64 (4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.rotation, self.translation
        return matrix

    @property
    def yaw(self) -> float:
        """Direction of the source frame's x axis seen from above, radians, -pi to pi."""
        return float(np.arctan2(self.rotation[1, 0], self.rotation[0, 0]))

    def apply(self, points: Float64) -> Float64:
        """Transform points (n, 3) or one point (3,) to the target frame."""
        return np.asarray(points @ self.rotation.T + self.translation)

    def inverse(self) -> "Pose":
        """Return the inverse transform."""
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)

    def after(self, first: "Pose") -> "Pose":
        """Return the composition: `first`, then this transform."""
        return Pose(self.rotation @ first.rotation, self.apply(first.translation))

    def difference(self, other: "Pose", at: Float64) -> tuple[float, float]:
        """Return the distance and the angle between two poses.

        Args:
            other: pose with the same frames.
            at: point (3,) of the source frame, such as the robot's position. A small rotation moves
                points far from the origin by a large distance.

        Returns:
            Distance between the point's two images, meters, and angle of the rotation, radians.
        """
        turn = self.rotation.T @ other.rotation
        cosine = (np.trace(turn) - 1) / 2
        # The sine is exact for small angles, where the cosine is not.
        sine = np.linalg.norm(turn - turn.T) / np.sqrt(8)
        meters = np.linalg.norm(self.apply(at) - other.apply(at))
        return float(meters), float(np.arctan2(sine, cosine))
