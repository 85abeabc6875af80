"""Options and arguments that several commands share: drive, captures, models."""

from pathlib import Path
from typing import Annotated

import typer

from cli.outputs import output_folder
from cli.sources import ROBOT_B_HELP, SOURCE_HELP, TOWN_HELP

Drive = Annotated[
    Path,
    typer.Argument(
        help="Drive: a bag, an MCAP file, a folder of scans, or a folder in a known layout; or a "
        "recording file from 'placecell prepare'."
    ),
]
Every = Annotated[
    int | None,
    typer.Option(
        min=1, help="Scans per capture. (default: 2; 1 for drives of fewer than 100 scans)"
    ),
]
Segmentation = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="Segmentation protocol: v1, or sparse for few points in a local map (16 beams and few "
        "scans, or a narrow view).",
    ),
]
Model = Annotated[
    str | None,
    typer.Option(help="Model name or folder. (default: the service's default model)"),
]
Models = Annotated[
    list[str] | None,
    typer.Option("--model", help="Model name or folder; repeatable. (default: all shipped models)"),
]
TrainingDrives = Annotated[
    list[str],
    typer.Argument(help=SOURCE_HELP + TOWN_HELP + ROBOT_B_HELP, metavar="DRIVE[@FIRST:LAST]..."),
]
Classes = Annotated[
    list[str] | None,
    typer.Option(
        "--classes",
        metavar="CLASS",
        help="Class of segments to keep, such as building or pole; repeatable. (default: all "
        "segments)",
    ),
]
Ignore = Annotated[
    list[str] | None,
    typer.Option(
        "--ignore",
        metavar="CLASS",
        help="Class of segments to leave out, or movable for vehicles and persons; repeatable. "
        "(default: none)",
    ),
]
Runs = Annotated[
    Path,
    typer.Option(callback=output_folder, help="Folder for checkpoints and training histories."),
]
Resume = Annotated[
    bool, typer.Option("--resume", help="Continue from the last checkpoint of this run.")
]
License = Annotated[
    str, typer.Option("--license", help="License of the drives, written into the model card.")
]
