"""`placecell bench shape-bytes`: what further bytes a segment would add to its decoded shape."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.common_options import Model
from cli.labeled_drives import cached_labeled
from cli.outputs import output_folder
from cli.sources import clear_errors
from cli.tables import new_table, print_tables

if TYPE_CHECKING:
    from placecell.segmentation.recording import Recording

EXTRA_BYTES = 0, 8, 16


def shape_bytes(
    drives: Annotated[
        list[str],
        typer.Argument(
            metavar="DRIVE...",
            help="Drives or recordings that the decoders learn from, or town:SEED:SENSOR:PLACE.",
        ),
    ],
    measured: Annotated[
        list[str],
        typer.Option(
            "--measure", metavar="DRIVE", help="Drive that the decoders are measured on; repeat it."
        ),
    ],
    extra_bytes: Annotated[
        list[int] | None,
        typer.Option(
            min=0, max=64, help="Further bytes of a segment; repeat it. (default: 0, 8 and 16)"
        ),
    ] = None,
    scans: Annotated[int, typer.Option(min=30, help="Scans of each simulated drive.")] = 80,
    every: Annotated[
        int,
        typer.Option(min=1, help="Scans from one capture to the next in each simulated drive."),
    ] = 5,
    epochs: Annotated[int, typer.Option(min=1, help="Number of passes over the drives.")] = 6,
    entropy_weight: Annotated[
        float,
        typer.Option(min=0, help="Weight of the cross entropy beside the intersection over union."),
    ] = 0.5,
    seed: Drawn = 0,
    model: Model = None,
    cache: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER", callback=output_folder, help="Folder that keeps the simulated drives."
        ),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Measure how much better shapes would be with further bytes in a map.

    For each number of bytes, an encoder of the true grid and a decoder are trained together. The
    decoder also reads the stored code. Needs the extra 'train'.

        placecell bench shape-bytes town:11 --measure town:18 --extra-bytes 8
    """
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        from training.shapes.extra_bytes import ExtraStudy, study_extra_bytes
        from training.shapes.learning import ShapeRecipe

        folder = model_folder(model or DEFAULT_MODEL)
        learned_from, unseen = (
            [town_or_recorded(text, scans, every, cache) for text in texts]
            for texts in (drives, measured)
        )
        recipe = ShapeRecipe(epochs=epochs, entropy_weight=entropy_weight)
        study = ExtraStudy(folder, extra_bytes or EXTRA_BYTES, recipe, seed)
        report: dict[str, Any] = {}
        for report in study_extra_bytes(learned_from, unseen, study):
            write_json(report, json_file)
    print_report(report)


def town_or_recorded(text: str, scans: int, every: int, cache: Path | None) -> "Recording":
    """Load a drive; the options apply to simulated drives only."""
    made = (every, scans, cache) if text.startswith("town:") else (None, None, None)
    return cached_labeled(text, *made)[0]


def print_report(report: dict[str, Any]) -> None:
    """Print the figures."""
    table = new_table("drive", "further bytes", "IoU", "chamfer")
    for drive, figures in report["baseline"].items():
        cells = (f"{figures['baseline_iou']:.3f}", f"{figures['baseline_chamfer_m']:.2f} m")
        table.add_row(drive, "baseline", *cells)
        for row in report["rows"]:
            found = row["drives"][drive]
            cells = (f"{found['iou']:.3f}", f"{found['chamfer_m']:.2f} m")
            table.add_row(drive, str(row["extra_bytes"]), *cells)
    print_tables(table)
