"""Rigid transforms."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Takes points of one frame to another: `rotation @ point + translation`.

    Attributes:
        rotation: float64 (3, 3), proper.
        translation: float64 (3,), meters: where the first frame's origin lies in the second.
    """

    rotation: Float64
    translation: Float64

    @classmethod
    def of_yaw(cls, yaw: float, translation: Float64) -> Self:
        """A turn about z, radians, counter-clockwise from above, then a translation (3,)."""
        cos, sin = np.cos(yaw), np.sin(yaw)
        return cls(
            np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]),
            np.asarray(translation, dtype=np.float64),
        )

    @classmethod
    def of_matrix(cls, matrix: Float64) -> Self:
        """From a transform (4, 4)."""
        return cls(np.array(matrix[:3, :3]), np.array(matrix[:3, 3]))

    @property
    def matrix(self) -> Float64:
        """As a transform (4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.rotation, self.translation
        return matrix

    @property
    def yaw(self) -> float:
        """Radians, -pi to pi: where the first frame's x axis points, seen from above."""
        return float(np.arctan2(self.rotation[1, 0], self.rotation[0, 0]))

    def apply(self, points: Float64) -> Float64:
        """Points (n, 3), or one (3,), in the other frame."""
        return np.asarray(points @ self.rotation.T + self.translation)

    def inverse(self) -> "Pose":
        """The way back."""
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)

    def after(self, first: "Pose") -> "Pose":
        """Another transform first, then this one."""
        return Pose(self.rotation @ first.rotation, self.apply(first.translation))

    def difference(self, other: "Pose", at: Float64) -> tuple[float, float]:
        """How far apart two poses are.

        Args:
            at: a point (3,) of the first frame, such as where the robot is: two frames that differ
                by a small turn lie far apart where they are far from their origins.

        Returns:
            Meters between the two images of the point, and the angle between the two, radians.
        """
        turn = self.rotation.T @ other.rotation
        cosine = (np.trace(turn) - 1) / 2
        # The sine is exact for small angles, where the cosine is not.
        sine = np.linalg.norm(turn - turn.T) / np.sqrt(8)
        meters = np.linalg.norm(self.apply(at) - other.apply(at))
        return float(meters), float(np.arctan2(sine, cosine))
