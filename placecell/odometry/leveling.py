"""Leveling: the rotation that makes z of a drive's world point up, from the ground of its scans."""

from collections.abc import Sequence

import numpy as np

from placecell.core.types import Float64
from placecell.odometry.ground_plane import (
    UP,
    GroundPlane,
    NoGroundError,
    find_common_ground,
    rotation_between,
)
from placecell.odometry.scan_odometry import read, rotated
from placecell.sources.source import ScanSource

FIRST_SECONDS = 20.0
"""Time in which the ground of an odometry is sought: its slopes even out, its drift is small."""
MOST_SCANS = 12


def ground_in_world(
    source: ScanSource,
    scans: Sequence[int],
    poses: Float64,
    expected_up: Sequence[float] = UP,
) -> GroundPlane | None:
    """Return the ground that most of the scans agree on, with `up` in the poses' world, or None.

    Args:
        source: the source.
        scans: indices of the scans.
        poses: pose of each of these scans, float64 (scans, 4, 4).
        expected_up: direction in the world near which up is sought.
    """
    chosen = np.unique(np.linspace(0, len(scans) - 1, MOST_SCANS).astype(int))
    clouds = [rotated(read(source, int(scans[at])).points, poses[at]) for at in chosen]
    try:
        return find_common_ground([cloud for cloud in clouds if len(cloud)], expected_up)
    except NoGroundError:
        return None


def leveling_of(up: Float64) -> Float64:
    """Return the transform (4, 4) that turns a world so that a direction of it is its z.

    The turn is the smallest one, so headings change as little as possible.
    """
    level = np.eye(4)
    level[:3, :3] = rotation_between(up, np.array(UP))
    return level


def first_scans(stamps: Float64) -> int:
    """Return the number of scans in the first seconds; unknown times are 0.1 s apart."""
    if not np.isfinite(stamps).all():
        stamps = 0.1 * np.arange(len(stamps), dtype=np.float64)
    return max(1, int(np.searchsorted(stamps, stamps[0] + FIRST_SECONDS)))
