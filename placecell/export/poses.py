"""Writers of trajectories: TUM and g2o."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.export.content import ExportContent

INFORMATION = " ".join(
    "1" if row == column else "0" for row in range(6) for column in range(row, 6)
)
"""Upper triangle of the identity: the weights of edges are not known."""


def as_rows(poses: Float64) -> Float64:
    """Return position and quaternion x, y, z, w of poses, float64 (n, 7)."""
    if not len(poses):
        return np.zeros((0, 7))
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    return np.column_stack([poses[:, :3, 3], turns])


def line(row: Float64) -> str:
    """Return numbers with 9 decimals, separated by spaces."""
    return " ".join(f"{value:.9f}" for value in row)


def write_tum(content: ExportContent, file: Path) -> None:
    """Write a line for each capture: time, position and quaternion."""
    rows = np.column_stack([content.stamps, as_rows(content.poses)])
    lines = [f"# {content.frame}: time x y z qx qy qz qw", *map(line, rows)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_g2o(content: ExportContent, file: Path) -> None:
    """Write a pose graph: a vertex for each capture, and an edge from each to the next."""
    lines = [
        f"VERTEX_SE3:QUAT {index} {line(row)}" for index, row in enumerate(as_rows(content.poses))
    ]
    lines += ["FIX 0"] * bool(lines)
    steps = np.linalg.inv(content.poses[:-1]) @ content.poses[1:]
    lines += [
        f"EDGE_SE3:QUAT {index} {index + 1} {line(row)} {INFORMATION}"
        for index, row in enumerate(as_rows(steps))
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
