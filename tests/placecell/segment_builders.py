"""Builders for tests: shapes, drives in memory and drives in KITTI's layouts."""

from collections.abc import Sequence
from pathlib import Path
from typing import cast

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64
from placecell.datasets import Drive
from placecell.segmentation.recording import Recording

KITTI_TR = (
    "4.276802385584e-04 -9.999672484946e-01 -8.084491683471e-03 -1.198459927713e-02 "
    "-7.210626507497e-03 8.081198471645e-03 -9.999413164504e-01 -5.403984729748e-02 "
    "9.999738645903e-01 4.859485810390e-04 -7.206933692422e-03 -2.921968648686e-01"
)
"""Transform from sensor to left camera of KITTI's odometry sequences 00 to 02."""


def yaw_matrix(radians: float) -> Float64:
    """Return a rotation about z, (3, 3)."""
    c, s = np.cos(radians), np.sin(radians)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def pose(x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0) -> Float64:
    """Return a sensor-to-world transform, (4, 4)."""
    transform = np.eye(4)
    transform[:3, :3] = yaw_matrix(yaw)
    transform[:3, 3] = x, y, z
    return transform


def one_segment(points: object, sensor: object = (10.0, 0.0, 0.0)) -> Segments:
    """Return a single segment seen from a position."""
    return Segments.of([np.asarray(points, np.float32)], np.asarray([sensor], np.float32))


def many_segments(sizes: Sequence[int], seed: int = 0) -> Segments:
    """Return segments of these sizes at random places, seen from random positions."""
    generator = np.random.default_rng(seed)
    clouds = [
        (generator.normal(size=(size, 3)) * [1.5, 1.0, 0.7] + generator.uniform(-30, 30, 3)).astype(
            np.float32
        )
        for size in sizes
    ]
    return Segments.of(clouds, generator.uniform(-30, 30, (len(sizes), 3)))


class MemoryDrive(Drive):
    """Drive in memory, which counts how often each scan is read."""

    name = "memory"
    layout = "none"

    def __init__(self, scans: Sequence[object], poses: Sequence[Float64]) -> None:
        self.folder = Path("memory")
        self.scan_files = [Path(f"{index:06d}.bin") for index in range(len(scans))]
        self.poses = np.stack(poses)
        self.times = np.linspace(0.0, 1.0, len(scans))
        self.reads = [0] * len(scans)
        self._scans = [np.asarray(scan, np.float32).reshape(-1, 3) for scan in scans]

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return False

    def scan(self, index: int) -> Float32:
        self.reads[index] += 1
        return self._scans[index]


def write_scan(file: Path, points: object) -> None:
    """Write a Velodyne file: float32 x, y, z, reflectance."""
    cloud = np.asarray(points, np.float32).reshape(-1, 3)
    file.parent.mkdir(parents=True, exist_ok=True)
    np.column_stack([cloud, np.zeros(len(cloud))]).astype("<f4").tofile(file)


def write_odometry(folder: Path, scans: Sequence[object], poses: Sequence[Float64]) -> Path:
    """Write a KITTI odometry sequence from sensor poses."""
    tr = np.eye(4)
    tr[:3] = np.array(KITTI_TR.split(), dtype=np.float64).reshape(3, 4)
    rows = [(tr @ each @ np.linalg.inv(tr))[:3].ravel() for each in poses]
    for index, scan in enumerate(scans):
        write_scan(folder / "velodyne" / f"{index:06d}.bin", scan)
    np.savetxt(folder / "poses.txt", rows, fmt="%.9e")
    (folder / "calib.txt").write_text(f"P0: {'0 ' * 12}\nTr: {KITTI_TR}\n")
    np.savetxt(folder / "times.txt", np.arange(len(poses)) * 0.1, fmt="%.6e")
    return folder


IMU_TO_VELO = (
    "calib_time: 25-May-2012 16:47:16\n"
    "R: 1 0 0 0 1 0 0 0 1\n"
    "T: -8.086759e-01 3.195559e-01 -7.997231e-01\n"
)
"""Calibration with KITTI's lever arm and without its rotation (less than a degree)."""


def write_raw(
    folder: Path, records: Sequence[Sequence[float]], numbers: Sequence[int] | None = None
) -> Path:
    """Write a KITTI raw drive from lat, lon (degrees), alt, roll, pitch, yaw.

    `numbers`: of the scans that there are; every record has its oxts file and its time stamp.
    """
    for number in range(len(records)) if numbers is None else numbers:
        write_scan(folder / "velodyne_points" / "data" / f"{number:010d}.bin", [[5, 0, 0]])
    (folder / "oxts" / "data").mkdir(parents=True)
    for number, record in enumerate(records):
        values = " ".join(repr(float(value)) for value in [*record, *[0.0] * 24])
        (folder / "oxts" / "data" / f"{number:010d}.txt").write_text(values + "\n")
    stamps = [
        f"2011-09-30 12:40:{59 + n // 10 - 50:02d}.{n % 10}25072265" for n in range(len(records))
    ]
    (folder / "velodyne_points" / "timestamps.txt").write_text("\n".join(stamps) + "\n")
    (folder / "calib_imu_to_velo.txt").write_text(IMU_TO_VELO)
    return folder


def box(
    center: Sequence[float], size: Sequence[float], step: float = 0.1, sides: bool = True
) -> Float32:
    """Return points on the sides and the top of an upright box with its bottom at `center`."""
    (x, y, z), (a, b, c) = center, size
    us, vs, ws = (np.arange(0.0, length + step / 2, step) for length in (a, b, c))
    top = np.stack(np.meshgrid(us, vs, [c], indexing="ij"), -1).reshape(-1, 3)
    across = [np.stack(np.meshgrid(us, [v], ws, indexing="ij"), -1) for v in (0.0, b)]
    along = [np.stack(np.meshgrid([u], vs, ws, indexing="ij"), -1) for u in (0.0, a)]
    faces = [top, *(face.reshape(-1, 3) for face in (across + along if sides else []))]
    return cast(Float32, (np.concatenate(faces) + [x - a / 2, y - b / 2, z]).astype(np.float32))


def plane(half: float, step: float = 0.2, slope: float = 0.0, height: float = 0.0) -> Float32:
    """Return points on ground that rises by `slope` along x."""
    along = np.arange(-half, half + step / 2, step)
    x, y = (axis.ravel() for axis in np.meshgrid(along, along, indexing="ij"))
    return np.stack([x, y, height + slope * x], axis=1).astype(np.float32)


def one_scan_recording(
    segments: Segments, name: str = "made", distinct: Bool | None = None
) -> Recording:
    """Return a recording of one scan, in which each segment is a group of its own."""
    count = len(segments)
    return Recording(
        name=name,
        parameters=PROTOCOL_V1,
        segments=segments,
        captures=np.zeros(count, np.int64),
        groups=np.arange(count),
        distinct=np.ones(count, bool) if distinct is None else distinct,
        scans=1,
        scan_hashes=("",),
        path_length=0.0,
    )
