"""Report of the experiments in Markdown, beside the paper's figures."""

import json
from pathlib import Path
from statistics import mean, stdev
from typing import Any

from evaluation import plots
from training.methods.registry import METHODS
from training.methods.siamese import SiameseRecipe

PAPER = {
    "eigenvalue": "about 6%",
    "group": "about 50%",
    "siamese": "about 30%",
    "contrastive": "about 50%",
}
"""Correct candidate matches in the paper's figure 5, for about 16,000 segments in 3,000 groups."""

PAPER_TIMES = {"group": "1 h", "siamese": "6 h", "contrastive": "24 h"}
"""Training times of the paper on a GTX 980."""

DROPOUT = SiameseRecipe().dropout


def write_report(report: dict[str, Any], output: Path) -> Path:
    """Write `report.json`, the figures and `report.md`; return the path of `report.md`."""
    (output / "report.json").write_text(json.dumps(report, indent=1) + "\n")
    models = report["models"]
    network = next(iter(report["throughput"]))
    plots.training_curves(models, network, output / "training.png")
    plots.roc_curves(models, output / "roc.png")
    plots.candidate_matches(models, output / "candidates.png")
    contrastive = f"contrastive-{network}-0"
    plots.distance_distributions(
        models, [contrastive, f"{contrastive}-random-pairs"], output / "distances.png"
    )
    plots.overfitting(models, network, DROPOUT, output / "overfitting.png")
    plots.reliability(models, output / "reliability.png")
    test, training = report["test"], report["training"]
    sources = ", ".join(
        f"{source['drive']} scans {source['scans'][0]} to {source['scans'][1]}"
        for source in training["sources"]
    )
    lines = [
        "# The paper's experiments",
        "",
        f"Trained on {sources}: {training['segments']:,} segments in {training['groups']:,} "
        f"groups. {training['validation_segments']:,} more segments are in validation groups. "
        f"Tested on {test['drive']}, scans {test['scans'][0]} to {test['scans'][1]}: "
        f"{test['segments']:,} segments in {test['groups']:,} groups. "
        f"Protocol {report['protocol']}; descriptors in their stored form of 32 bytes. "
        f"{report['fits_grid']:.1%} of the test segments fit into the voxel grid (in the paper "
        "about 95%). Machine: "
        f"{report['machine']['processor']}, {report['machine']['cores']} cores.",
        "",
        *_candidates(models),
        *_pairs(models),
        *_cost(report),
        *_figures(models, network),
    ]
    file = output / "report.md"
    file.write_text("\n".join(lines) + "\n")
    return file


def _compared(models: plots.Models) -> dict[tuple[str, str], list[dict[str, Any]]]:
    """Return the models that are compared with the paper, by method and network."""
    found: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for model in models.values():
        if not model["ablation"]:
            found.setdefault((model["method"], model["network"]), []).append(model)
    return found


def _spread(models: list[dict[str, Any]], key: str) -> str:
    values = [model["figures"][key] for model in models if model["figures"][key] is not None]
    if not values:
        return "-"
    shown = f"{mean(values):.1%}"
    return f"{shown} ± {stdev(values):.1%} ({len(values)} seeds)" if len(values) > 1 else shown


def _candidates(models: plots.Models) -> list[str]:
    rows = [
        f"| {method} | {network or '-'} | {PAPER[method]} | {_spread(same, 'top1')} "
        f"| {_spread(same, 'top1_with_mate')} | {_spread(same, 'recall_at_25')} "
        f"| {_spread(same, 'cross_view_top1')} |"
        for (method, network), same in _compared(models).items()
    ]
    return [
        "## Correct candidate matches (figure 5)",
        "",
        "| method | network | paper | top1 | with a mate | recall at 25 | cross view (10 m) |",
        "|---|---|---|---|---|---|---|",
        *rows,
        "",
        "![Correct candidate matches](candidates.png)",
        "",
    ]


def _pairs(models: plots.Models) -> list[str]:
    rows = []
    for (method, network), same in _compared(models).items():
        pair = same[0]["pair"]
        forest = same[0]["paper_forest"]["auc"]
        rows.append(
            f"| {method} | {network or '-'} | {pair['kind']} | {_spread(same, 'pair_auc')} "
            f"| {_spread(same, 'pair_accuracy')} | {_spread(same, 'pair_auc_by_distance')} "
            f"| {forest:.1%} | {_spread(same, 'candidate_calibration_error')} |"
        )
    return [
        "## Pairs: match or not (figure 4)",
        "",
        "*Served* is the kind of classifier that is best on pairs of held-out groups. Plain "
        "distance is the control. The paper's forest takes the concatenated descriptors. The "
        "paper's Siamese network reached about 80%. The calibration error is the mean of "
        "|stated - true| of the served probability, over each test segment and its 25 nearest.",
        "",
        "| method | network | served | AUC | accuracy | AUC by distance | AUC, paper's forest "
        "| calibration error |",
        "|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "![ROC of all methods](roc.png)",
        "![Reliability of the stated probabilities](reliability.png)",
        "",
    ]


def _cost(report: dict[str, Any]) -> list[str]:
    compared = _compared(report["models"])
    networks = list(report["throughput"])
    times = [
        f"| {method} | {PAPER_TIMES[method]} | "
        + " | ".join(
            f"{mean(model['cpu_seconds'] for model in compared[method, network]) / 60:.1f} min, "
            f"{len(compared[method, network][0]['history'])} epochs"
            for network in networks
        )
        + " |"
        for method in METHODS
    ]
    paper = report["throughput"].get("paper")
    rates = [
        f"| {network} | {rate:,.0f} |" + (f" {rate / paper:.1f} |" if paper else " - |")
        for network, rate in report["throughput"].items()
    ]
    return [
        "## Cost",
        "",
        "Training time in minutes, summed over all cores (the paper: on a GTX 980):",
        "",
        f"| method | paper | {' | '.join(networks)} |",
        "|---|---|" + "---|" * len(networks),
        *times,
        "",
        "Inference with ONNX Runtime in batches of 64 on all cores (the paper: 12 segments per "
        "second on a CPU, 340 for the reduced network):",
        "",
        "| network | segments per second | relative to `paper` |",
        "|---|---|---|",
        *rates,
        "",
    ]


def _figures(models: plots.Models, network: str) -> list[str]:
    return [
        "## Training, epoch by epoch (figure 3)",
        "",
        f"Network `{network}`; one line per seed.",
        "",
        "![Training curves](training.png)",
        "",
        "## Hard pairs",
        "",
        "Distances of test pairs after contrastive training with hard pairs and with random pairs: "
        f"top1 is {models[f'contrastive-{network}-0']['figures']['top1']:.1%} against "
        f"{models[f'contrastive-{network}-0-random-pairs']['figures']['top1']:.1%}.",
        "",
        "![Distances of positive and negative pairs](distances.png)",
        "",
        "## Regularization of the Siamese network",
        "",
        "| dropout | training accuracy | validation accuracy | test top1 | test pair accuracy |",
        "|---|---|---|---|---|",
        *(
            f"| {plots.dropout(model, DROPOUT)} | {model['history'][-1]['accuracy']:.1%} "
            f"| {model['history'][-1]['validation_accuracy']:.1%} "
            f"| {model['figures']['top1']:.1%} | {model['figures']['pair_accuracy']:.1%} |"
            for model in plots.by_dropout(models, network, DROPOUT)
        ),
        "",
        "![Over-fitting by dropout](overfitting.png)",
    ]
