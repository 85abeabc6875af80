"""Input of the doctor: any file or folder, opened as far as it can be."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from placecell.core.types import Float64
from placecell.datasets import FORMATS, Drive
from placecell.datasets.source_poses import given_poses
from placecell.inspection.problem import SourceProblem
from placecell.sources.catalog import open_source, source_class
from placecell.sources.errors import DriveError
from placecell.sources.imu import ImuSamples
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import (
    NO_ODOMETRY,
    current_scan_options,
    silent,
    use_scan_options,
)
from placecell.sources.source import ScanSource
from placecell.trajectories.reading import read_trajectory
from placecell.trajectories.trajectory import Trajectory

CLOUDS = ("PointCloud2", "PointCloud", "CustomMsg")
"""Types of messages with clouds, without their package."""


@dataclass(frozen=True, slots=True, eq=False)
class Subject:
    """Content of a path, opened as far as it can be.

    Attributes:
        path: file or folder.
        format: name of its format.
        stamps: time of each scan, float64 (scans,), seconds, in the files' order; NaN if unknown.
        read: function that reads a scan.
        fields: function that returns the names of the points' values, after a scan was read.
        frame: frame of the scans.
        trajectory: poses, or None.
        topics: name, type, number and rate of each topic of a bag.
        chosen: topic that the clouds are read from.
        transform: pose of the sensor on the robot, as text; "" if it does not matter.
        problems: what went wrong while the path was opened.
        notes: function that returns the reader's remarks.
        imu: function that returns what an IMU measured between two stamps, or None.
        about: facts on a file that is no source, such as a recording.
    """

    path: Path
    format: str
    stamps: Float64
    read: Callable[[int], LidarScan]
    fields: Callable[[], Sequence[str]]
    frame: str = ""
    trajectory: Trajectory | None = None
    topics: Sequence[dict[str, Any]] = ()
    chosen: str = ""
    transform: str = ""
    problems: Sequence[SourceProblem] = ()
    notes: Callable[[], Sequence[str]] = tuple
    imu: Callable[[float, float], ImuSamples | None] = lambda first, last: None  # noqa: ARG005
    about: str = ""


def open_subject(path: Path) -> Subject:
    """Open a file or folder for inspection; what cannot be read becomes a problem.

    Raises:
        DriveError: the path does not exist.
    """
    path = Path(path)
    if not path.exists():
        raise DriveError(f"{path}: does not exist. Check the path of the source")
    with use_scan_options(replace(current_scan_options(), tell=silent, strict=False)):
        options = current_scan_options()
        own_poses = options.poses is None and options.odometry in (None, NO_ODOMETRY)
        for reader in FORMATS if path.is_dir() else ():
            if not reader.recognizes(path.absolute()):
                continue
            if own_poses and reader.has_poses(path.absolute()):
                return of_drive(path.absolute(), reader)
            return of_scan_folder(path.absolute(), reader)
        ours = of_our_files(path)
        if ours is not None:
            return ours
        try:
            source = open_source(path)
        except DriveError as error:
            return without_scans(path, error)
        return of_source(source)


def nothing(path: Path, format_name: str, **facts: Any) -> Subject:
    """Return a subject without scans."""

    def read(index: int) -> LidarScan:
        raise DriveError(f"{path}: has no scan {index}")

    return Subject(path, format_name, np.zeros(0), read, tuple, **facts)


def of_drive(path: Path, reader: type[Drive]) -> Subject:
    """Open a drive in a known layout; if its poses are damaged, look at its scans only."""
    try:
        drive = reader(path)  # type: ignore[call-arg]
    except DriveError as error:
        return of_scan_folder(path, reader, SourceProblem.of("error", error))

    def read(index: int) -> LidarScan:
        points = np.asarray(drive.read_points(index), np.float32)
        return LidarScan.of(points, drive.read_times(index), float(drive.times[index]))

    trajectory = Trajectory(drive.poses, drive.times)
    columns = drive.point_layout.columns
    record = getattr(drive, "record_of", None)
    fields = columns if record is None else tuple(record(0).names or ())
    problems = [
        SourceProblem(
            "warning",
            drive.summary(range(len(drive))),
            "These scans are skipped. Copy the files again to use them.",
        )
    ]
    return Subject(
        path,
        drive.name,
        np.asarray(drive.times, np.float64),
        read,
        lambda: fields,
        trajectory=trajectory,
        problems=problems if drive.dropouts.skipped else (),
    )


def of_scan_folder(path: Path, reader: type[Drive], *problems: SourceProblem) -> Subject:
    """Describe the scans of a drive in a known layout without the drive's own poses."""
    try:
        scans = of_source(open_source(path / reader.scan_folder))
    except DriveError as error:
        return nothing(path, reader.name, problems=(*problems, SourceProblem.of("error", error)))
    return replace(scans, path=path, format=reader.name, problems=(*problems, *scans.problems))


