"""Ablations: variants, shared trainings, and the report's choice of rates."""

from pathlib import Path

from training.experiments.ablations import RATES, variants
from training.experiments.ablations_report import best_rates, write_ablations
from training.methods.metric import LOSSES


def test_variants_of_the_neighborhood_share_a_network() -> None:
    every = list(variants(epochs=1, seeds=2))
    assert len({(one.part, one.name) for one in every}) == len(every)
    shared = {one.training_name() for one in every if one.part == "surroundings"}
    assert shared == {"model-seed-0"} == {every[0].training_name()}
    losses = [one for one in every if one.part == "loss"]
    assert len(losses) == len(RATES) * (len(LOSSES) + 1)
    assert {one.segment.epochs for one in every} == {1}


def row(part: str, name: str, top1: float, validation: float = 0.5) -> dict[str, object]:
    keys = ("top1", "top1_alone", "recall_at_25", "cross_view_top1", "pair_auc_by_distance")
    facts = {"part": part, "name": name, "network": "fast", "validation_top1": validation}
    return facts | dict.fromkeys(keys, top1)


def test_best_rate_of_a_loss_is_chosen_on_validation() -> None:
    rows = [
        row("loss", "a-b-0.1", 0.9, validation=0.2),
        row("loss", "a-b-0.2", 0.7, validation=0.4),
        row("loss", "c-0.1", 0.6, validation=0.1),
        row("data", "d", 0.5),
    ]
    assert [one["name"] for one in best_rates(rows)] == ["a-b-0.2", "c-0.1", "d"]


def test_report(tmp_path: Path) -> None:
    rows = [row("model", "seed-0", 0.8), row("model", "seed-1", 0.9), row("data", "d", 0.5)]
    report = {"rows": rows, "throughput": {"fast fp32": 100.0}, "command": "placecell x"}
    text = write_ablations(report, tmp_path).read_text()
    assert "| seed-1 | 0.900 | 0.900 |" in text
    assert "| deviation | 0.071 |" in text
    assert "- fast fp32: 100" in text
    assert (tmp_path / "ablations-speed.png").stat().st_size > 1000


def test_missing_figure_of_a_short_drive_stays_empty(tmp_path: Path) -> None:
    rows = [row("model", name, 0.8) | {"cross_view_top1": None} for name in ("seed-0", "seed-1")]
    report = {"rows": rows, "throughput": {}, "command": "placecell x"}
    text = write_ablations(report, tmp_path).read_text()
    assert "| seed-1 | 0.800 | 0.800 |  | 0.800 |" in text
    assert "| deviation | 0.000 | 0.000 |  | 0.000 |" in text
