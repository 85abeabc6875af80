"""Model card: data, figures and limits of a model, written from its manifest."""

import textwrap
from pathlib import Path

from placecell.descriptors.manifest import Manifest

CARD = """# Model `{name}`

{what}

| | |
|---|---|
| id | `{model_id}` |
| method | {method} |
| network | {network} |
| descriptor | {dimension} dimensions, {code_bytes} bytes as stored |
| trained | in {seconds:.0f} s on {cores} cores, seed {seed} |

## Trained on

| drive | scans | segments |
|---|---|---|
{sources}

{licenses}

## Figures

Measured on the validation groups ({held_out:.0%} of the training set's groups, held out whole),
with descriptors as stored. A test drive has more groups to confuse, so its figures are lower.
{near}

| figure | value |
|---|---|
{figures}

Pair classifier: {pair_kind} (AUC on held-out groups by kind: {pair_auc}).
The stated probabilities of held-out segments, each with its {nearest} nearest among {database:,},
are off by {calibration_error:.3f} on average.

## Train this model again

{command}
"""

WHAT = {
    "eigenvalue": "SegMatch's seven eigenvalue features, standardized: the paper's baseline.",
    "siamese": "The paper's Siamese extractor: two branches and a third network, trained on pairs.",
    "contrastive": "The paper's contrastive extractor: trained to bring matches together and keep "
    "hard non-matches apart.",
    "context": "The segment by the multi-similarity loss, and its neighborhood by linear "
    "discriminant analysis.",
    "group": "The paper's group-based extractor: trained to classify groups of segments.",
}


CALIBRATION_FIGURES = ("candidate_calibration_error", "expected_calibration_error", "brier")
"""Figures that the card leaves out: it states the calibration error of the pair classifier."""


def write_card(folder: Path, manifest: Manifest) -> None:
    """Write the model card `README.md` into the model's folder."""
    training = manifest.training
    sources = [
        f"| {source['drive']} | {source['scans'][0]} to {source['scans'][1]}, a capture every "
        f"{source['frame_step']} | {source['segments']:,} |"
        for source in training["sources"]
    ]
    figures = [
        f"| {name} | {value:.3f} |"
        for name, value in manifest.figures["validation"].items()
        if isinstance(value, float) and name not in CALIBRATION_FIGURES
    ]
    (folder / "README.md").write_text(
        CARD.format(
            name=manifest.name,
            what=WHAT[manifest.method],
            model_id=manifest.model_id,
            method=manifest.method,
            network=manifest.network or "none",
            dimension=manifest.dimension,
            code_bytes=manifest.code_bytes,
            seconds=training["seconds"],
            cores=training["machine"]["cores"],
            seed=training["seed"],
            sources="\n".join(sources),
            licenses=training["licence"],
            near=""
            if manifest.neighborhood is None
            else "The neighborhoods of these groups were part of the training, so the figures are "
            "optimistic.\n",
            held_out=training["validation_share"],
            figures="\n".join(figures),
            pair_kind=manifest.pair["kind"],
            pair_auc=", ".join(f"{name} {auc:.3f}" for name, auc in manifest.pair["auc"].items()),
            nearest=manifest.pair["nearest"],
            database=manifest.pair["database"],
            calibration_error=manifest.pair["calibration_error"],
            command=textwrap.indent(training["command"], "    "),
        )
    )
