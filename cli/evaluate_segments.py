"""`placecell evaluate-segments`: measures what stored segments say: class and shape."""

from typing import Annotated, Any

import typer

from cli.common_options import Every, Model
from cli.labeled_drives import load_labeled
from cli.sources import TOWN_HELP, clear_errors
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

TRAINING, TRAINING_SCANS = "town:11", 150
"""Training drive of the baseline, which all shipped decoders were trained on, and its scans."""


def evaluate_segments(
    drive: Annotated[
        str,
        typer.Argument(
            metavar="DRIVE",
            help="Drive (a bag, an MCAP file, a folder of scans, or a folder in the KITTI, MulRan "
            "or HeLiPR layout) or recording file from 'placecell prepare'. Labels in SemanticKITTI "
            "files are read from labels/ beside velodyne/."
            + TOWN_HELP
            + " +other-cars behind it is the "
            "same drive on another day, when all parked cars changed.",
        ),
    ],
    model: Model = None,
    every: Every = None,
    segmentation: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Segmentation protocol: v1; sparse, for few points in a local map; or auto: "
            "sparse if a capture has fewer than 30 segments by v1 (median).",
        ),
    ] = "auto",
    scans: Annotated[
        int | None,
        typer.Option(min=1, help="Scans of a simulated drive (town:SEED). (default: 300)"),
    ] = None,
    training: Annotated[
        str,
        typer.Option(
            metavar="DRIVE",
            help="Drive or recording that the model was trained on, for the baseline of the "
            "shapes; none: no baseline.",
        ),
    ] = TRAINING,
    json_file: JsonFile = None,
) -> None:
    """Measure what the stored form of a drive's segments tells: their shapes and classes.

    The shapes are decoded from the codes and the boxes, and compared with the segments. The
    baseline is the mean shape of the nearest training codes. Simulated drives have labels, and so
    have the drives of SemanticKITTI. Without labels, the figures of the classes are null.

        placecell evaluate-segments town:901:os1-64 --json segments.json

    docs/results/segments.md defines the figures.
    """
    from evaluation.segments.evaluate import evaluate_recording
    from placecell.descriptors.manifest import SHAPE_FILE
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        folder = model_folder(model or DEFAULT_MODEL)
        recording, labels = load_labeled(drive, every, segmentation, scans)
        baseline = None
        if training != "none" and (folder / SHAPE_FILE).exists():
            known = TRAINING_SCANS if training.startswith("town:") else None
            baseline, _ = load_labeled(training, every, segmentation, known)
        report = evaluate_recording(recording, labels, folder, baseline)
        write_json(report, json_file)
    print_report(report)
    if labels is not None and not report["labeled"]:
        typer.echo(
            "placecell: the drive has labels, but none of a known class, so the figures of the "
            "classes are missing. Expected the numbers of SemanticKITTI, such as 10 for a car.",
            err=True,
        )


def print_report(report: dict[str, Any]) -> None:
    """Print the figures as tables."""
    summary = new_table("figure", "value", title=f"Segments of {report['drive']}")
    for name in ("segments", "captures", "labeled"):
        summary.add_row(name, "-" if report[name] is None else f"{report[name]:,}")
    for name in ("accuracy", "macro_f1", "calibration_error"):
        summary.add_row(name, percent(report[name]))
    for name in ("iou", "baseline_iou", "iou_without_extents"):
        summary.add_row(name, percent(report[name]))
    for name in ("chamfer_m", "baseline_chamfer_m"):
        summary.add_row(name, "-" if report[name] is None else f"{report[name]:.3f}")
    classes = new_table("class", "segments", "precision", "recall", "F1")
    for name, row in (report["per_class"] or {}).items():
        shares = (percent(row[key]) for key in ("precision", "recall", "f1"))
        classes.add_row(name, f"{row['segments']:,}", *shares)
    print_tables(summary, *([classes] if report["per_class"] else []))
