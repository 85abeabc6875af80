"""Simulated drives with any two sensors through one place, prepared once and kept in a folder."""

import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy as np

from evaluation.poses.queries import Pair
from evaluation.poses.robot import Robot
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording

SCANS = 300
"""Default number of scans of a drive."""

Name = Literal["robot_a", "robot_b", "other_day"]

BOTH: tuple[Name, Name] = ("robot_a", "robot_b")

OTHER_DAY: Name = "other_day"
"""Robot that drives the way of robot A on another day, when all parked cars changed."""


@dataclass(slots=True, eq=False)
class DrivenPath:
    """Path of a drive whose scans are no longer there.

    Attributes:
        folder: folder of the drive; only its name is used.
        poses: float64 (scans, 4, 4), sensor to the drive's world.
        times: float64 (scans,), seconds.
    """

    folder: Path
    poses: Float64
    times: Float64

    def __len__(self) -> int:
        return len(self.poses)

    @property
    def title(self) -> str:
        """Return the name of the drive in reports."""
        return self.folder.name

    def path_length(self) -> float:
        """Return the length of the path, meters."""
        return float(np.linalg.norm(np.diff(self.poses[:, :3, 3], axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True)
class TownDrives:
    """Drives of two robots through one place: robot B drives in the opposite direction.

    A drive is simulated and segmented when it is first used. Its segments and its path are kept in
    `cache`; its scans are not.

    Attributes:
        cache: folder of the prepared drives.
        seed: seed of the place, the route, the parked cars and the noise.
        place: name of the place.
        scans: number of scans of each drive.
        every: scans from one capture to the next, as `Parameters.for_drive`.
        protocol: parameters of the segmentation.
    """

    cache: Path
    seed: int
    place: str = "streets"
    scans: int = SCANS
    every: int | None = None
    protocol: Parameters = PROTOCOL_V1

    def pair(
        self,
        map_sensor: str,
        query_sensor: str,
        progress: Progress = silent,
        *,
        other_day: bool = False,
    ) -> Pair:
        """Return robot A with the map's sensor, and robot B with the queries' sensor.

        Args:
            map_sensor: sensor of the map's robot.
            query_sensor: sensor of the queries' robot.
            progress: wraps the loops.
            other_day: let the queries' robot drive the way of robot A on another day, when all
                parked cars changed, in place of robot B.

        Raises:
            ValueError: a sensor or the place is unknown.
        """
        self.check((map_sensor, query_sensor))
        mapper = self.robot("robot_a", map_sensor, progress)
        asker = self.robot(OTHER_DAY if other_day else "robot_b", query_sensor, progress)
        return Pair(mapper, asker, blocks=False)

    def check(self, sensors: Iterable[str]) -> None:
        """Check the names of sensors and of the place.

        Raises:
            ValueError: a sensor or the place is unknown.
        """
        import town
        from town.places.catalog import kind_of

        kind_of(self.place)
        for name in sensors:
            town.sensor(name)

    def robot(self, name: Name, sensor: str, progress: Progress = silent) -> Robot:
        """Return a robot with a sensor; simulate and segment its drive unless it is kept.

        Raises:
            ValueError: the sensor or the place is unknown.
        """
        if not self._path_file(name, sensor).exists():
            self.prepare(sensor, (name,), progress)
        with np.load(self._path_file(name, sensor)) as kept:
            path = DrivenPath(self._folder(name, sensor), kept["poses"], kept["times"])
            origin = np.array(kept["origin"])
        recording = Recording.load(self._recording_file(name, sensor))
        return Robot(name.replace("_", " "), path, [recording], origin, sensor)

    def prepare(
        self, sensor: str, names: tuple[Name, ...] = BOTH, progress: Progress = silent
    ) -> None:
        """Simulate and segment the drives of a sensor that are not kept yet.

        Raises:
            ValueError: the sensor or the place is unknown.
        """
        missing = [name for name in names if not self._path_file(name, sensor).exists()]
        if missing:
            with self._simulated(sensor, progress, other_day=OTHER_DAY in missing) as folders:
                for name in missing:
                    self._keep(folders[name], name, sensor, progress)

    @contextmanager
    def _simulated(
        self, sensor: str, progress: Progress, *, other_day: bool
    ) -> Iterator[dict[Name, Path]]:
        """Simulate both robots, or the one of another day; the scans are deleted at the end."""
        import town

        with TemporaryDirectory(prefix="placecell-town-") as folder:
            if other_day:
                drive = town.one_robot(
                    Path(folder),
                    self.seed,
                    self.scans,
                    place=self.place,
                    lidar=town.sensor(sensor),
                    other_cars=True,
                    progress=progress,
                )
                yield {OTHER_DAY: drive}
                return
            drives = town.two_robots(
                Path(folder),
                seed=self.seed,
                place=self.place,
                scans=self.scans,
                lidar=town.sensor(sensor),
                progress=progress,
            )
            yield dict(zip(BOTH, drives, strict=True))

    def _keep(self, folder: Path, name: Name, sensor: str, progress: Progress) -> None:
        """Segment a drive, and write its recording and its path into the cache."""
        from town import read_origin

        drive = open_drive(folder)
        recording = record(
            drive, self.protocol.for_drive(len(drive), self.every), progress=progress
        )
        to = self._folder(name, sensor)
        to.parent.mkdir(parents=True, exist_ok=True)
        # Each file appears whole, and the path last, so that a stopped run leaves no half drive.
        with TemporaryDirectory(prefix=".part-", dir=to.parent) as part:
            recording_file, path_file = Path(part) / "segments.safetensors", Path(part) / "path.npz"
            recording.save(recording_file)
            origin = read_origin(folder)
            np.savez(path_file, poses=drive.poses, times=drive.times, origin=origin)
            recording_file.replace(self._recording_file(name, sensor))
            path_file.replace(self._path_file(name, sensor))
        shutil.rmtree(folder)

    @property
    def step(self) -> int:
        """Scans from one capture to the next."""
        return self.protocol.for_drive(self.scans, self.every).frame_step

    def _folder(self, name: Name, sensor: str) -> Path:
        drives = f"{self.place}-{self.seed}-{self.scans}-every-{self.step}"
        if self.protocol != PROTOCOL_V1:
            drives += f"-{self.protocol.protocol}"
        return self.cache / drives / f"{sensor}-{name}"

    def _recording_file(self, name: Name, sensor: str) -> Path:
        return self._folder(name, sensor).with_suffix(".safetensors")

    def _path_file(self, name: Name, sensor: str) -> Path:
        return self._folder(name, sensor).with_suffix(".npz")
