"""Scans among the files of a folder."""

from collections.abc import Callable, Iterator
from pathlib import Path

from placecell.core.files import natural_key
from placecell.sources.clouds.formats import (
    FORMATS,
    SUFFIXES,
    TEXT,
    CloudFormat,
    format_of,
    read_head,
)
from placecell.sources.clouds.text import holds_points
from placecell.sources.errors import DriveError

USUAL_FOLDERS = (
    "velodyne", "velodyne_points/data", "lidar", "scans", "pcd", "pcds", "clouds", "pointclouds",
    "points", "ply", "las", "data",
)  # fmt: skip
"""Folders of scans inside a folder, in the order in which they are tried."""
BESIDE = (
    "label", "calib", "pose", "time", "stamp", "traj", "groundtruth", "ground_truth", "odom", "imu",
    "gps", "gnss", "readme", "license", "intrinsic", "extrinsic", "semantic", "instance",
)  # fmt: skip
"""Parts of the names of files that stand beside scans."""
JUDGED = 20
"""Most text files of a folder whose content is looked at."""


def find_clouds(path: Path, remark: Callable[[str], None]) -> tuple[list[Path], CloudFormat]:
    """Return the scans of a path, in the order of the numbers in their names.

    Args:
        remark: receives what was left out.

    Raises:
        DriveError: no scans, or formats that are mixed.
    """
    if path.is_file():
        found = format_of(path)
        if found is None:
            raise DriveError(
                f"{path}: is no point cloud; expected one of "
                f"{', '.join(each.name for each in FORMATS)}"
            )
        return [path], found
    folder = folder_of_scans(path)
    if folder is None:
        raise DriveError(
            f"{path}: holds no point clouds; expected files such as {', '.join(sorted(SUFFIXES))}"
        )
    if folder != path:
        remark(f"the scans are in {folder.relative_to(path)}")
    groups = groups_of(folder)
    kinds = sorted(groups, key=lambda kind: -len(groups[kind]))
    files = groups[kinds[0]]
    others = {kind: len(groups[kind]) for kind in kinds[1:]}
    told = ", ".join(f"{count} {kind}" for kind, count in others.items())
    if others and 2 * max(others.values()) > len(files):
        raise DriveError(
            f"{folder}: holds {len(files)} {kinds[0]} files and {told}; the scans cannot be told "
            "apart. Move the files of one format to a folder of their own"
        )
    if others:
        remark(f"of {folder.name}, only the {len(files)} {kinds[0]} files are read, not {told}")
    numbered = [file for file in files if any(sign.isdecimal() for sign in file.stem)]
    if len(files) > len(numbered) > len(files) / 2:
        left = sorted(file.name for file in set(files) - set(numbered))
        remark(f"files without a number in their names are left out: {', '.join(left[:5])}")
        files = numbered
    return sorted(files, key=natural_key), SUFFIXES[files[0].suffix.lower()]


def folder_of_scans(path: Path) -> Path | None:
    """Return the folder that holds the scans: the path, or a folder inside it; None if none does.

    Raises:
        DriveError: several folders hold scans.
    """
    if groups_of(path):
        return path
    for name in USUAL_FOLDERS:
        if (path / name).is_dir() and groups_of(path / name):
            return path / name
    folders = [each for each in visible(path) if each.is_dir() and groups_of(each)]
    if len(folders) > 1:
        names = ", ".join(sorted(each.name for each in folders)[:10])
        raise DriveError(
            f"{path}: several folders hold point clouds: {names}. Give the folder of one sensor"
        )
    return folders[0] if folders else None


def visible(folder: Path) -> Iterator[Path]:
    """Yield the entries of a folder, without hidden ones and those of macOS archives."""
    try:
        for each in folder.iterdir():
            if not each.name.startswith((".", "__MACOSX")):
                yield each
    except OSError:
        return


def groups_of(folder: Path) -> dict[str, list[Path]]:
    """Return the point clouds of a folder by format; text files by their suffix."""
    groups: dict[str, list[Path]] = {}
    for file in visible(folder):
        suffix = file.suffix.lower()
        if suffix not in SUFFIXES or any(word in file.stem.lower() for word in BESIDE):
            continue
        if not file.is_file():
            continue
        kind = SUFFIXES[suffix]
        name = f"text ({suffix})" if kind is TEXT else kind.name
        groups.setdefault(name, []).append(file)
    for name in [name for name in groups if name.startswith("text")]:
        some = sorted(groups[name], key=natural_key)
        judged = some[:: max(1, len(some) // JUDGED)][:JUDGED]
        wrong = {file for file in judged if not holds_points(read_head(file), file)}
        groups[name] = [file for file in some if file not in wrong]
        if not groups[name] or 2 * len(wrong) > len(judged):
            del groups[name]
    return groups
