"""`placecell prepare`: the segments of drives, written once for training and evaluation."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.sources import clear_errors, load
from cli.tables import JsonFile, write_json


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
    json_file: JsonFile = None,
) -> None:
    """Cut drives into segments and groups, and write each as a recording."""
    rows: list[dict[str, Any]] = []
    with clear_errors():
        for folder in drives:
            recording = load(folder, every)
            file = output / f"{recording.name}.safetensors"
            recording.save(file)
            row: dict[str, Any] = {
                "file": str(file),
                "drive": recording.name,
                "scans": recording.scans,
                "skipped_scans": len(recording.skipped_scans),
                "dropped_points": recording.dropped_points,
                "segments": len(recording.segments),
                "distinct": int(recording.distinct.sum()),
                "groups": int(recording.groups.max(initial=-1)) + 1,
            }
            rows.append(row)
            typer.echo(
                f"{file}: {row['segments']:,} segments, {row['distinct']:,} without duplicates, "
                f"{row['groups']:,} groups"
            )
        write_json({"recordings": rows}, json_file)
