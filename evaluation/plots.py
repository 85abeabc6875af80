"""Figures of the experiments' report, named after those of the paper."""

from pathlib import Path
from typing import Any

import numpy as np

from evaluation.figure import figure

Models = dict[str, dict[str, Any]]

CURVES = {
    "group": ("accuracy", "validation_accuracy", "classification accuracy"),
    "siamese": ("accuracy", "validation_accuracy", "accuracy over pairs"),
    "contrastive": ("top1", "validation_top1", "top-1"),
}
"""Figure 3 (a) to (c): keys of the training and the validation curve, and label of the axis."""


def training_curves(models: Models, network: str, file: Path) -> None:
    """Draw figure 3: the training of each method by epoch, one line per seed."""
    with figure(file, len(CURVES)) as axes:
        for place, (method, (training, validation, label)) in zip(
            axes, CURVES.items(), strict=True
        ):
            for model in models.values():
                if (model["method"], model["network"], model["ablation"]) != (method, network, ""):
                    continue
                epochs = range(1, len(model["history"]) + 1)
                for key, color, name in (
                    (training, "C0", "training"),
                    (validation, "C1", "validation"),
                ):
                    # Without large enough groups no segment was held out for validation.
                    values = [epoch.get(key, np.nan) for epoch in model["history"]]
                    shown = name if model["seed"] == 0 else None
                    place.plot(epochs, values, color=color, label=shown, linewidth=1)
            place.set(title=method, xlabel="epoch", ylabel=label, ylim=(0, 1))
            place.legend(loc="lower right")
            place.grid(alpha=0.3)


def roc_curves(models: Models, file: Path) -> None:
    """Draw figure 4: the ROC curves of the classification of pairs."""
    with figure(file, size=5.5) as (axes,):
        for name, model in models.items():
            if model["seed"] == 0 and not model["ablation"]:
                rates = list(zip(*model["roc"], strict=True))
                axes.plot(*rates, label=f"{name}: {model['figures']['pair_auc']:.3f}")
                forest = list(zip(*model["paper_forest"]["roc"], strict=True))
                label = f"  with the paper's forest: {model['paper_forest']['auc']:.3f}"
                axes.plot(*forest, "--", color=axes.lines[-1].get_color(), label=label, linewidth=1)
        axes.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        axes.set(xlabel="false positive rate", ylabel="true positive rate", title="pairs")
        axes.legend(loc="lower right", fontsize=7, title="area under the curve")
        axes.grid(alpha=0.3)


def candidate_matches(models: Models, file: Path) -> None:
    """Draw figure 5: share of segments whose nearest neighbor is of their group."""
    chosen = {n: m for n, m in models.items() if m["seed"] == 0 and not m["ablation"]}
    with figure(file, size=5.5) as (axes,):
        values = [model["figures"]["top1"] for model in chosen.values()]
        bars = axes.barh(list(chosen), values)
        axes.bar_label(bars, [f"{value:.1%}" for value in values], padding=3)
        axes.invert_yaxis()
        axes.set(xlabel="correct candidate matches (top-1)", xlim=(0, 1))
        axes.grid(axis="x", alpha=0.3)


def distance_distributions(models: Models, names: list[str], file: Path) -> None:
    """Draw the distances of positive and negative pairs, per model."""
    with figure(file, len(names)) as axes:
        for place, name in zip(axes, names, strict=True):
            distances = models[name]["distances"]
            for kind, color in (("positive", "C2"), ("negative", "C3")):
                place.stairs(
                    distances[kind],
                    distances["edges"],
                    fill=True,
                    alpha=0.5,
                    color=color,
                    label=kind,
                )
            place.set(title=name, xlabel="distance", ylabel="density")
            place.legend()


def dropout(model: dict[str, Any], usual: float) -> float:
    """Return the dropout of a Siamese training: as it was changed, or the usual one."""
    return float(model["changes"].get("dropout", usual))


def by_dropout(models: Models, network: str, usual: float) -> list[dict[str, Any]]:
    """Return the Siamese models of seed 0, in ascending order of their dropout."""
    swept = [
        model
        for model in models.values()
        if (model["method"], model["network"], model["seed"]) == ("siamese", network, 0)
    ]
    return sorted(swept, key=lambda model: dropout(model, usual))


