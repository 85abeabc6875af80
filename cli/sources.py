"""What the commands take as input: drives and prepared recordings, in part or whole."""

import re
import tempfile
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rich.progress import track

from cli.errors import clear_errors, fail
from cli.tables import progress_console

if TYPE_CHECKING:
    from collections.abc import Sequence

    from placecell.datasets import Drive
    from placecell.segmentation.recording import Recording
    from training.data.training_set import Source

__all__ = ["clear_errors", "fail", "load", "show", "source", "sources"]

SOURCE_HELP = (
    "A drive's folder (KITTI odometry or raw layout) or a recording made by 'placecell prepare'; "
    "with @FIRST:LAST only the groups wholly within these scans, both included."
)

TOWN_HELP = " town:SEED is a drive through the synthetic town of that seed."

TOWN_SCANS = 300
"""Of each robot's drive through a town that is trained on."""


def show(items: Iterable[int], total: int, what: str) -> Iterable[int]:
    """Loop with a progress bar on the terminal."""
    return track(items, description=what, total=total, console=progress_console())


def parse_scans(text: str) -> tuple[int, int]:
    """FIRST:LAST, both included.

    Raises:
        ValueError: not two numbers in order.
    """
    match = re.fullmatch(r"(\d+):(\d+)", text)
    if not match or int(match[1]) > int(match[2]):
        raise ValueError(f"scans must be FIRST:LAST, such as 300:500, not {text!r}")
    return int(match[1]), int(match[2])


def load(path: Path, every: int | None = None) -> "Recording":
    """A prepared recording, or the segments of a drive's folder made now."""
    from placecell.core.parameters import PROTOCOL_V1
    from placecell.datasets import open_drive
    from placecell.segmentation.pipeline import record
    from placecell.segmentation.recording import Recording

    if path.is_file():
        recording = Recording.load(path)
        step = recording.parameters.frame_step
        if every is not None and every != step:
            raise ValueError(
                f"{path}: prepared with --every {step}, not {every}; prepare the drive again"
            )
        return recording
    drive = open_drive(path)
    recording = record(drive, PROTOCOL_V1.for_drive(len(drive), every), progress=show)
    refuse_nothing(drive, [recording])
    return recording


def refuse_nothing(drive: "Drive", recordings: "Sequence[Recording]") -> None:
    """Refuse a drive that gave no segments; the error describes its scans.

    Raises:
        ValueError: none of the recordings holds a segment.
    """
    import numpy as np

    if any(len(recording.segments) for recording in recordings):
        return
    some = np.unique(np.linspace(0, len(drive) - 1, 8).astype(int))
    scans = [scan for scan in (drive.scan(int(index)) for index in some) if len(scan)]
    ranges = np.concatenate([np.linalg.norm(scan, axis=1) for scan in scans] or [np.zeros(1)])
    raise ValueError(
        f"{drive.folder}: no segments were found in {len(drive)} scans of "
        f"{np.mean([len(scan) for scan in scans] or [0]):,.0f} points (median range "
        f"{np.median(ranges):.1f} m), read as {drive.point_layout}. Segments are objects of 100 "
        "points or more that stand on the ground, within 60 m of the sensor. Check that z is up, "
        "the unit (--unit), the columns (--columns), and that the poses are the sensor's"
    )


def split_source(text: str) -> tuple[Path, tuple[int, int] | None]:
    """PATH or PATH@FIRST:LAST."""
    path, at, scans = text.rpartition("@")
    if at and re.fullmatch(r"\d+:\d+", scans):
        return Path(path), parse_scans(scans)
    return Path(text), None


def sources(texts: Iterable[str]) -> "list[Source]":
    """Drives or parts of them, and towns: `town:SEED` stands for robot A's drive through it.

    Robot B sees the same houses; as a drive of its own it would teach that they are others.
    """
    from training.data.training_set import Source

    found = []
    for text in texts:
        if match := re.fullmatch(r"town:(\d+)", text):
            recording, _ = town_recordings(int(match[1]), TOWN_SCANS)
            found.append(Source(replace(recording, name=text), 0, recording.scans - 1))
        else:
            found.append(source(text))
    return found


def town_recordings(seed: int, scans: int) -> "list[Recording]":
    """The segments that two robots see on their drives through a synthetic town."""
    from town import two_robots

    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        drives = two_robots(Path(folder), seed=seed, scans=scans, progress=show)
        return [load(drive) for drive in drives]


def source(text: str) -> "Source":
    """A drive or a part of it."""
    from training.data.training_set import Source

    path, scans = split_source(text)
    recording = load(path)
    return Source(recording, *(scans or (0, recording.scans - 1)))
