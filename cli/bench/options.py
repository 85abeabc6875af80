"""What the benches share: where segments come from, where figures go."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

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
        help="A drive's folder or a recording of 'placecell prepare' to take segments from. "
        "(default: a short drive through the synthetic town)",
    ),
]
Kept = Annotated[
    Path,
    typer.Option(
        "--output", "-o", help="Folder that keeps the town's drive and the paper's network."
    ),
]
Seed = Annotated[int, typer.Option(help="Of the town, and of everything that is drawn.")]
Drawn = Annotated[int, typer.Option("--seed", help="Of everything that is drawn.")]


def recording_from(segments: Path | None, output: Path, seed: int, scans: int = 20) -> "Recording":
    """The recording of a drive, or of a drive of so many scans through the town."""
    from benchmarks.scans import town_recording

    if segments is None:
        return town_recording(output / "town", seed, show, scans)
    return load(segments)


def scans_from(segments: Path | None, output: Path, seed: int) -> "tuple[list[Segments], str]":
    """The segments of each scan, and where they are from."""
    from benchmarks.scans import scans_in

    recording = recording_from(segments, output, seed)
    return scans_in(recording), "synthetic town" if segments is None else segments.stem
