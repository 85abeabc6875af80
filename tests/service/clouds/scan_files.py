"""Scans of a made-up yard, and files of them in each format."""

from collections.abc import Callable
from functools import cache
from io import BytesIO, StringIO
from typing import Any

import numpy as np

from placecell.core.types import Float32
from tests.placecell.sources.clouds.writers import las, pcd, ply

HEIGHT = 1.8
"""Height of the sensor above the ground of the yard, meters."""

PILLARS = ((12.0, 3.0), (-9.0, 7.0), (4.0, -15.0), (-14.0, -11.0), (20.0, 12.0))
"""Places of the yard's pillars, meters."""


def yard_scan(seed: int = 0, step: float = 0.2) -> Float32:
    """Points of a flat ground with pillars of 1 by 1 by 3 m, in the frame of a level sensor."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(-30, 30, 2 * step), np.arange(-30, 30, 2 * step))
    ground = np.stack([x.ravel(), y.ravel(), np.full(x.size, -HEIGHT)], axis=1)
    parts = [ground]
    for place in PILLARS:
        across = np.arange(-0.5, 0.5, step / 2)
        up = np.arange(0.0, 3.0, step / 2)
        a, z = (each.ravel() for each in np.meshgrid(across, up))
        for dx, dy in ((a, -0.5 + 0 * a), (a, 0.5 + 0 * a), (-0.5 + 0 * a, a), (0.5 + 0 * a, a)):
            parts.append(np.stack([place[0] + dx, place[1] + dy, z - HEIGHT], axis=1))
    points = np.concatenate(parts)
    return (points + random.normal(0, 0.005, points.shape)).astype(np.float32)


def turned(points: Float32, degrees: float, axis: int = 0) -> Float32:
    """Turn points around an axis of the sensor."""
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    rotation = np.eye(3)
    one, other = [each for each in range(3) if each != axis]
    rotation[one, one] = rotation[other, other] = cosine
    rotation[one, other], rotation[other, one] = -sine, sine
    return (points @ rotation.T).astype(np.float32)


def _saved(save: Any, *arrays: Any, **named: Any) -> bytes:
    stream = BytesIO()
    save(stream, *arrays, **named)
    return stream.getvalue()


def _text(points: Float32, delimiter: str, header: str = "") -> bytes:
    stream = StringIO()
    np.savetxt(stream, points, fmt="%.4f", delimiter=delimiter, header=header, comments="")
    return stream.getvalue().encode()


FIELDS = [("x", "F", 4, 1), ("y", "F", 4, 1), ("z", "F", 4, 1), ("ring", "U", 2, 1)]
PROPERTIES = ("float x", "float y", "float z", "uchar ring")


def _rows(points: Float32) -> list[list[float]]:
    return [[*row, index % 16] for index, row in enumerate(points.tolist())]


def _with_column(points: Float32) -> Float32:
    return np.insert(points, 3, np.arange(len(points)) % 7, axis=1).astype("<f4")


KINDS: dict[str, tuple[str, str, Callable[[Float32], bytes]]] = {
    "pcd": ("PCD", ".pcd", lambda points: pcd(FIELDS, _rows(points), "binary")),
    "pcd compressed": (
        "PCD",
        ".pcd",
        lambda points: pcd(FIELDS, _rows(points), "binary_compressed"),
    ),
    "pcd ascii": ("PCD", ".pcd", lambda points: pcd(FIELDS, _rows(points), "ascii")),
    "ply": ("PLY", ".ply", lambda points: ply("binary_little_endian", PROPERTIES, _rows(points))),
    "ply ascii": ("PLY", ".ply", lambda points: ply("ascii", PROPERTIES, _rows(points))),
    "las": ("LAS", ".las", lambda points: las(points.astype(np.float64))),
    "laz": ("LAS", ".laz", lambda points: las(points.astype(np.float64), True)),
    "bin": ("binary without header", ".bin", lambda points: _with_column(points).tobytes()),
    "npy": ("NumPy array", ".npy", lambda points: _saved(np.save, points)),
    "npz": ("NumPy archive", ".npz", lambda points: _saved(np.savez_compressed, points=points)),
    "csv": ("text", ".csv", lambda points: _text(points, ",", "x,y,z")),
    "xyz": ("text", ".xyz", lambda points: _text(points, " ")),
}
"""Format, ending and writer of each kind of file."""


@cache
def scan_file(kind: str, step: float = 0.2) -> tuple[str, str, bytes]:
    """Return a file of the yard's scan: format, ending and content.

    Call it in a test: each worker collects all modules, and the files take a second to write.
    """
    name, suffix, write = KINDS[kind]
    return name, suffix, write(yard_scan(step=step))
