"""A drive in the layout of KITTI, and the same drive in bags."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from placecell.core.types import Float32, Float64
from placecell.datasets import open_drive
from placecell.sources.catalog import open_source
from tests.placecell.sources.bags.bag_builders import DRIVES, LAYOUTS, drive_messages

COUNT = 5


def scans() -> list[Float32]:
    """Return random scans."""
    random = np.random.default_rng(3)
    return list(random.normal(0, 25, (COUNT, 400, 3)).astype(np.float32))


def poses() -> list[Float64]:
    """Return the sensor's poses."""
    made = np.tile(np.eye(4), (COUNT, 1, 1))
    for number in range(COUNT):
        turn = 0.1 * number
        made[number, :2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
        made[number, :3, 3] = (number, 0.05 * number**2, 0)
    return list(made)


def write_kitti(folder: Path) -> Path:
    """Write the drive in the layout of KITTI odometry, with the camera's frame at the sensor."""
    (folder / "velodyne").mkdir(parents=True)
    for number, points in enumerate(scans()):
        table = np.column_stack((points, np.full(len(points), 0.5, np.float32)))
        (folder / "velodyne" / f"{number:06}.bin").write_bytes(table.astype("<f4").tobytes())
    lines = [" ".join(map(repr, pose[:3].ravel().tolist())) for pose in poses()]
    (folder / "poses.txt").write_text("\n".join(lines) + "\n")
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    (folder / "times.txt").write_text("".join(f"{0.1 * n:.6f}\n" for n in range(COUNT)))
    return folder


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", DRIVES)
def test_drive_in_a_bag_has_the_points_of_the_kitti_layout_bit_for_bit(
    name: str, layout: str, tmp_path: Path
) -> None:
    drive = open_drive(write_kitti(tmp_path / "kitti"))
    encoding, write = DRIVES[name]
    messages = drive_messages(scans(), poses(), encoding, LAYOUTS[layout])
    source = open_source(write(tmp_path / name, messages))
    assert len(source) == len(drive) == COUNT
    for index in range(COUNT):
        scan = source.scan(index)
        assert scan.points.tobytes() == drive.scan(index).tobytes()
        assert (scan.not_finite, scan.zeros) == (5, 9)
        assert scan.times is not None
    trajectory = source.trajectory()
    assert trajectory is not None
    assert trajectory.frame == "lidar"
    assert_allclose(trajectory.poses, drive.poses, atol=1e-9)
    assert_array_equal(trajectory.stamps, source.stamps)
