"""`placecell prepare`: the segments of drives, written once for training and evaluation."""

from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors, load


def prepare(
    drives: Annotated[
        list[Path], typer.Argument(help="Folders in the KITTI odometry or raw layout.")
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for NAME.safetensors.")
    ] = Path("data"),
    every: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="A frame every so many scans. (default: 2; 1 on drives of fewer than 100 scans)",
        ),
    ] = None,
) -> None:
    """Cut drives into segments and groups, and write each as a recording."""
    with clear_errors():
        for folder in drives:
            recording = load(folder, every)
            file = output / f"{recording.name}.safetensors"
            recording.save(file)
            typer.echo(
                f"{file}: {len(recording.segments):,} segments, "
                f"{int(recording.distinct.sum()):,} without duplicates, "
                f"{int(recording.groups.max(initial=-1)) + 1:,} groups"
            )
