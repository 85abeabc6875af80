"""`placecell prepare`: segments drives and stores the result for training and evaluation."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.common_options import Every, Segmentation
from cli.outputs import output_folder
from cli.sources import clear_errors, load, protocol_named
from cli.tables import JsonFile, write_json


def prepare(
    drives: Annotated[
        list[Path],
        typer.Argument(
            help="Drives: bags, MCAP files, folders of scans, or folders in the KITTI, MulRan or "
            "HeLiPR layout."
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the recordings, NAME.safetensors each.",
        ),
    ] = Path("data"),
    every: Every = None,
    segmentation: Segmentation = "v1",
    json_file: JsonFile = None,
) -> None:
    """Segment drives, group the segments over time, and write one recording per drive."""
    rows: list[dict[str, Any]] = []
    with clear_errors():
        protocol = protocol_named(segmentation)
        for folder in drives:
            recording = load(folder, every, protocol)
            file = output / f"{recording.name}.safetensors"
            recording.save(file)
            row: dict[str, Any] = {
                "file": str(file),
                "drive": recording.name,
                "protocol": recording.parameters.protocol,
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
                f"in {row['groups']:,} groups"
            )
        write_json({"recordings": rows}, json_file)
