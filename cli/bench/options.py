"""Options that several benchmarks share: source of the segments, output folder, seed."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.outputs import output_folder
from cli.sources import load, show
from cli.tables import JsonFile, write_json

if TYPE_CHECKING:
    from placecell.core.segments import Segments
    from placecell.segmentation.recording import Recording

__all__ = ["Drawn", "JsonFile", "Kept", "Seed", "Source", "write_json"]

Source = Annotated[
    Path | None,
    typer.Option(
        "--segments",
        metavar="PATH",
        help="Drive or recording file from 'placecell prepare' with the segments. "
        "(default: a short drive through the synthetic town)",
    ),
]
Kept = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        callback=output_folder,
        help="Folder that caches the town's drive and the paper's network.",
    ),
]
Seed = Annotated[int, typer.Option(help="Random seed of the town and of all random choices.")]
Drawn = Annotated[int, typer.Option("--seed", help="Random seed of all random choices.")]


def recording_from(segments: Path | None, output: Path, seed: int, scans: int = 20) -> "Recording":
    """Return the recording of a drive; by default simulate a drive through the town."""
    from benchmarks.scans import town_recording

    if segments is None:
        return town_recording(output / "town", seed, show, scans)
    return load(segments)


def scans_from(segments: Path | None, output: Path, seed: int) -> "tuple[list[Segments], str]":
    """Return the segments of each scan and the name of their source."""
    from benchmarks.scans import scans_in

    recording = recording_from(segments, output, seed)
    return scans_in(recording), "synthetic town" if segments is None else segments.stem