def of_source(source: ScanSource) -> Subject:
    """Describe a source of scans."""
    problems: list[SourceProblem] = []
    trajectory = None
    transform = ""
    options = current_scan_options()
    try:
        given = given_poses(source, options)
        if given is not None:
            trajectory = replace(given.trajectory, poses=given.trajectory.poses @ given.mount)
            transform = given.how
    except DriveError as error:
        problems.append(SourceProblem.of("error", error))
    find_extrinsic = getattr(source, "extrinsic", None)
    own = options.poses is None and options.extrinsic is None
    if trajectory is not None and find_extrinsic is not None and own:
        mount = find_extrinsic()
        transform = f"{mount.base or '?'} -> {mount.sensor or source.frame or '?'}: {mount.how}"
        if not mount.found:
            problems.append(
                SourceProblem(
                    "warning",
                    f"The pose of the sensor {source.frame!r} on the robot is not known: "
                    f"{mount.how}. The identity is used",
                    "Record /tf_static, or state the sensor's pose with --extrinsic.",
                )
            )
    stamps = np.asarray(source.stamps, np.float64)
    order = getattr(source, "order", None)
    if order is not None:
        recorded = np.empty_like(stamps)
        recorded[order] = stamps
        stamps = recorded
    chosen = getattr(source, "cloud_topic", None)

    def read(index: int) -> LidarScan:
        return source.scan(index)

    return Subject(
        source.path,
        source.format,
        stamps,
        read,
        lambda: tuple(source.fields),
        source.frame,
        trajectory,
        topics_of(getattr(source, "bag", None)),
        chosen.name if chosen is not None else "",
        transform,
        problems,
        source.notes,
        source.imu,
    )


def topics_of(bag: Any) -> list[dict[str, Any]]:
    """Return name, type, number of messages and rate of each topic of a bag."""
    if bag is None:
        return []
    return [
        {
            "name": topic.name,
            "type": topic.type,
            "messages": len(topic),
            "rate_hz": round(topic.rate_hz, 2),
        }
        for topic in bag.topics
    ]


def of_our_files(path: Path) -> Subject | None:
    """Describe a recording or a map file of Placecell; None for other files."""
    if not path.is_file():
        return None
    with path.open("rb") as stream:
        begin = stream.read(4096)
    if b'"__metadata__"' not in begin and path.suffix not in (".safetensors", ".map", ".delta"):
        return None
    from placecell.segmentation.recording import Recording, RecordingError

    if b"placecell-delta" in begin:
        about = "a delta file of Placecell: the difference between two versions of a map"
        told = SourceProblem("error", about, "Give the map file, or the drive it was made from.")
        return nothing(path, "Placecell delta file", about=about, problems=(told,))
    cure = "Give the drive or bag that it was made from to inspect scans."
    try:
        recording = Recording.load(path)
    except RecordingError:
        count = segments_of_map(path)
        if count is None:
            return None
        about = f"a map file of Placecell: {count:,} segments"
        used = "Push it to a service with 'placecell maps push', or write it for other tools with "
        return nothing(
            path,
            "Placecell map file",
            about=about,
            problems=(SourceProblem("info", about, used + "'placecell export'."),),
        )
    about = (
        f"a recording of Placecell: {len(recording.segments):,} segments of {recording.scans:,} "
        f"scans of {recording.name!r}, {recording.path_length:,.0f} m"
    )
    return nothing(
        path, "Placecell recording", about=about, problems=(SourceProblem("info", about, cure),)
    )


def segments_of_map(path: Path) -> int | None:
    """Return the number of segments by the header of a map file; None for other files."""
    import safetensors

    try:
        with safetensors.safe_open(path, "numpy") as file:
            if '"placecell-map"' not in (file.metadata() or {}).get("placecell", ""):
                return None
            return int(file.get_slice("ids").get_shape()[0])
    except (safetensors.SafetensorError, OSError):
        return None


def without_scans(path: Path, error: DriveError) -> Subject:
    """Describe a path without scans: a bag without clouds, a trajectory, or neither."""
    try:
        return of_bag_without_clouds(path, error)
    except DriveError:
        pass  # It is no bag, or a damaged one.
    try:
        trajectory = read_trajectory(path) if path.is_file() else None
    except DriveError:
        trajectory = None
    if trajectory is None:
        found = source_class(path)
        name = "unknown" if found is None else found.format
        return nothing(path, name, problems=(SourceProblem.of("error", error),))
    return nothing(
        path,
        "trajectory",
        frame=trajectory.frame,
        trajectory=trajectory,
        problems=(
            SourceProblem(
                "error",
                f"{path}: holds {len(trajectory)} poses and no scans",
                "Give the drive or bag with the scans, and this file with --poses.",
            ),
            *(
                SourceProblem.of("info", f"{path}: {remark}", "No action is needed.")
                for remark in trajectory.remarks
            ),
        ),
    )


def of_bag_without_clouds(path: Path, error: DriveError) -> Subject:
    """Describe a bag without clouds, with its poses.

    Raises:
        DriveError: the path is no bag.
    """
    from placecell.sources.bags.bag_poses import read_poses
    from placecell.sources.bags.containers.bag import Bag

    bag = Bag(path)
    problems = [SourceProblem.of("error", error)]
    problems += [SourceProblem.of("warning", remark) for remark in bag.remarks]
    trajectory = None
    try:
        poses = read_poses(bag)
        trajectory = poses.body
        problems += [
            SourceProblem.of("info", remark, "No action is needed.") for remark in poses.remarks
        ]
    except DriveError as damaged:
        problems.append(SourceProblem.of("warning", damaged))
    kind = next((each for each in ("bag", "db3", "mcap") if bag.files[0].suffix == f".{each}"), "")
    name = {"bag": "ROS 1 bag", "db3": "ROS 2 bag", "mcap": "MCAP"}.get(kind, "bag")
    return nothing(path, name, trajectory=trajectory, topics=topics_of(bag), problems=problems)
