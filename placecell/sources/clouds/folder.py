"""Folders of point cloud files, and single files."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from math import nan
from pathlib import Path

import numpy as np

from placecell.core.types import Float64
from placecell.sources.clouds.cloud import (
    CloudClock,
    as_scan,
    find_axes,
    find_cloud_clock,
    printable,
)
from placecell.sources.clouds.finding import find_clouds, folder_of_scans
from placecell.sources.clouds.formats import RAW, ReadOptions, format_of, read_cloud
from placecell.sources.clouds.raw import layout_of
from placecell.sources.clouds.times import stamps_beside, stamps_of_names
from placecell.sources.clouds.viewpoints import (
    in_world,
    read_viewpoints,
    stated,
    to_sensor,
    viewpoint_of,
)
from placecell.sources.errors import DriveError
from placecell.sources.file_hash import file_hash
from placecell.sources.point_layout import KITTI
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import METERS, current_scan_options
from placecell.sources.source import ScanSource
from placecell.trajectories.trajectory import Trajectory

MOST_REMARKS = 20
SAMPLED = 5
"""Number of scans that tell the clock of the points' times, and the frame of the points."""


def spread(count: int) -> list[int]:
    """Return some of `count` indices, evenly spread."""
    indices: list[int] = np.unique(np.linspace(0, count - 1, SAMPLED).astype(int)).tolist()
    return indices


class FolderOfClouds(ScanSource):
    """A folder of point cloud files, one scan a file; or a single file, as one scan.

    The scans are the files of the most frequent format, in the folder itself or in one folder
    inside it. They are ordered by the numbers in their names. Names that are times, or a file
    `times.txt` or `timestamps.txt` beside, give the stamps.
    """

    format = "point cloud files"

    def __init__(self, path: Path) -> None:
        """Find the scans and the layout of files without a header.

        Raises:
            DriveError: no scans, several formats, or a layout that is not sure.
        """
        self.path = path
        self.options = current_scan_options()
        self.remarks: dict[str, None] = {}
        self.files, self.cloud_format = find_clouds(path, self.remark)
        self.stamps = self.find_stamps()
        self.read_options = ReadOptions(self.options.columns)
        if self.cloud_format is RAW:
            layout = layout_of(self.files, self.options)
            self.read_options = replace(self.read_options, layout=layout)
            if layout.columns != KITTI.columns or layout.dtype != KITTI.dtype:
                how = "as stated" if self.options.states_layout else "found from their values"
                self.remark(f"scans have {layout}, {how}")
        raw = self.cloud_format is RAW
        self.scale = self.read_options.layout.scale if raw else METERS[self.options.unit]
        self.shift: Float64 | None = None
        self.examine()

    @classmethod
    def recognizes(cls, path: Path) -> bool:
        if path.is_file():
            return format_of(path) is not None
        try:
            return path.is_dir() and folder_of_scans(path) is not None
        except DriveError:
            return True  # several folders of clouds: the constructor says so

    def remark(self, text: str) -> None:
        """Keep a remark for the user, and tell it once."""
        text = printable(text)
        if text not in self.remarks and len(self.remarks) < MOST_REMARKS:
            self.remarks[text] = None
            self.options.tell(f"{self.path}: {text}")

    def notes(self) -> Sequence[str]:
        return tuple(self.remarks)

    def examine(self) -> None:
        """Read the first scan that can be read: it gives the fields and the shift.

        Raises:
            DriveError: the source is a single file, and it cannot be read.
        """
        for index in range(min(len(self.files), 3)):
            try:
                self.scan(index)
                return
            except DriveError:
                if len(self.files) == 1:
                    raise

    @cached_property
    def clock(self) -> CloudClock | None:
        """Field with the points' times, and its clock, found from several scans."""
        steps = np.diff(self.stamps)
        period = float(np.median(steps[steps > 0])) if (steps > 0).any() else None
        clouds = []
        for index in spread(len(self.files)):
            with suppress(DriveError):  # the scan raises it again
                file = self.files[index]
                cloud = read_cloud(file, self.read_options)
                clouds.append((cloud, file, float(self.stamps[index])))
        clock = find_cloud_clock(clouds, period)
        if clock is not None:
            self.remark(f"the times of points ({clock.field}) are in {clock.clock}")
        return clock

    def find_stamps(self) -> Float64:
        """Return the time of each scan, from a file beside or from the names; else NaN."""
        if len(self.files) > 1:
            folder = self.files[0].parent
            beside = stamps_beside(self.files, (folder, folder.parent), self.options.time_unit)
            if beside is not None:
                stamps, told = beside
                self.remark(told)
                if stamps is not None:
                    return stamps
        stamps = stamps_of_names([file.stem for file in self.files])
        if stamps is None:
            return np.full(len(self.files), nan)
        self.remark("the names of the files give the times of the scans")
        order = np.argsort(stamps, kind="stable")
        self.files = [self.files[index] for index in order]
        return stamps[order]

    def scan(self, index: int) -> LidarScan:
        file = self.files[index]
        cloud = read_cloud(file, self.read_options)
        self.fields = self.fields or cloud.fields
        scan, shift = as_scan(
            cloud, file, float(self.stamps[index]), self.scale, self.shift, self.clock
        )
        for text in cloud.remarks:
            self.remark(f"{file.name}: {text}")
        axes = find_axes(cloud.fields)
        if axes is not None and axes.scale != 1.0:
            self.remark(f"the fields {', '.join(axes.names)} are not in meters; converted")
        if self.shift is None and scan.read:
            self.shift = shift
            if shift.any():
                shown = ", ".join(f"{value:.0f}" for value in shift)
                self.remark(
                    f"the coordinates are far from 0: ({shown}) m is subtracted from all scans, "
                    "because float32 would lose their digits"
                )
        if self.in_world:
            points = to_sensor(scan.points, self.viewpoint(index), shift)
            return replace(scan, points=points)
        return scan

    def viewpoint(self, index: int) -> Float64:
        """Return the sensor's pose by the VIEWPOINT of a PCD file, float64 (4, 4)."""
        return np.asarray(read_viewpoints([self.files[index]], self.scale)[0])

    @cached_property
    def in_world(self) -> bool:
        """Whether the points of PCD files are in the world's frame, not in the sensor's."""
        if self.cloud_format.name != "PCD":
            return False
        chosen = spread(len(self.files))
        poses = read_viewpoints([self.files[index] for index in chosen], self.scale)
        if not stated(poses).any():
            return False
        clouds = []
        for index in chosen:
            clouds.append(np.zeros((0, 3), np.float32))
            with suppress(DriveError):  # The scan raises it again.
                file = self.files[index]
                cloud = read_cloud(file, self.read_options)
                clouds[-1] = as_scan(cloud, file, scale=self.scale, shift=np.zeros(3))[0].points
        found = in_world(poses, clouds)
        told = (
            "the points are in the world's frame already and are moved back to the sensor's"
            if found
            else "the points are in its frame"
        )
        first = self.files[chosen[int(stated(poses).argmax())]]
        shown = " ".join(f"{value:g}" for value in viewpoint_of(first))
        self.remark(f"VIEWPOINT {shown} ({first.name}) is the pose of the sensor; {told}")
        return found

    def trajectory(self) -> Trajectory | None:
        if self.cloud_format.name != "PCD":
            return None
        poses = read_viewpoints(self.files, self.scale)
        return Trajectory(poses) if stated(poses).any() else None

    def scan_hash(self, index: int) -> str:
        """Return a scan's identity (see `file_hash`)."""
        return file_hash(self.files[index], self.title)
