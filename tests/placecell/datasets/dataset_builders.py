"""Synthetic files in the exact layouts of MulRan and HeLiPR."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.datasets.helipr import EARLY_AEVA, LAST_EARLY_AEVA, RECORDS
from placecell.datasets.mulran import base_to_ouster

START_NS = 1_561_000_444_390_857_630
"""Time of the first pose, as in KAIST01."""

SCAN_NS = 100_000_000
POSE_NS = 10_000_000

OUSTER_POINTS = 64 * 1024
"""Points of each scan of MulRan; a pixel without a return is (0, 0, 0, 0)."""


def write_mulran(
    folder: Path, scans: Sequence[object], poses: Sequence[Float64], every_ns: int = SCAN_NS
) -> Path:
    """Write a sequence of MulRan from sensor poses; each scan 5 ms after a pose of the vehicle.

    The vehicle stands still around each scan, so that the interpolated pose is exact.
    """
    (folder / "Ouster").mkdir(parents=True)
    on_vehicle = np.linalg.inv(base_to_ouster())
    lines = []
    for index, (scan, pose) in enumerate(zip(scans, poses, strict=True)):
        stamp = START_NS + index * every_ns
        points = np.zeros((OUSTER_POINTS, 4), dtype="<f4")
        given = np.asarray(scan, dtype=np.float32).reshape(-1, 3)
        points[: len(given), :3] = given
        points[: len(given), 3] = 120.0
        (folder / "Ouster" / f"{stamp + POSE_NS // 2}.bin").write_bytes(points.tobytes())
        for time in (stamp, stamp + POSE_NS):
            row = ",".join(f"{value:.9f}" for value in (pose @ on_vehicle)[:3].ravel())
            lines.append(f"{time},{row}\n")
    (folder / "global_pose.csv").write_text("".join(lines))
    return folder


def write_helipr(
    sequence: Path,
    sensor: str,
    scans: Sequence[object],
    poses: Sequence[Float64],
    first_ns: int = LAST_EARLY_AEVA + SCAN_NS,
    truth: str = "global_{}_gt.txt",
) -> Path:
    """Write one sensor of a sequence of HeLiPR from its poses; return the sensor's folder."""
    folder = sequence / "LiDAR" / sensor
    folder.mkdir(parents=True)
    (sequence / "LiDAR_GT").mkdir(exist_ok=True)
    lines = []
    for index, (scan, pose) in enumerate(zip(scans, poses, strict=True)):
        stamp = first_ns + index * SCAN_NS
        given = np.asarray(scan, dtype=np.float32).reshape(-1, 3)
        early = sensor == "Aeva" and stamp <= LAST_EARLY_AEVA
        points = np.zeros(len(given), EARLY_AEVA if early else RECORDS[sensor])
        for name in points.dtype.names or ():
            points[name] = 7
        for axis, name in enumerate("xyz"):
            points[name] = given[:, axis]
        (folder / f"{stamp}.bin").write_bytes(points.tobytes())
        position, turn = pose[:3, 3], Rotation.from_matrix(pose[:3, :3]).as_quat()
        lines.append(f"{stamp} {' '.join(f'{value:.9f}' for value in (*position, *turn))}\n")
    (sequence / "LiDAR_GT" / truth.format(sensor)).write_text("".join(lines))
    return folder
