"""Tables of localisation, from the JSON files of `evaluate-poses` and `bench peers`."""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

OWN = ("queries", "right", "wrong but sure", "not localised", "median error", "until localised")


def read_reports(folder: Path) -> dict[str, dict[str, Any]]:
    """By system, its figures: `NAME.json` is a report of ours, `peers*.json` one of many rows."""
    found: dict[str, dict[str, Any]] = {}
    for file in sorted(folder.glob("*.json")):
        report = json.loads(file.read_text())
        rows = report.get("rows")
        found |= {file.stem: report} if rows is None else {row["name"]: row for row in rows}
    return found


def comparison_table(cases: Mapping[str, Mapping[str, dict[str, Any]]]) -> Iterator[str]:
    """Markdown: a row a system, a column a case; right and wrong but sure, percent.

    Args:
        cases: by name, the figures by system.
    """
    yield from head(["", *cases])
    for name in dict.fromkeys(system for figures in cases.values() for system in figures):
        cells = (figures.get(name) for figures in cases.values())
        yield line([name, *("" if cell is None else both(cell) for cell in cells)])


def full_table(cases: Mapping[str, dict[str, Any]]) -> Iterator[str]:
    """Markdown: a row a case, with 95% bounds; what one system reached.

    Args:
        cases: by name, a report of `evaluate-poses`, or a row of `bench peers`.
    """
    yield from head(["", *OWN])
    for name, report in cases.items():
        meters, degrees = report["median_position_error_m"], report["median_yaw_error_deg"]
        # Peers have none: which of their poses are sure is for their own rule to say.
        until = report.get("metres_until_localised", {"p95": None})
        yield line(
            [
                name,
                f"{report['queries']:,}",
                *(bounded(report, key) for key in report["bounds_95"]),
                "-" if meters is None else f"{meters:.2f} m, {degrees:.2f} deg",
                "-"
                if until["p95"] is None
                else f"{until['median']:.0f} m; 95%: {until['p95']:.0f}",
            ]
        )


def both(figures: Mapping[str, Any]) -> str:
    """Right and wrong but sure; a model that was trained on scans of the drive has a star."""
    right, wrong = (
        percent(figures[key], digits)
        for key, digits in (("localised_right", 1), ("wrong_but_sure", 2))
    )
    return f"{right} / {wrong}{' *' if figures.get('seen') else ''}"


def bounded(report: Mapping[str, Any], key: str) -> str:
    """A share with its bounds, percent."""
    low, high = report["bounds_95"][key]
    return f"{percent(report[key], 2)} ({100 * low:.2f} to {100 * high:.2f})"


def percent(share: float | None, digits: int) -> str:
    """A share; of no queries there is none."""
    return "-" if share is None else f"{100 * share:.{digits}f}"


def head(names: Sequence[str]) -> Iterator[str]:
    """A table's first two lines."""
    yield line(names)
    yield line(["---"] * len(names))


def line(cells: Sequence[str]) -> str:
    """A line of a table."""
    return f"| {' | '.join(cells)} |"
