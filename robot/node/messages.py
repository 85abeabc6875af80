"""Messages of the node, without the middleware that carries them."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.trajectories.poses import of_quaternions

LONGEST_OFF = 0.05
"""Largest difference of a quaternion's length from 1."""


@dataclass(frozen=True, slots=True, eq=False)
class StampedTransform:
    """Pose of a coordinate frame in another one.

    Attributes:
        stamp_ns: time, nanoseconds.
        parent: frame that the pose leads to.
        child: frame whose pose it is.
        pose: pose of the child in the parent, float64 (4, 4).
        covariance: covariance of the pose, of x, y, z and the rotations about the parent's axes,
            float64 (6, 6); None if it is not known.
    """

    stamp_ns: int
    parent: str
    child: str
    pose: Float64
    covariance: Float64 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class CertainPose:
    """Pose of the robot with its covariance.

    Attributes:
        stamp_ns: time, nanoseconds.
        frame: frame of the pose.
        pose: pose of the robot's base in the frame, float64 (4, 4).
        covariance: of x, y, z and the rotations about the frame's axes, float64 (6, 6).
    """

    stamp_ns: int
    frame: str
    pose: Float64
    covariance: Float64


class DiagnosticLevel(IntEnum):
    """Level of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2
    STALE = 3


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """State of the agent, as diagnostic_msgs/DiagnosticStatus has it.

    Attributes:
        stamp_ns: time of the last message, nanoseconds.
        level: level.
        name: name of the part.
        message: state in words.
        hardware: name of the robot.
        values: keys and values, as text.
    """

    stamp_ns: int
    level: DiagnosticLevel
    name: str
    message: str
    hardware: str
    values: tuple[tuple[str, str], ...]


class NodePublisher(Protocol):
    """Publisher of the node's messages; calls come from several threads, each kind from one."""

    def transform(self, transform: StampedTransform) -> None:
        """Publish `map -> odom`."""

    def pose(self, pose: CertainPose) -> None:
        """Publish the pose of the robot in the map."""

    def diagnostic(self, diagnostic: Diagnostic) -> None:
        """Publish the state."""


def pose_of(values: Float64) -> Float64:
    """Return the pose (4, 4) of x, y, z and a quaternion x, y, z, w.

    Raises:
        ValueError: a value is not finite, or the quaternion's length is not 1.
    """
    length = float(np.linalg.norm(values[3:7]))
    if not np.isfinite(values).all() or abs(length - 1) > LONGEST_OFF:
        raise ValueError(
            f"Invalid pose {np.round(values, 4).tolist()}: expected finite numbers and a "
            "quaternion of length 1."
        )
    pose: Float64 = of_quaternions(values[None, :3], values[None, 3:7])[0]
    return pose


def values_of(pose: Float64) -> list[float]:
    """Return x, y, z and the quaternion x, y, z, w of a pose (4, 4)."""
    quaternion = Rotation.from_matrix(pose[:3, :3]).as_quat(canonical=True)
    return [*pose[:3, 3].tolist(), *quaternion.tolist()]
