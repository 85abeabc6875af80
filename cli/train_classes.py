"""`placecell train-classes`: trains the head that tells a segment's class, for one model."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.labeled_drives import cached_labeled
from cli.outputs import output_folder
from cli.sources import TOWN_HELP, clear_errors

if TYPE_CHECKING:
    from training.classes.examples import LabeledDrive

SCANS, EVERY = 80, 5
"""Number of scans of a simulated drive, and scans from one capture to the next."""


def train_classes(
    model: Annotated[str, typer.Argument(help="Model that gets the head: name or folder.")],
    drives: Annotated[
        list[str],
        typer.Argument(
            metavar="DRIVE...",
            help="Drives with labels: folders in the KITTI layout with SemanticKITTI's labels/, or "
            "simulated drives." + TOWN_HELP,
        ),
    ],
    unlabeled: Annotated[
        list[str] | None,
        typer.Option(
            "--unlabeled",
            metavar="DRIVE",
            help="Drive or recording without labels, for self-training; repeatable. "
            "(default: none)",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Random seed of copies, batches and weights.")] = 0,
    cache: Annotated[
        Path | None,
        typer.Option(
            callback=output_folder,
            help="Folder that keeps the segmented drives for the next call. (default: none)",
        ),
    ] = None,
    license_name: Annotated[
        str, typer.Option("--license", help="License of the drives, written into the manifest.")
    ] = "not stated",
) -> None:
    """Train the head that tells the class of a segment, and add it to a model's folder.

    The network stays as it is, so neither the descriptors nor the model's id change. Simulated
    drives have 80 scans, of which every fifth is a capture.

        placecell train-classes context-town town:800 town:801:vlp-16 --seed 0
    """
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import model_folder

    with clear_errors():
        from training.classes.examples import examples_of
        from training.classes.learning import learn
        from training.classes.publishing import publish_head

        folder = model_folder(model)
        extractor = load_extractor(folder)
        labeled = [loaded(text, cache, labeled=True) for text in drives]
        others = [loaded(text, cache, labeled=False) for text in unlabeled or []]
        examples = examples_of(labeled, extractor, seed)
        more = examples_of(others, extractor, seed + 1) if others else None
        trained = learn(examples, more, seed, tell=typer.echo)
        facts = {
            "seed": seed,
            "licence": license_name,
            "command": retraining(folder.name, drives, unlabeled or [], seed),
        }
        manifest = publish_head(folder, trained, [*labeled, *others], facts)
    typer.echo(f"Model {manifest.model_id} has classes: {manifest.classes['held_out']}.")


def retraining(model: str, drives: list[str], unlabeled: list[str], seed: int) -> str:
    """Return the command that trains a head again, with the names of drives without folders."""
    named = [text if text.startswith("town:") else f"data/{Path(text).name}" for text in drives]
    others = [f"--unlabeled data/{Path(text).name}" for text in unlabeled]
    return " ".join(["placecell train-classes", model, *named, *others, f"--seed {seed}"])


def loaded(text: str, cache: Path | None, *, labeled: bool) -> "LabeledDrive":
    """Load a drive of the training.

    Raises:
        ValueError: A drive that needs labels has none.
    """
    from training.classes.examples import LabeledDrive

    is_town = text.startswith("town:")
    recording, classes = cached_labeled(
        text, EVERY if is_town else None, SCANS if is_town else None, cache
    )
    if not labeled:
        return LabeledDrive(recording)
    if classes is None:
        raise ValueError(
            f"{text} has no labels: expected labels/NNNNNN.label beside velodyne/. Give it with "
            "--unlabeled."
        )
    return LabeledDrive(recording, classes)
