"""Metrics reference, made from the registry that `/metrics` serves."""

from prometheus_client import Histogram

from cli.reference.markdown import code, table
from service.core.metrics import Metrics
from service.core.timing import STAGES


def metric_pages() -> dict[str, str]:
    """Return the generated parts of the page on metrics."""
    metrics = [
        each
        for each in vars(Metrics()).values()
        if hasattr(each, "describe") and hasattr(each, "_labelnames")
    ]
    rows = []
    for each in metrics:
        (family,) = each.describe()
        suffix = "_total" if family.type == "counter" else ""
        labels = ", ".join(map(code, each._labelnames))
        kind = "histogram" if isinstance(each, Histogram) else family.type
        rows.append([code(family.name + suffix), kind, labels, family.documentation])
    return {
        "metrics": table(["Metric", "Type", "Labels", "Meaning"], rows),
        "stages": ", ".join(map(code, STAGES)) + "\n",
    }