def overfitting(models: Models, network: str, usual: float, file: Path) -> None:
    """Draw the accuracy of Siamese trainings in training and validation, by dropout.

    Args:
        models: the models of an experiment's report, by name.
        network: the trunk whose trainings are drawn.
        usual: dropout of a training that did not change it.
        file: the picture to write.
    """
    with figure(file, size=5.5) as (axes,):
        for index, model in enumerate(by_dropout(models, network, usual)):
            epochs = range(1, len(model["history"]) + 1)
            for key, style in (("accuracy", "-"), ("validation_accuracy", "--")):
                axes.plot(
                    epochs,
                    [epoch[key] for epoch in model["history"]],
                    style,
                    color=f"C{index}",
                    label=f"dropout {dropout(model, usual)}, {key.replace('_', ' ')}",
                )
        axes.set(xlabel="epoch", ylabel="accuracy over pairs", title="Siamese, regularization")
        axes.legend(fontsize=8)
        axes.grid(alpha=0.3)


def reliability(models: Models, file: Path) -> None:
    """Draw the stated against the true match probability of held-out segments."""
    with figure(file, size=5.5) as (axes,):
        axes.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        for name, model in models.items():
            if model["seed"] == 0 and not model["ablation"]:
                stated, true, _ = zip(*model["pair"]["reliability"], strict=True)
                axes.plot(stated, true, marker="o", markersize=3, label=name)
        axes.set(xlabel="stated probability", ylabel="share of matches", title="reliability")
        axes.legend(fontsize=8)
        axes.grid(alpha=0.3)


def studies(curves: dict[str, dict[str, Any]], file: Path) -> None:
    """Draw the curves of the recognition study, one line per model, and storage of the last."""
    panels = {
        "by_points": ("points", "points of the segment"),
        "by_metres": ("metres", "distance of viewpoints below which mates are left out, m"),
        "by_degrees": ("degrees", "angle of views below which mates are left out, deg"),
        "by_occlusion": ("lost", "occluded share of the query"),
        "by_density": ("lost", "missing share of the query's points"),
    }
    with figure(file, len(panels) + 1, size=3.8) as axes:
        for place, (key, (along, label)) in zip(axes, panels.items(), strict=False):
            for name, curve in curves.items():
                at = [row[along] if along != "points" else row[along][0] for row in curve[key]]
                place.plot(
                    at,
                    [np.nan if row["top1"] is None else row["top1"] for row in curve[key]],
                    marker="o",
                    markersize=3,
                    label=name,
                )
            place.set(xlabel=label, ylabel="top-1 of segments with a mate", ylim=(0, 1))
            place.grid(alpha=0.3)
        axes[0].set_xscale("log")
        axes[0].legend(fontsize=8)
        name, curve = list(curves.items())[-1]
        for bits in sorted({row["bits"] for row in curve["by_storage"]}, reverse=True):
            rows = [row for row in curve["by_storage"] if row["bits"] == bits]
            axes[-1].plot(
                [row["dimension"] for row in rows],
                [row["top1"] for row in rows],
                marker="o",
                markersize=3,
                label=f"{bits} bits",
            )
        axes[-1].set(xlabel="dimensions", ylabel="top-1", title=f"storage: {name}")
        axes[-1].legend(fontsize=8)
        axes[-1].grid(alpha=0.3)


def accuracy_against_speed(points: list[tuple[str, float, float]], file: Path) -> None:
    """Draw accuracy against speed of each network.

    Args:
        points: name, segments per second and top-1 accuracy of each network.
        file: PNG file to write.
    """
    with figure(file, 1) as (axes,):
        for name, rate, accuracy in points:
            axes.plot(rate, accuracy, "o", markersize=5)
            axes.annotate(
                name, (rate, accuracy), fontsize=8, textcoords="offset points", xytext=(4, 4)
            )
        axes.set_xscale("log")
        axes.set(xlabel="segments per second", ylabel="top-1, segments alone", title="networks")
        axes.grid(alpha=0.3)
