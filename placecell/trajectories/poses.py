"""Poses as matrices: built from files' numbers, and checked."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.errors import DriveError
from placecell.core.types import Float64, Int64

LONGEST_OFF = 0.05
"""Largest difference of a quaternion's length from 1: two decimals are enough."""


def as_transforms(rows: Float64) -> Float64:
    """Return homogeneous transforms (n, 4, 4) of 3x4 matrices in row-major order (n, 12)."""
    transforms = np.tile(np.eye(4), (len(rows), 1, 1))
    transforms[:, :3, :] = rows.reshape(-1, 3, 4)
    return transforms


def of_quaternions(positions: Float64, quaternions: Float64) -> Float64:
    """Return transforms (n, 4, 4) of positions (n, 3) and quaternions (n, 4), x y z w."""
    return of_rotations(positions, Rotation.from_quat(quaternions.reshape(-1, 4)))


def of_euler(positions: Float64, angles: Float64) -> Float64:
    """Return transforms (n, 4, 4) of positions (n, 3) and roll, pitch, yaw (n, 3), radians.

    The rotation is R_z(yaw) R_y(pitch) R_x(roll), as in URDF and tf.
    """
    return of_rotations(positions, Rotation.from_euler("xyz", angles.reshape(-1, 3)))


def of_rotations(positions: Float64, rotations: Rotation) -> Float64:
    """Return transforms (n, 4, 4) of positions (n, 3) and n rotations."""
    transforms = np.tile(np.eye(4), (len(positions), 1, 1))
    transforms[:, :3, :3] = rotations.as_matrix()
    transforms[:, :3, 3] = positions
    return transforms


def check_quaternions(quaternions: Float64, file: Path, lines: Int64) -> None:
    """Refuse quaternions that do not have the length 1.

    Args:
        quaternions: (n, 4).
        file: file of the quaternions, for the message.
        lines: line of each, for the message.

    Raises:
        DriveError: a length is not 1 to within 0.05.
    """
    off = np.abs(np.linalg.norm(quaternions, axis=1) - 1)
    if (off > LONGEST_OFF).any():
        at = int(off.argmax())
        raise DriveError(
            f"{file}, line {lines[at]}: the quaternion {quaternions[at].tolist()} has the length "
            f"{off[at] + 1 if np.linalg.norm(quaternions[at]) > 1 else 1 - off[at]:.3g}, expected "
            "1. Check which columns hold the quaternion"
        )


def check_rotations(poses: Float64, file: Path) -> None:
    """Refuse poses whose rotation part is no rotation (a sign of another file format).

    Raises:
        DriveError: some rotation is not orthonormal to within 1e-3, or is a reflection.
    """
    rotation = poses[:, :3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        off = np.abs(rotation @ rotation.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
        off = np.where(np.isfinite(off), off, np.inf)
        determinant = np.linalg.det(np.where(np.abs(rotation) < 1e6, rotation, 0.0))
    mirrored = (off <= 1e-3) & (determinant < 0)
    if mirrored.any():
        raise DriveError(
            f"{file}, pose {int(mirrored.argmax())}: its left 3x3 block is a reflection "
            "(determinant -1), expected a rotation: its axes are left-handed. Invert one axis"
        )
    off = np.maximum(off, np.where(determinant > 0, 0.0, 2.0))
    if (off > 1e-3).any():
        raise DriveError(
            f"{file}, pose {int(off.argmax())}: its left 3x3 block is no rotation; 12 numbers a "
            "pose are the rows of a 3x4 matrix, rotation left, translation right"
        )
