"""`placecell maps render town:...` draws a map beside its cloud."""

import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from cli import app
from evaluation.poses.map_picture import View, rendered
from placecell.core.segment_classes import CLASSES
from placecell.export.content import CLASS_COLORS


@pytest.mark.slow
def test_town_is_drawn_as_cloud_and_as_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # `cli.maps.render` is the command; the module has the same name.
    monkeypatch.setattr(sys.modules["cli.maps.render"], "PICTURE_SCANS", 4)
    file = tmp_path / "map.png"
    done = CliRunner().invoke(app, ["maps", "render", "town:5:vlp-16", "-o", str(file)])
    assert done.exit_code == 0, done.output
    pixels = np.asarray(Image.open(file).convert("RGB")).reshape(-1, 3).astype(int)
    half = np.asarray(Image.open(file).convert("RGB")).shape[1] // 2
    image = pixels.reshape(-1, 2 * half, 3)
    colorful = np.ptp(image, axis=2) > 60
    legend = int(image.shape[0] * 0.85)
    assert colorful[:legend, half:].sum() > 500  # the map, by class
    assert colorful[:legend, :half].sum() == 0  # the cloud is gray


def test_picture_of_a_town_is_a_png(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["maps", "render", "town:5", "-o", str(tmp_path / "map.ply")])
    assert done.exit_code == 1
    assert "Name it .png" in done.output


def test_nearer_points_hide_farther_ones() -> None:
    view = View(np.zeros(3), np.pi / 2, 20.0)  # seen toward +y
    points = np.array([[0.0, 5.0, 0.0], [0.0, -5.0, 0.0], [3.0, 0.0, 0.0]])
    # The second point is raised to the line of sight of the first.
    slope = view.pixels(points)[:, 1]
    rise = (slope[1] - slope[0]) / (view.pixels(np.array([[0, 0, 0], [0, 0, 1.0]]))[:, 1] @ [1, -1])
    points[1, 2] += rise
    red, blue = CLASS_COLORS[CLASSES.index("vehicle")], CLASS_COLORS[0]
    image = rendered(points, np.stack([blue, red, blue]), view)
    column, row, _ = view.pixels(points)[1].astype(int)
    assert image[row, column, 0] > 2 * image[row, column, 2]
    right, row, _ = view.pixels(points)[2].astype(int)
    assert right > column
    assert image[row, right, 2] > 2 * image[row, right, 0]
