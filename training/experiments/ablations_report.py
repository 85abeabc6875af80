"""Report of the ablations: tables in Markdown and a plot of accuracy against speed."""

from itertools import groupby
from pathlib import Path
from statistics import mean, stdev
from typing import Any

from evaluation import plots

FIGURES = {
    "top1_alone": "top1, alone",
    "top1": "top1",
    "cross_view_top1": "cross_view_top1",
    "recall_at_25": "recall_at_25",
    "pair_auc_by_distance": "pair AUC",
}
"""Titles of the columns, by key."""

Row = dict[str, Any]


def write_ablations(report: dict[str, Any], output: Path) -> Path:
    """Write `ablations.md` and `speed.png`; return the path of `ablations.md`."""
    own = [row for row in report["rows"] if row["part"] == "model"]
    rows = best_rates([row for row in report["rows"] if row["part"] != "model"])
    lines = ["# Ablations", "", "Made by", "", f"    {report['command']}", ""]
    lines += [*_head("the model itself"), *(_line(row) for row in own)]
    if len(own) > 1:
        lines.append(_line({"name": "deviation"} | {key: _deviation(own, key) for key in FIGURES}))
    for part, members in groupby(rows, key=lambda row: row["part"]):
        lines += ["", *_head(f"{part} changed"), *(_line(row) for row in members)]
    if report["throughput"]:
        lines += ["", "Segments per second in this run, in batches of 64 on all cores:", ""]
        lines += [f"- {name}: {rate:,.0f}" for name, rate in report["throughput"].items()]
        points = speeds(report)
        plots.accuracy_against_speed(points, output / "ablations-speed.png")
        lines += ["", "![Accuracy against speed](ablations-speed.png)"]
    file = output / "ablations.md"
    file.write_text("\n".join(lines) + "\n")
    return file


def best_rates(rows: list[Row]) -> list[Row]:
    """Return the row of each loss whose learning rate is best on the validation groups."""
    kept: list[Row] = []
    for row in rows:
        if row["part"] != "loss":
            kept.append(row)
            continue
        loss = row["name"].rpartition("-")[0]
        rivals = [one for one in rows if one["part"] == "loss"]
        rivals = [one for one in rivals if one["name"].rpartition("-")[0] == loss]
        if row is max(rivals, key=lambda one: one["validation_top1"]):
            kept.append(row)
    return kept


def speeds(report: dict[str, Any]) -> list[tuple[str, float, float]]:
    """Return name, segments per second and top1 of the segment alone, by network and precision.

    The accuracy is that of the 8-bit network. The float32 network differs by less than two
    trainings with different seeds.
    """
    by_network = {row["network"]: row for row in report["rows"] if row["part"] == "network"}
    own = [row for row in report["rows"] if row["part"] == "model"]
    by_network |= {own[0]["network"]: {"top1_alone": mean(row["top1_alone"] for row in own)}}
    return [
        (name, rate, by_network[name.rpartition(" ")[0]]["top1_alone"])
        for name, rate in report["throughput"].items()
    ]


def _head(title: str) -> list[str]:
    return [f"| {title} | " + " | ".join(FIGURES.values()) + " |", "|---" * 6 + "|"]


def _deviation(rows: list[Row], key: str) -> float | None:
    values = [row[key] for row in rows]
    return None if None in values else stdev(values)


def _line(row: Row) -> str:
    # A short drive does not give every figure.
    cells = ("" if row[key] is None else f"{row[key]:.3f}" for key in FIGURES)
    return f"| {row['name']} | " + " | ".join(cells) + " |"
