"""Maps of two robots that drove the same street, for the page to show."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from placecell_client import Client, CompactMap

from evaluation.poses.queries import random_frame
from evaluation.poses.robots import in_own_frame, robots_of_town
from placecell.core.types import Float32, Float64
from placecell.datasets import open_drive
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from placecell.segmentation.pipeline import Progress
from service.engine import Engine


@dataclass(frozen=True, slots=True)
class TwoRobots:
    """Maps of two robots, and one scan of the first.

    Attributes:
        yard, hall: their maps, each in a frame of its own.
        scan: float32 (n, 3), a scan of the first robot, meters, sensor frame.
        position: float64 (3,), where the scan was taken, meters, frame of `yard`.
    """

    yard: CompactMap
    hall: CompactMap
    scan: Float32
    position: Float64

    @classmethod
    def in_town(
        cls,
        folder: Path,
        seed: int,
        scans: int,
        progress: Progress,
        *,
        with_classes: bool = False,
    ) -> "TwoRobots":
        """Let two robots drive through a town in opposite directions.

        Args:
            folder: folder for the drives.
            seed: random seed of the town and of the second robot's frame.
            scans: scans of each robot.
            progress: function that shows the progress.
            with_classes: whether the maps have the classes of their segments.
        """
        a, b = robots_of_town(folder, seed, scans, progress)
        b = in_own_frame(b, random_frame(seed))
        with Engine.temporary(MODELS_FOLDER / DEFAULT_MODEL) as engine:
            yard, hall = (
                robot.build_map(engine, name, with_classes=with_classes)
                for robot, name in ((a, "yard"), (b, "hall"))
            )
        middle = scans // 2
        scan = open_drive(a.drive.folder).scan(middle)
        return cls(yard, hall, scan, a.drive.poses[middle, :3, 3])

    def store(self, address: str) -> None:
        """Store both maps in a service."""
        with Client(address) as client:
            client.put_map("yard", self.yard)
            client.put_map("hall", self.hall)

    def scan_file(self, folder: Path) -> Path:
        """Write the scan as a KITTI file."""
        file = folder / "scan.bin"
        strength = np.zeros((len(self.scan), 1), np.float32)
        np.concatenate([self.scan, strength], axis=1).tofile(file)
        return file
