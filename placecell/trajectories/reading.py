"""Reader of trajectory files: KITTI, TUM, EuRoC, CSV and g2o, told by their content."""

from pathlib import Path

import numpy as np

from placecell.core.errors import DriveError
from placecell.core.text_files import read_lines
from placecell.core.types import Float64
from placecell.trajectories.g2o import is_g2o, read_g2o
from placecell.trajectories.named_columns import NamedColumns, of_names, scaled
from placecell.trajectories.poses import (
    as_transforms,
    check_quaternions,
    check_rotations,
    of_quaternions,
)
from placecell.trajectories.table import TextTable, read_text_table
from placecell.trajectories.times import in_order, unit_since_epoch
from placecell.trajectories.trajectory import Trajectory

WHAT = (
    "a trajectory: KITTI (12 numbers a line), TUM (time x y z qx qy qz qw), EuRoC or another CSV "
    "with a header, or g2o"
)
BOTTOM = (0.0, 0.0, 0.0, 1.0)
XYZW = [0, 1, 2, 3]
WXYZ = [1, 2, 3, 0]


def read_trajectory(path: Path) -> Trajectory:
    """Read a trajectory file; its format is told by its content.

    Formats: KITTI (12 numbers a line, times in a file beside it), 4x4 matrices, TUM (8 numbers),
    EuRoC, MulRan (time and 3x4), CSV with a header, g2o. Lines that begin with # or % are comments.

    Raises:
        DriveError: the file cannot be read; the message names the file, the line and what to do.
    """
    path = Path(path)
    lines = read_lines(path, WHAT)
    first = next((line for line in lines if line.strip() and not line.startswith(("#", "%"))), "")
    if is_g2o(first):
        return read_g2o(path, lines)
    table = read_text_table(path, WHAT)
    if table.names and "position" in NamedColumns.of(table.names).found:
        return of_names(table)
    if table.names and not is_plain(table):
        return of_names(table)
    return of_width(table)


def is_plain(table: TextTable) -> bool:
    """Return whether the names are a comment that describes no column."""
    known = NamedColumns.of(table.names).found
    return not known.keys() & {"east", "euler", "quaternion", "matrix"} and table.width in WIDTHS


def of_width(table: TextTable) -> Trajectory:
    """Build a trajectory of a table without names, by its number of columns.

    Raises:
        DriveError: no format has this number of columns, or a value is wrong.
    """
    for row, line in zip(table.rows, table.lines, strict=True):
        if len(row) != table.width:
            raise DriveError(
                f"{table.file}, line {line}: {len(row)} values, expected {table.width} as in line "
                f"{table.lines[0]}. The file may be cut short; remove the line"
            )
    if table.width not in WIDTHS:
        raise DriveError(
            f"{table.file}, line {table.lines[0]}: {table.width} values a line; it must hold "
            f"{WHAT}. Or give the columns names in a header line, such as "
            "timestamp,x,y,z,qx,qy,qz,qw"
        )
    values = table.numbers(range(table.width))
    width = table.width
    if width == 4:
        return of_blocks(table, values)
    if width == 7:
        return of_positions(table, values, XYZW)
    if width in (12, 16):
        return with_times_beside(table.file, of_matrices(table.file, values))
    if width == 13 or (width == 17 and np.allclose(values[:, 13:], BOTTOM)):
        return timed(values[:, 0], of_matrices(table.file, values[:, 1:]), [])
    if not table.separator and width == 8:
        return of_stamped(table, values, XYZW, [])
    # EuRoC's files have nanoseconds, and qw first; other tables without a header follow TUM.
    is_euroc = width == 17 or unit_since_epoch([values[0, 0]]) == "ns"
    names = "qw, qx, qy, qz, as EuRoC's" if is_euroc else "qx, qy, qz, qw, as TUM's"
    remark = (
        f"the columns have no names; they are read as time, x, y, z, {names}. Add a header line"
    )
    return of_stamped(table, values, WXYZ if is_euroc else XYZW, [remark])


WIDTHS = (4, 7, 8, 12, 13, 16, 17)
"""Numbers of columns of formats without a header."""


def of_positions(table: TextTable, values: Float64, order: list[int]) -> Trajectory:
    """Build poses of position and quaternion, without times."""
    turns = values[:, 3:7][:, order]
    check_quaternions(turns, table.file, table.line_numbers)
    poses = of_quaternions(values[:, :3], turns)
    return with_times_beside(table.file, poses)


def of_stamped(
    table: TextTable, values: Float64, order: list[int], remarks: list[str]
) -> Trajectory:
    """Build poses of time, position and quaternion."""
    turns = values[:, 4:8][:, order]
    check_quaternions(turns, table.file, table.line_numbers)
    return timed(values[:, 0], of_quaternions(values[:, 1:4], turns), remarks)


def timed(times: Float64, poses: Float64, remarks: list[str]) -> Trajectory:
    """Return a trajectory with times in their found unit, in order."""
    stamps, poses, order = in_order(scaled(times, "", remarks), poses)
    return Trajectory(poses, stamps, remarks=(*remarks, *order))


def of_blocks(table: TextTable, values: Float64) -> Trajectory:
    """Build poses of 4x4 matrices with one row a line."""
    if len(values) % 4 or not np.allclose(values[3::4], BOTTOM):
        raise DriveError(
            f"{table.file}: 4 values a line, but not each fourth line is 0 0 0 1 as in a 4x4 "
            f"matrix; it must hold {WHAT}"
        )
    return with_times_beside(table.file, of_matrices(table.file, values.reshape(-1, 16)))


def of_matrices(file: Path, values: Float64) -> Float64:
    """Return poses of rows of 12 or 16 numbers.

    Raises:
        DriveError: the matrices are no rigid transforms.
    """
    if values.shape[1] == 16:
        square = values.reshape(-1, 4, 4)
        if not np.allclose(square[:, 3], BOTTOM, atol=1e-6):
            if np.allclose(square[:, :, 3], BOTTOM, atol=1e-6):
                square = square.transpose(0, 2, 1)  # column by column, as OpenGL and Eigen do
            else:
                raise DriveError(
                    f"{file}: 16 values a line, but the last four are not 0 0 0 1 as in a 4x4 "
                    "matrix"
                )
        values = square[:, :3].reshape(-1, 12)
    poses = as_transforms(values)
    check_rotations(poses, file)
    return poses


def with_times_beside(file: Path, poses: Float64) -> Trajectory:
    """Return poses with the times of the file beside, if there is one: NAME_times.txt, times.txt.

    Raises:
        DriveError: the file beside has another number of times.
    """
    beside = [file.with_name(f"{file.stem}_times.txt"), file.with_name("times.txt")]
    if file.parent.name == "poses":  # KITTI's own archive
        beside.append(file.parent.parent / "sequences" / file.stem / "times.txt")
    for times_file in beside:
        if not times_file.is_file() or times_file == file:
            continue
        table = read_text_table(times_file, "a time a line")
        times = table.numbers([0])[:, 0]
        if len(times) != len(poses):
            raise DriveError(
                f"{times_file}: {len(times)} times for the {len(poses)} poses of {file}; expected "
                "one a pose. Move the file away if it does not belong to the poses"
            )
        return timed(times, poses, [f"the times are those of {times_file.name}"])
    return Trajectory(
        poses, remarks=("the file has no times: its poses belong to the scans in order",)
    )
