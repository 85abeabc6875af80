"""Trajectory of the robot in the map: TUM or KITTI format."""

from pathlib import Path
from typing import TextIO

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.export.poses import as_rows, line
from robot.core.map_to_odom import MapToOdom
from robot.outputs.output import NoOutput

KITTI_SUFFIXES = (".kitti",)


class TrajectoryFile(NoOutput):
    """Pose of the sensor in the map at each scan whose pose is known.

    A file whose name ends in `.kitti` has 12 numbers a line; any other one has TUM's time, position
    and quaternion. A pose is that of the moment of its scan: later fixes do not change it.
    """

    def __init__(self, file: Path) -> None:
        """Open the file; an existing one is replaced.

        Raises:
            OSError: the file cannot be written.
        """
        self.path = file
        file.parent.mkdir(parents=True, exist_ok=True)
        self._is_kitti = file.suffix in KITTI_SUFFIXES
        self._file: TextIO = file.open("w", encoding="utf-8")
        if not self._is_kitti:
            self._file.write("# time x y z qx qy qz qw: sensor in the map\n")

    def scan(
        self,
        time: float,
        points: Float32,  # noqa: ARG002
        odom_pose: Float64,
        map_to_odom: MapToOdom | None,
    ) -> None:
        """Write the pose of a scan, if it is known."""
        if map_to_odom is None:
            return
        pose = map_to_odom.pose(odom_pose)
        row = pose[:3].ravel() if self._is_kitti else np.array([time, *as_rows(pose[None])[0]])
        self._file.write(line(row) + "\n")

    def close(self) -> None:
        """Close the file."""
        self._file.close()
