"""A model's card: what a reader must know before using it, written from its manifest."""

from pathlib import Path

from segments.manifest import Manifest

CARD = """# Model `{name}`

{what}

| | |
|---|---|
| id | `{model_id}` |
| method | {method} |
| network | {network} |
| descriptor | {dimension} dimensions, one byte each as stored |
| trained | in {seconds:.0f} s on {cores} cores, seed {seed} |

## Trained on

| drive | scans | segments |
|---|---|---|
{sources}

{licences}

## Figures

On the validation groups ({held_out:.0%} of the training set's groups, held out whole), of
descriptors as stored; not comparable with a test drive, for there are fewer groups to confuse.

| figure | value |
|---|---|
{figures}

## Train it again

    {command}
"""

WHAT = {
    "eigenvalue": "SegMatch's seven eigenvalue features, standardised: the paper's baseline.",
    "group": "The paper's group-based extractor: trained to tell groups of segments apart.",
}


def write_card(folder: Path, manifest: Manifest) -> None:
    """Write `README.md` into the model's folder."""
    training = manifest.training
    sources = [
        f"| {source['drive']} | {source['scans'][0]} to {source['scans'][1]}, a frame every "
        f"{source['frame_step']} | {source['segments']:,} |"
        for source in training["sources"]
    ]
    figures = [
        f"| {name} | {value:.3f} |"
        for name, value in manifest.figures["validation"].items()
        if isinstance(value, float)
    ]
    (folder / "README.md").write_text(
        CARD.format(
            name=manifest.name,
            what=WHAT[manifest.method],
            model_id=manifest.model_id,
            method=manifest.method,
            network=manifest.network or "none",
            dimension=manifest.dimension,
            seconds=training["seconds"],
            cores=training["machine"]["cores"],
            seed=training["seed"],
            sources="\n".join(sources),
            licences=training["licence"],
            held_out=training["validation_share"],
            figures="\n".join(figures),
            command=training["command"],
        )
    )
