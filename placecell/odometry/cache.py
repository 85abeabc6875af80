"""Cache of odometry: trajectories in KITTI's format, by the scans and settings they come from."""

import hashlib
import json
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from placecell.core.files import written_whole
from placecell.core.types import Float64
from placecell.sources.errors import DriveError
from placecell.trajectories.reading import read_trajectory

FOLDER_VARIABLE = "PLACECELL_CACHE"
"""Environment variable with the folder of the cache."""


@dataclass(frozen=True, slots=True)
class CachedOdometry:
    """Result of an odometry.

    Attributes:
        poses: sensor poses in the frame of the first scan, float64 (scans, 4, 4).
        drift_percent: estimated drift, percent of the path; None if the sensor hardly moves.
    """

    poses: Float64
    drift_percent: float | None


def cache_folder() -> Path:
    """Return the folder of the cache: that of PLACECELL_CACHE, else the user's cache folder."""
    given = os.environ.get(FOLDER_VARIABLE)
    if given:
        return Path(given) / "odometry"
    user = os.environ.get("XDG_CACHE_HOME")
    return (Path(user) if user else Path.home() / ".cache") / "placecell" / "odometry"


def cache_file(title: str, parts: Sequence[object]) -> Path:
    """Return the file of an odometry.

    Args:
        title: name of the drive.
        parts: everything that the result depends on.
    """
    digest = hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:16]
    return cache_folder() / f"{re.sub(r'[^A-Za-z0-9._-]', '_', title)[:80]}-{digest}.txt"


def load(file: Path, scans: int) -> CachedOdometry | None:
    """Read an odometry; None if there is none for this number of scans."""
    try:
        with file.open(encoding="utf-8") as opened:
            header = json.loads(opened.readline().lstrip("# "))
        poses = read_trajectory(file).poses
        drift = header["drift_percent"]
    except (OSError, ValueError, KeyError, TypeError, DriveError):
        return None
    return CachedOdometry(poses, drift) if len(poses) == scans else None


def save(file: Path, odometry: CachedOdometry) -> bool:
    """Write an odometry as a whole or not at all; return whether it could be written."""
    rows = odometry.poses[:, :3].reshape(-1, 12)
    lines = [" ".join(repr(float(value)) for value in row) for row in rows]
    header = json.dumps({"drift_percent": odometry.drift_percent, "scans": len(rows)})
    try:
        with written_whole(file) as unfinished:
            unfinished.write_text(f"# {header}\n" + "\n".join(lines) + "\n", encoding="utf-8")
    except OSError:
        return False
    return True
