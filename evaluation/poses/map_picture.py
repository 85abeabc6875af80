"""Picture of a map as its bytes tell it, beside the cloud that it was made from."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from placecell_client import CompactMap, encode

from evaluation.figure import figure
from evaluation.poses.robot import Robot
from placecell.core.segment_classes import CLASSES, class_indices
from placecell.core.types import Float64, UInt8
from placecell.export.content import CLASS_COLORS, class_colors
from placecell.shapes.decoder import ShapeDecoder
from service.clouds.map_shapes import decoded_points
from service.engine import Engine

if TYPE_CHECKING:
    from matplotlib.patches import Patch

POINT_BYTES = 12
"""Bytes of a point of a cloud: x, y and z as float32."""

PIXELS = (640, 1000)
"""Height and width of a rendered view, pixels."""

SLANT = np.radians(38.0)
"""Angle of the view below the horizon, radians."""

SPLAT = 0.24
"""Width of a point, meters."""

GRAY = np.array([176, 180, 186], np.uint8)
"""Color of the points of the cloud."""

DIM = 0.72
"""Brightness of the lowest points; the highest have 1."""

PAPER = np.array([255, 255, 255], np.uint8)


@dataclass(frozen=True, slots=True)
class View:
    """Parallel view from above at a slant.

    Attributes:
        middle: point of the map in the middle of the picture, float64 (3,), meters.
        yaw: direction of view, counter-clockwise from the x axis, radians.
        meters: width of the picture, meters.
    """

    middle: Float64
    yaw: float
    meters: float

    def pixels(self, points: Float64) -> Float64:
        """Return column, row and depth in pixels of points (n, 3), float64 (n, 3)."""
        x, y, z = (points - self.middle).T
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        ahead, right = cos * x + sin * y, sin * x - cos * y
        up = ahead * np.sin(SLANT) + z * np.cos(SLANT)
        depth = ahead * np.cos(SLANT) - z * np.sin(SLANT)
        height, width = PIXELS
        scale = width / self.meters
        return np.column_stack([width / 2 + scale * right, height / 2 - scale * up, scale * depth])


def rendered(points: Float64, colors: UInt8, view: View) -> UInt8:
    """Return an image of points with eye-dome lighting, uint8 (height, width, 3).

    Eye-dome lighting darkens pixels beside nearer ones, so that edges show without normals.
    Source: Boucheny, *Visualisation scientifique interactive de grands volumes*, 2009.

    Args:
        points: float64 (n, 3), meters, z up.
        colors: color of each point, uint8 (n, 3).
        view: where the points are seen from.
    """
    height, width = PIXELS
    columns, rows, depths = view.pixels(points).T
    low, high = np.percentile(points[:, 2], [1, 99]) if len(points) else (0.0, 1.0)
    light = DIM + (1 - DIM) * np.clip((points[:, 2] - low) / max(high - low, 1e-9), 0, 1)
    colors = (colors * light[:, None]).astype(np.uint8)
    near = np.full((height, width), np.inf)
    image = np.tile(PAPER, (height, width, 1))
    order = np.argsort(-depths, kind="stable")  # nearer points are drawn over farther ones
    half = max(SPLAT * width / view.meters / 2, 0.5)
    size = int(np.ceil(2 * half))
    for down in range(size):
        for right in range(size):
            row = np.floor(rows[order] - half + down + 0.5).astype(np.int64)
            column = np.floor(columns[order] - half + right + 0.5).astype(np.int64)
            inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            at, which = (row[inside], column[inside]), order[inside]
            layer = np.full((height, width), np.inf)
            layer[at] = depths[which]
            shades = np.zeros((height, width, 3), np.uint8)
            shades[at] = colors[which]
            nearer = layer < near
            near[nearer], image[nearer] = layer[nearer], shades[nearer]
    return _lit(image, near)


def _lit(image: UInt8, near: Float64) -> UInt8:
    seen = np.isfinite(near)
    filled = np.where(seen, near, near[seen].max() if seen.any() else 0.0)
    shade = np.zeros_like(filled)
    for step in (1, 3):
        for axis in (0, 1):
            for way in (-step, step):
                shade += np.clip(filled - np.roll(filled, way, axis), 0, 12.0 * step) / step
    light = np.exp(-0.02 * shade)[..., None]
    return np.where(seen[..., None], image * light, image).astype(np.uint8)


def cloud_of(robot: Robot) -> Float64:
    """Return the points of all segments that a map of the drive holds, float64 (n, 3)."""
    parts = [segments.points[distinct[segments.owners]] for _, segments, distinct in robot.views()]
    return np.concatenate([np.zeros((0, 3)), *parts]).astype(np.float64)


def draw_map(robot: Robot, model: Path, file: Path) -> CompactMap:
    """Draw the cloud of a drive, and the map of it as its decoder and its classes tell it.

    Args:
        robot: drive with segments.
        model: folder of a model with classes and a shape decoder.
        file: PNG file to write.

    Returns:
        The map.
    """
    with Engine.temporary(model) as engine:
        decoder = ShapeDecoder(model, engine.model.manifest)
        content = robot.build_map(engine, robot.name, with_classes=True)
    assert content.classes is not None
    points, owners = decoded_points(content, decoder)
    cloud = cloud_of(robot)
    view = view_of(content)
    size = len(encode(content))
    titles = (
        f"Cloud: {len(cloud):,} points, {len(cloud) * POINT_BYTES / 1e6:.1f} MB",
        f"Map: {len(content):,} segments, {size / 1e3:.0f} kB "
        f"({size / len(content):.0f} bytes each), decoded",
    )
    images = (
        rendered(cloud, np.tile(GRAY, (len(cloud), 1)), view),
        rendered(points.astype(np.float64), class_colors(content.classes)[owners], view),
    )
    with figure(file, columns=2, size=6.0) as axes:
        drawn = axes[0].figure
        drawn.set_size_inches(12.0, 4.55)  # type: ignore[union-attr]
        for each, image, title in zip(axes, images, titles, strict=True):
            each.imshow(image, interpolation="antialiased")
            each.set_title(title, fontsize=12)
            each.set_axis_off()
        drawn.legend(
            handles=legend_of(content.classes),
            loc="outside lower center",
            ncol=len(CLASSES),
            fontsize=11,
            frameon=False,
            handlelength=1.0,
        )
    _reduce_colors(file)
    return content


def view_of(content: CompactMap) -> View:
    """Return the view across the way of the map's captures, from its right side."""
    way = content.frame_positions
    middle = np.median(way, axis=0)
    first, last = way[0, :2], way[-1, :2]
    yaw = float(np.arctan2(*(last - first)[::-1])) + np.pi / 2
    return View(middle, yaw, float(np.clip(np.linalg.norm(last - first) * 0.8, 60.0, 110.0)))


def _reduce_colors(file: Path) -> None:
    """Write a PNG file again with 33 levels of each color: half the bytes, and gray stays gray."""
    from PIL import Image

    with Image.open(file) as image:
        levels = np.asarray(image.convert("RGB"), np.float64) / 8
    reduced = np.minimum(np.rint(levels) * 8, 255).astype(np.uint8)
    Image.fromarray(reduced).save(file, optimize=True)


def legend_of(classes: UInt8) -> "list[Patch]":
    """Return the colors of the classes that occur, uint8 (n,), for a legend."""
    from matplotlib.patches import Patch

    indices = [index for index in np.unique(class_indices(classes)).tolist() if index >= 0]
    return [Patch(color=CLASS_COLORS[each] / 255, label=CLASSES[each]) for each in indices]
