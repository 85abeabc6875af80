"""Picture of one scan: raw, ground and segments; obliquely from behind, and from above."""

from pathlib import Path
from typing import Any

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32
from placecell.inspection.ground import leveled
from placecell.inspection.inspect import Inspection
from placecell.segmentation.ceiling import is_overhead
from placecell.segmentation.ground import is_ground
from placecell.segmentation.local_map import in_range, voxel_means
from placecell.segmentation.region_growing import segment_indices

SHOWN = 40.0
"""Distance from the sensor that the picture shows, meters."""
MOST_POINTS = 150_000
GRAY, BROWN = "0.8", "tab:brown"


def draw_scan(found: Inspection, file: Path) -> None:
    """Draw the scan with the most points.

    Args:
        found: the inspection.
        file: PNG file to write.
    """
    from matplotlib.figure import Figure

    scan = max(found.samples.scans, key=lambda each: len(each.points))
    points = leveled(scan.points, found.mount)
    reach = min(SHOWN, 1.3 * float(np.quantile(np.linalg.norm(points, axis=1), 0.9)))
    voxels = voxel_means(in_range(points, PROTOCOL_V1), PROTOCOL_V1.map_voxel)
    ground = is_ground(voxels, PROTOCOL_V1)
    objects = voxels[~ground & ~is_overhead(voxels, PROTOCOL_V1)]
    segments = segment_indices(objects, PROTOCOL_V1)
    figure = Figure(figsize=(13, 8.5), layout="constrained")
    axes = figure.subplots(2, 3)
    raw = points[:: -(-len(points) // MOST_POINTS)]
    for row, view in zip(axes, (oblique, above), strict=True):
        for panel in row:
            frame(panel, view, reach)
        heights = np.quantile(raw[:, 2], (0.02, 0.98))
        for low, high, color in height_bands(heights):
            band = raw[(raw[:, 2] >= low) & (raw[:, 2] < high)]
            draw(row[0], view(band, reach), color=color)
        draw(row[1], view(voxels[~ground], reach), color=GRAY)
        draw(row[1], view(voxels[ground], reach), color=BROWN)
        draw(row[2], view(voxels, reach), color=GRAY, alpha=0.3)
        for number, indices in enumerate(segments):
            draw(row[2], view(objects[indices], reach), color=f"C{number % 10}", s=1.5)
    axes[0, 0].set_title(f"raw: {len(points):,} points, by height")
    axes[0, 1].set_title(f"ground: {ground.mean():.0%} of {len(voxels):,} voxels")
    axes[0, 2].set_title(f"segments: {len(segments)} in this one scan")
    told = f"{found.subject.path.name}, scan {scan.index}"
    if found.mount.ground is not None:
        told += f": sensor {found.mount.ground.height:.2f} m above the ground"
    figure.suptitle(f"{told}. Above: from behind; below: from above, {2 * reach:.0f} m wide")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=90)


def height_bands(heights: Any) -> list[tuple[float, float, Any]]:
    """Return bands of heights with their colors; the outer bands are open."""
    from matplotlib import colormaps

    edges = [-np.inf, *np.linspace(heights[0], heights[1], 31)[1:-1], np.inf]
    colors = colormaps["turbo"](np.linspace(0, 1, len(edges) - 1))
    return list(zip(edges[:-1], edges[1:], colors, strict=True))


def draw(panel: Any, places: Float32, **style: Any) -> None:
    """Draw points as small dots."""
    if len(places):
        panel.scatter(places[:, 0], places[:, 1], **({"s": 0.4, "linewidths": 0} | style))


def frame(panel: Any, view: Any, reach: float) -> None:
    """Set the limits of a panel."""
    panel.set(aspect="equal", xticks=[], yticks=[])
    if view is above:
        panel.set(xlim=(-reach, reach), ylim=(-reach, reach))
        panel.plot([0], [0], "k+")
    else:
        panel.set(xlim=(-0.75, 0.75), ylim=(-0.45, 0.55))


def above(points: Float32, reach: float) -> Float32:  # noqa: ARG001
    """Return points as seen from above: x to the right, y up."""
    return np.asarray(points[:, :2])


def oblique(points: Float32, reach: float) -> Float32:
    """Return points in the picture of a pinhole camera behind and above the sensor."""
    tilt = np.radians(40.0)
    ahead, up = points[:, 0] + 0.9 * reach, points[:, 2] - 0.8 * reach
    depth = np.cos(tilt) * ahead - np.sin(tilt) * up
    seen = depth > 0.05 * reach
    rise = np.sin(tilt) * ahead[seen] + np.cos(tilt) * up[seen]
    return np.stack([-points[seen, 1] / depth[seen], rise / depth[seen]], axis=1)
