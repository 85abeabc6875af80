"""The dashboard asks for what the service tells."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from prometheus_client import Counter, Gauge, Histogram

from service.core.metrics import Metrics
from service.core.timing import STAGES

DEPLOY = Path(__file__).resolve().parents[2] / "deploy"
DASHBOARD = json.loads((DEPLOY / "dashboard.json").read_text())
WORDS = {"by", "min", "histogram_quantile", "max", "or", "rate", "sum", "time"}
ADDED_BY_PROMETHEUS = {"up": {"instance"}}


def panels() -> Iterator[dict[str, Any]]:
    for panel in DASHBOARD["panels"]:
        yield panel
        yield from panel.get("panels", [])


def queries() -> list[str]:
    return [target["expr"] for panel in panels() for target in panel.get("targets", [])]


def variables() -> dict[str, dict[str, Any]]:
    return {variable["name"]: variable for variable in DASHBOARD["templating"]["list"]}


def series() -> dict[str, set[str]]:
    """Names of time series that Prometheus gets, each with its labels."""
    metrics = Metrics()
    found = dict(ADDED_BY_PROMETHEUS)
    for metric in vars(metrics).values():
        if isinstance(metric, Counter | Gauge | Histogram):
            labels = {*metric._labelnames, "instance"}
            name = metric._name
            if isinstance(metric, Counter):
                found[f"{name}_total"] = labels
            elif isinstance(metric, Histogram):
                found |= {f"{name}_sum": labels, f"{name}_count": labels}
                found[f"{name}_bucket"] = labels | {"le"}
            else:
                found[name] = labels
    for family in metrics.registry.collect():
        for sample in family.samples:
            found.setdefault(sample.name, {*sample.labels, "instance"})
    return found


def selections(query: str) -> list[tuple[str, set[str]]]:
    """Names of time series in a query, each with the labels that it is chosen by."""
    words = r"([a-zA-Z_][a-zA-Z0-9_]*)"
    return [
        (name, set(re.findall(rf"{words}\s*(?:=~|!~|!=|=)", labels)))
        for name, labels in re.findall(words + r"\{([^}]*)\}", query)
    ]


def without_selections(query: str) -> str:
    return re.sub(r"[a-zA-Z_][a-zA-Z0-9_]*\{[^}]*\}(\[[^\]]*\])?", " ", query)


@pytest.mark.parametrize("query", queries())
def test_a_query_asks_for_series_and_labels_that_exist(query: str) -> None:
    known = series()
    chosen = selections(query)
    labels = set(re.findall(r"\w+", " ".join(re.findall(r"\bby \(([^)]*)\)", query))))

    assert chosen
    for name, by in chosen:
        assert name in known
        assert by <= known[name], name
        assert labels <= known[name], name
        assert "instance" in by, "other services' series of this name are counted, too"
    rest = re.sub(r"\bby \([^)]*\)", " ", without_selections(query))
    assert set(re.findall(r"[a-zA-Z_]\w*", rest)) <= WORDS


def test_every_metric_of_the_service_is_shown() -> None:
    shown = {name for query in queries() for name, _ in selections(query)}
    families = {re.sub(r"_(bucket|sum|count)$", "", name) for name in shown}

    told = {re.sub(r"_(bucket|sum|count)$", "", n) for n in series() if n.startswith("placecell_")}
    told = {name for name in told if not name.endswith("_created")}
    assert families >= told


def test_every_stage_is_shown_in_a_requests_order() -> None:
    named = [stage for query in queries() for stage in re.findall(r'stage="(\w+)"', query)]

    assert list(dict.fromkeys(named)) == list(STAGES)


def test_legends_name_labels_that_the_query_keeps() -> None:
    for panel in panels():
        for target in panel.get("targets", []):
            kept = " ".join(re.findall(r"\bby \(([^)]*)\)", target["expr"])) or "instance"
            assert set(re.findall(r"\{\{(\w+)\}\}", target["legendFormat"])) <= set(
                re.findall(r"\w+", kept)
            )


def test_variables_ask_for_labels_that_exist_and_are_all_defined() -> None:
    known = series()
    for variable in variables().values():
        if variable["type"] == "query":
            metric, label = re.fullmatch(
                r"label_values\((\w+), (\w+)\)", variable["query"]["query"]
            ).groups()  # type: ignore[union-attr]
            assert label in known[metric]
    used = set(re.findall(r"\$\{?(\w+)", json.dumps(DASHBOARD["panels"])))
    assert used - {"__rate_interval"} <= variables().keys()


def test_any_prometheus_will_do() -> None:
    for panel in panels():
        if panel["type"] != "row":
            for part in [panel, *panel["targets"]]:
                assert part["datasource"] == {"type": "prometheus", "uid": "${datasource}"}


def test_panels_have_their_own_ids_and_places() -> None:
    numbers = [panel["id"] for panel in panels()]
    cells = [
        (x, y)
        for panel in panels()
        for x in range(panel["gridPos"]["x"], panel["gridPos"]["x"] + panel["gridPos"]["w"])
        for y in range(panel["gridPos"]["y"], panel["gridPos"]["y"] + panel["gridPos"]["h"])
    ]

    assert len(set(numbers)) == len(numbers)
    assert len(set(cells)) == len(cells)
    assert max(x for x, _ in cells) < 24
