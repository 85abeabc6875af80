"""Picture of a cloud, seen from above at a slant."""

from typing import TYPE_CHECKING

import numpy as np

from placecell.core.types import Float64, UInt8

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SLANT = 0.6
"""Share of a horizontal distance in depth that the picture shows as height."""


def draw_cloud(axes: "Axes", points: Float64, colors: UInt8) -> None:
    """Draw points, nearer ones over farther ones.

    Args:
        axes: axes to draw in.
        points: float64 (n, 3), meters, z up.
        colors: color of each point, uint8 (n, 3).
    """
    order = np.argsort(-points[:, 1], kind="stable")
    x, y, z = points[order].T
    # Higher points are lighter, so that walls differ from the ground before them.
    light = 0.55 + 0.45 * (z - z.min()) / max(float(np.ptp(z)), 1e-9) if len(z) else z
    shades = np.clip(colors[order] / 255 * light[:, None], 0, 1)
    axes.scatter(x, SLANT * y + z, c=shades, s=0.6, linewidths=0)
    axes.set_aspect("equal")
    axes.set_axis_off()
