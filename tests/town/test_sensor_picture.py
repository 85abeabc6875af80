from pathlib import Path

import numpy as np
import pytest

from town.drives.sensor_picture import CAMERA, TILT, draw_sensors, through_camera


def test_camera_projects_its_axis_to_the_middle() -> None:
    """The point where the camera's axis meets the ground, and one a meter to its left."""
    ground = CAMERA[0] + CAMERA[1] / np.tan(TILT)
    points = np.array([[ground, 0, 0], [ground, 1, 0]], dtype=np.float32)
    right, up, depth = through_camera(points)
    assert up == pytest.approx([0, 0], abs=1e-6)
    assert depth == pytest.approx(CAMERA[1] / np.sin(TILT), rel=1e-6)
    assert right == pytest.approx([0, -1 / depth[0]], abs=1e-6)


@pytest.mark.slow
def test_picture_is_a_small_png(tmp_path: Path) -> None:
    draw_sensors(tmp_path / "docs" / "sensors.png")
    content = (tmp_path / "docs" / "sensors.png").read_bytes()
    assert content.startswith(b"\x89PNG")
    assert len(content) < 500_000
