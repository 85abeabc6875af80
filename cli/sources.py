"""What the commands take as input: drives and prepared recordings, in part or whole."""

import re
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import typer
from rich.progress import track

if TYPE_CHECKING:
    from segments.recording import Recording
    from training.training_set import Source

SOURCE_HELP = (
    "A drive's folder (KITTI odometry or raw layout) or a recording made by 'placecell prepare'; "
    "with @FIRST:LAST only the groups wholly within these scans, both included."
)

TOWN_HELP = " town:SEED is a drive through the synthetic town of that seed."

TOWN_SCANS = 300
"""Of each robot's drive through a town that is trained on."""


def fail(message: object) -> NoReturn:
    """End the command with a message and status 1."""
    typer.secho(f"placecell: {message}", err=True, fg=typer.colors.RED)
    raise typer.Exit(1)


@contextmanager
def clear_errors() -> Iterator[None]:
    """Show errors that tell the user what to do as a line, not as a stack trace."""
    try:
        yield
    except ModuleNotFoundError as error:
        fail(f"needs {error.name}, which is not installed: make install")
    except (ValueError, OSError) as error:
        fail(error)


def show(items: Iterable[int], total: int, what: str) -> Iterable[int]:
    """Loop with a progress bar on the terminal."""
    return track(items, description=what, total=total)


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
    from segments.drives import open_drive
    from segments.extraction import record
    from segments.parameters import PROTOCOL_V1
    from segments.recording import Recording

    if path.is_file():
        recording = Recording.load(path)
        step = recording.parameters.frame_step
        if every is not None and every != step:
            raise ValueError(
                f"{path}: prepared with --every {step}, not {every}; prepare the drive again"
            )
        return recording
    drive = open_drive(path)
    return record(drive, PROTOCOL_V1.for_drive(len(drive), every), progress=show)


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
    from training.training_set import Source

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
    from training.training_set import Source

    path, scans = split_source(text)
    recording = load(path)
    return Source(recording, *(scans or (0, recording.scans - 1)))
