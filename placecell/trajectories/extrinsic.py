"""Extrinsic calibration: where the sensor is mounted on the frame whose poses are known."""

import re
import warnings
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.errors import DriveError
from placecell.core.text_files import read_lines
from placecell.core.types import Float64
from placecell.trajectories.poses import (
    as_transforms,
    check_quaternions,
    check_rotations,
    of_euler,
    of_quaternions,
)

FORMS = (
    "identity; x y z roll pitch yaw in meters and radians (append deg for degrees); "
    "x y z qx qy qz qw; a 3x4 or 4x4 matrix row by row; or a file with one of these, KITTI's "
    "calib.txt with 'Tr:' among them"
)
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
UNITS = {"rad": 1.0, "deg": np.pi / 180}


def parse_extrinsic(text: str) -> Float64:
    """Return the transform from the sensor's frame to the frame of the poses, (4, 4).

    Args:
        text: `identity`, numbers, or the name of a file.

    Raises:
        DriveError: the text is neither, or the file cannot be read.
    """
    text = text.strip()
    if text.lower() == "identity":
        return np.eye(4)
    if is_numbers(text):
        return of_numbers(text, "--extrinsic")
    file = Path(text).expanduser()
    if not file.is_file():
        raise DriveError(f"--extrinsic {text!r}: no such file, and no numbers. Expected {FORMS}")
    lines = read_lines(file, f"the sensor's mount: {FORMS}")
    entries = dict(entry_of(line) for line in lines if ":" in line)
    if "tr" in entries:
        return of_numbers(entries["tr"], str(file), "Tr")
    if {"r", "t"} <= entries.keys():
        found = (
            np.concatenate(
                [numbers_of(entries["r"]).reshape(-1, 3), numbers_of(entries["t"]).reshape(-1, 1)],
                axis=1,
            )
            if counts(entries)
            else np.zeros(0)
        )
        return of_numbers(" ".join(map(repr, found.ravel().tolist())), str(file), "R and T")
    rest = " ".join(line for line in lines if not line.strip().startswith(("#", "%")))
    if data := re.search(r"data\s*:\s*\[([^\]]*)\]", rest):  # a matrix in OpenCV's or EuRoC's YAML
        rest = data[1]
    return of_numbers(rest, str(file))


def counts(entries: dict[str, str]) -> bool:
    """Return whether R has nine numbers and T three."""
    return len(numbers_of(entries["r"])) == 9 and len(numbers_of(entries["t"])) == 3


def entry_of(line: str) -> tuple[str, str]:
    """Split KEY: VALUES; the key in lower case."""
    key, _, values = line.partition(":")
    return key.strip().lower(), values


def is_numbers(text: str) -> bool:
    """Return whether a text holds only numbers, separators and a unit."""
    return bool(re.fullmatch(rf"(?:[\s,;\[\]]|{NUMBER}|deg|rad)+", text)) and bool(
        re.search(r"\d", text)
    )


def numbers_of(text: str) -> Float64:
    """Return the numbers of a text."""
    return np.array([float(word) for word in re.findall(NUMBER, text)])


def of_numbers(text: str, name: str, key: str = "") -> Float64:
    """Build a transform of 6, 7, 12 or 16 numbers.

    Raises:
        DriveError: another number of values, or they are no rigid transform.
    """
    where = f"{name}: {key}" if key else name
    if not is_numbers(text):
        raise DriveError(f"{where}: found {text.strip()[:60]!r}, expected {FORMS}")
    values = numbers_of(text)
    if len(values) not in (6, 7, 12, 16) or not np.isfinite(values).all():
        raise DriveError(f"{where}: {len(values)} numbers, expected {FORMS}")
    if len(values) == 7:
        check_quaternions(values[None, 3:], Path(name), np.array([1]))
        return np.asarray(of_quaternions(values[None, :3], values[None, 3:])[0])
    if len(values) == 6:
        unit = "deg" if re.search(r"\bdeg\b", text) else "rad"
        angles = values[3:] * UNITS[unit]
        if np.abs(angles).max() > 2 * np.pi + 1e-6:
            raise DriveError(
                f"{where}: found angles of up to {np.abs(values[3:]).max():g} rad, expected at "
                "most 6.28. Append deg if they are degrees"
            )
        return np.asarray(of_euler(values[None, :3], angles[None])[0])
    if len(values) == 16 and not np.allclose(values[12:], (0, 0, 0, 1), atol=1e-6):
        raise DriveError(f"{where}: the last row of the 4x4 matrix is not 0 0 0 1")
    transform = as_transforms(values[None, :12])
    check_rotations(transform, Path(name))
    return np.asarray(transform[0])


def describe_extrinsic(transform: Float64) -> str:
    """Return a mount as text: position, meters, and rotation, degrees."""
    x, y, z = transform[:3, 3]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # at a pitch of 90 degrees, yaw is taken as 0
        roll, pitch, yaw = Rotation.from_matrix(transform[:3, :3]).as_euler("xyz", degrees=True)
    return f"{x:.2f} {y:.2f} {z:.2f} m, {roll:.1f} {pitch:.1f} {yaw:.1f} deg (roll, pitch, yaw)"
