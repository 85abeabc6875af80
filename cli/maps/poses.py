"""Options and texts that `maps align` and `maps merge` share."""

from math import degrees
from typing import TYPE_CHECKING, Annotated, Literal

import typer

if TYPE_CHECKING:
    from placecell_client import Pose

POSE = "x, y, z, yaw"
"""Title of a column of poses: meters and degrees."""

Motion = Annotated[
    Literal["yaw", "se3"],
    typer.Option(
        help="Degrees of freedom: yaw (x, y, z, yaw; both frames are level) or se3 (all six)."
    ),
]


def pose_text(pose: "Pose") -> str:
    """Format a pose: x, y and z in meters, yaw in degrees."""
    x, y, z = pose.translation
    return f"{x:.2f}, {y:.2f}, {z:.2f}, {degrees(pose.yaw):.1f}\N{DEGREE SIGN}"
