"""`placecell train-shapes`: trains the decoder from stored codes to shapes, for one model."""

from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import License, Resume, Runs, TrainingDrives
from cli.sources import clear_errors, each_source, show
from cli.tables import progress_console


def train_shapes(
    model: Annotated[str, typer.Argument(help="Model whose codes are decoded: name or folder.")],
    drives: TrainingDrives,
    seed: Annotated[int, typer.Option(help="Random seed of the training.")] = 0,
    epochs: Annotated[int, typer.Option(min=1, help="Number of passes over the training set.")] = 3,
    runs: Runs = Path("runs"),
    resume: Resume = False,
    license_name: License = "not stated",
) -> None:
    """Train the decoder that turns stored codes into shapes, and add it to a model's folder.

    Use the drives that the model was trained on. The descriptors and the model's id do not change.

        placecell train-shapes context-town town:11 town:12 --seed 0
    """
    from rich.progress import Progress

    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import model_folder

    folder = model_folder(model)
    with clear_errors():
        from training.methods.run import Run
        from training.shapes.data import shape_data
        from training.shapes.publishing import Facts, identity_of, train_and_publish

        extractor = load_extractor(folder)
        loaded = each_source(drives)
        numbers = show(range(len(drives)), len(drives), "Describing segments")
        data, parts = shape_data((next(loaded) for _ in numbers), extractor, seed)
        facts = Facts(parts, license_name, seed, epochs)
        checkpoints = runs / f"shapes-{extractor.manifest.name}-{seed}"
        if not resume:
            (checkpoints / "checkpoint.pt").unlink(missing_ok=True)
        with Progress(console=progress_console()) as progress:
            run = Run(checkpoints, seed, identity_of(extractor.manifest, facts), progress)
            manifest = train_and_publish(folder, extractor.manifest, data, run, facts)
    overlap = manifest.shape["validation_iou"]
    typer.echo(f"The shape decoder of {manifest.model_id} is in {folder} (IoU {overlap:.3f}).")
