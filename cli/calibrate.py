"""`placecell calibrate`: calibrates match probabilities by unlabeled drives or maps."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.common_options import Every, Model
from cli.outputs import output_file
from cli.sources import clear_errors, load
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

if TYPE_CHECKING:
    from evaluation.recognition.calibrate import CalibratedSite
    from placecell.descriptors.extractor import Extractor
    from placecell.descriptors.pair_classifier import PairClassifier
    from placecell.segmentation.recording import Recording


def calibrate(
    map_drives: Annotated[
        list[Path],
        typer.Argument(help="Drives, recordings of 'placecell prepare', or map files."),
    ],
    model: Model = None,
    every: Every = None,
    fit: Annotated[
        bool,
        typer.Option(
            "--fit",
            help="Fit the constants of the model by the groups of these drives, each of which "
            "counts the same, and write them into the model's manifest.",
        ),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            callback=output_file,
            help="JSON file for the constants. As calibration.json in the model's folder, it "
            "replaces the constants of the manifest. (default: none)",
        ),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Calibrate match probabilities by the segments of drives or maps, without labels.

    The service does the same with each map as it fills. Maps that are too small for it use the
    constants of the model. This command computes such constants from drives of your own sensors:

        placecell calibrate site-a site-b -o models/context/calibration.json

    The groups of a drive, which are labels, only check the result.
    """
    from evaluation.recognition.calibrate import report
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.pair_classifier import load_pair_classifier
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        folder = model_folder(model or DEFAULT_MODEL)
        extractor = load_extractor(folder)
        classifier = load_pair_classifier(folder, extractor.manifest)
        if fit:
            fit_constants([load(drive, every) for drive in map_drives], extractor, folder)
            return
        sites = [site_of(path, every, extractor, classifier) for path in map_drives]
        content = report(sites, extractor)
        if output:
            output.parent.mkdir(parents=True, exist_ok=True)
            output.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        write_json(content, json_file)
    print_sites(sites)


def site_of(
    path: Path, every: int | None, extractor: "Extractor", classifier: "PairClassifier | None"
) -> "CalibratedSite":
    """Load and calibrate a drive, a recording or a map file."""
    from placecell_client import MapFileError, decode

    from evaluation.recognition.calibrate import calibrate_map, calibrate_recording
    from placecell.segmentation.recording import is_recording

    if is_recording(path):  # map files have the same carrier format
        try:
            content = decode(path.read_bytes())
        except MapFileError:
            pass  # a recording, or no file of ours, which `load` tells
        else:
            return calibrate_map(path.stem, content, extractor)
    return calibrate_recording(load(path, every), extractor, classifier)


def fit_constants(recordings: "list[Recording]", extractor: "Extractor", folder: Path) -> None:
    """Fit the constants of a model by labeled drives, and save its manifest.

    Raises:
        ValueError: no drive has pairs of both kinds, or the model's pair classifier is no distance.
    """
    from evaluation.recognition.calibrate import describe
    from training.export.site_constants import LabeledSite, fit_site_constants, with_constants

    sites = [LabeledSite.of_recording(each, describe(each, extractor)) for each in recordings]
    fitted = fit_site_constants(sites, extractor.manifest.quantizer)
    if fitted is None:
        raise ValueError("The drives have no groups of several segments. Give longer drives")
    constants, _ = fitted
    with_constants(folder, constants).save(folder)
    typer.echo(f"{folder}: {constants}, fitted on {len(sites)} drives")


def print_sites(sites: "list[CalibratedSite]") -> None:
    """Print the calibrations as a table."""
    table = new_table()
    for name in ("", "state", "segments", "positives", "shift", "scale"):
        table.add_column(name, justify="left" if name in {"", "state"} else "right")
    for name in ("accuracy before", "after", "error before", "after"):
        table.add_column(name, justify="right")
    for site in sites:
        told = site.calibration
        before, after = (site.reliability.get(when, {}) for when in ("before", "after"))
        table.add_row(
            site.name,
            told.state,
            f"{told.segments:,}",
            str(told.positives),
            f"{told.shift:.2f}",
            f"{told.scale:.2f}",
            *(
                percent(each.get(figure))
                for figure in ("pair_accuracy", "expected_calibration_error")
                for each in (before, after)
            ),
        )
    print_tables(table)
