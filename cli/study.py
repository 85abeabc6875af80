"""`placecell study`: measures what recognition depends on and what limits it."""

import json
from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import Models
from cli.outputs import output_folder
from cli.sources import SOURCE_HELP, clear_errors, source
from cli.tables import JsonFile, progress_console, write_json


def study(
    drive: Annotated[str, typer.Argument(help=SOURCE_HELP, metavar="DRIVE[@FIRST:LAST]")],
    model: Models = None,
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", callback=output_folder, help="Folder for study.json and study.png."
        ),
    ] = Path("out/study"),
    json_file: JsonFile = None,
) -> None:
    """Measure recognition by size, viewpoint, occlusion, density and storage; classify the misses.

    The command writes the curves of each model as JSON and as a plot.
    """
    from rich.progress import track

    with clear_errors():
        from evaluation.machine import machine
        from evaluation.plots import studies
        from evaluation.recognition.evaluate import open_models
        from evaluation.recognition.study import study as study_of
        from placecell.core.parameters import NEIGHBORHOOD_V1
        from training.data.training_set import TrainingSet

        output.mkdir(parents=True, exist_ok=True)
        models = open_models(model or ())
        part = source(drive)
        test = TrainingSet.of([part], NEIGHBORHOOD_V1)
        curves = {
            name: {"model_id": extractor.manifest.model_id} | study_of(extractor, test)
            for name, (extractor, _) in track(
                models.items(), description="studying", console=progress_console()
            )
        }
    report = {
        "drive": part.recording.name,
        "scans": [part.first, part.last],
        "segments": len(test),
        "protocol": test.parameters.protocol,
        "machine": machine(),
        "models": curves,
    }
    (output / "study.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    write_json(report, json_file)
    studies(curves, output / "study.png")
    for name, curve in curves.items():
        shown = ", ".join(f"{what} {share:.1%}" for what, share in curve["misses"].items())
        typer.echo(f"Misses of {name}: {shown}")
    typer.echo(f"The curves are in {output / 'study.png'}.")
