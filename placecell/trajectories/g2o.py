"""Pose graphs in the format of g2o: VERTEX_SE3:QUAT and VERTEX_SE2."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from placecell.core.errors import DriveError
from placecell.core.types import Float64
from placecell.trajectories.poses import check_quaternions, of_euler, of_quaternions
from placecell.trajectories.times import SECONDS, UNIT_NAMES, unit_since_epoch
from placecell.trajectories.trajectory import Trajectory

VERTICES = {"VERTEX_SE3:QUAT": 7, "VERTEX_SE2": 3}
"""Number of values after the id."""
WORDS = ("VERTEX", "EDGE", "FIX", "PARAMS")
INDEX_BITS = 56
"""GTSAM's keys: a letter in the upper byte, an index below."""


def is_g2o(line: str) -> bool:
    """Return whether a line begins as those of a pose graph."""
    return line.startswith(WORDS)


def read_g2o(file: Path, lines: Sequence[str]) -> Trajectory:
    """Read the vertices of a pose graph, ordered by id; edges are ignored.

    Raises:
        DriveError: no vertex is a pose, a value is wrong, or the poses are several robots'.
    """
    found: dict[int, tuple[int, list[float], str]] = {}
    for number, line in enumerate(lines, start=1):
        words = line.split()
        if not words or words[0] not in VERTICES:
            continue
        kind = words[0]
        try:
            identity, values = int(words[1]), [float(word) for word in words[2:]]
        except (ValueError, IndexError) as error:
            raise DriveError(
                f"{file}, line {number}: {error}; expected {kind} ID VALUES"
            ) from error
        if len(values) != VERTICES[kind] or not np.isfinite(values).all():
            raise DriveError(
                f"{file}, line {number}: {len(values)} values, expected {VERTICES[kind]} finite "
                f"values after the id of a {kind}"
            )
        if found.setdefault(identity, (number, values, kind))[0] != number:
            raise DriveError(
                f"{file}, line {number}: the id {identity} was used before, on line "
                f"{found[identity][0]}. Give each pose an id of its own"
            )
    if not found:
        raise DriveError(f"{file}: no vertex is a pose; expected {' or '.join(VERTICES)} lines")
    if len({kind for _, _, kind in found.values()}) > 1:
        raise DriveError(f"{file}: has both 2D and 3D poses. Give a file with one kind")
    ids = sorted(found)
    letters = {letter_of(identity) for identity in ids}
    if len(letters) > 1:
        raise DriveError(
            f"{file}: the ids have the letters {', '.join(sorted(letters))}: poses of several "
            "robots. Give a file with the poses of one robot"
        )
    rows = [found[identity] for identity in ids]
    table = np.array([row[1] for row in rows])
    if rows[0][2] == "VERTEX_SE2":
        positions = np.pad(table[:, :2], ((0, 0), (0, 1)))
        angles = np.pad(table[:, 2:], ((0, 0), (2, 0)))
        return with_ids(of_euler(positions, angles), ids)
    check_quaternions(table[:, 3:], file, np.array([row[0] for row in rows]))
    return with_ids(of_quaternions(table[:, :3], table[:, 3:]), ids)


def letter_of(identity: int) -> str:
    """Return the letter of a GTSAM key; "" for another id."""
    letter = chr(identity >> INDEX_BITS) if 0 <= identity < 1 << 64 else ""
    return letter if letter.isalpha() and letter.isascii() else ""


def with_ids(poses: Float64, ids: Sequence[int]) -> Trajectory:
    """Return poses whose ids are times, if their magnitude shows it, else a number in order."""
    numbers = np.array([float(identity) for identity in ids])
    unit = unit_since_epoch([float(np.median(numbers))])
    if unit is not None and letter_of(ids[0]) == "" and len(set(ids)) == len(ids):
        remark = f"the ids are times in {UNIT_NAMES[unit]} since 1970"
        return Trajectory(poses, numbers * SECONDS[unit], remarks=(remark,))
    return Trajectory(poses, remarks=("the ids give the order of the poses, and no times",))
