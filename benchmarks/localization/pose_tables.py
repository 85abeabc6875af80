"""Localization tables, from the JSON files of `evaluate-poses` and `bench peers`."""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

OWN = (
    "queries",
    "right",
    "wrong but sure",
    "not localized",
    "best pose right",
    "told of these",
    "calibration error",
    "median error",
    "until localized",
)


def read_reports(folder: Path) -> dict[str, dict[str, Any]]:
    """Read the figures of each system in a folder.

    A file `NAME.json` is a report of `evaluate-poses`; a file `peers*.json` holds a row per peer.
    """
    found: dict[str, dict[str, Any]] = {}
    for file in sorted(folder.glob("*.json")):
        report = json.loads(file.read_text())
        rows = report.get("rows")
        found |= {file.stem: report} if rows is None else {row["name"]: row for row in rows}
    return found


def comparison_table(cases: Mapping[str, Mapping[str, dict[str, Any]]]) -> Iterator[str]:
    """Yield a Markdown table: a row per system, a column per case; percent right / wrong but sure.

    Args:
        cases: figures of each system, by case and system.
    """
    yield from head(["", *cases])
    for name in dict.fromkeys(system for figures in cases.values() for system in figures):
        cells = (figures.get(name) for figures in cases.values())
        yield line([name, *("" if cell is None else both(cell) for cell in cells)])


def full_table(cases: Mapping[str, dict[str, Any]]) -> Iterator[str]:
    """Yield a Markdown table of one system: a row per case, with 95% bounds.

    If a report names its sensors, the table has a column for them, and its rows are ordered by it.

    Args:
        cases: reports of `evaluate-poses`, or rows of `bench peers`, by case.
    """
    sensors = {name: sensors_of_report(report) for name, report in cases.items()}
    known = any(sensors.values())
    yield from head(["", *(["sensors"] if known else []), *OWN])
    for name in sorted(cases, key=sensors.__getitem__):
        report = cases[name]
        meters, degrees = report["median_position_error_m"], report["median_yaw_error_deg"]
        # Peers have no such figure, because their own rule decides which poses are sure.
        until = report.get("metres_until_localised", {"p95": None})
        error = report.get("expected_calibration_error")
        yield line(
            [
                name,
                *([sensors[name] or "-"] if known else []),
                f"{report['queries']:,}",
                *(bounded(report, key) for key in report["bounds_95"]),
                percent(report.get("best_pose_right"), 2),
                percent(report.get("told_share_of_right"), 2),
                "-" if error is None else f"{error:.3f}",
                "-" if meters is None else f"{meters:.2f} m, {degrees:.2f} deg",
                "-"
                if until["p95"] is None
                else f"{until['median']:.0f} m; 95%: {until['p95']:.0f}",
            ]
        )


def sensors_of_report(report: Mapping[str, Any]) -> str:
    """Return the sensor of the queries, and that of the map if it is another; empty if unknown."""
    asking, mapping = report.get("query_sensor"), report.get("map_sensor")
    if not asking:
        return ""
    return asking if mapping in {asking, None} else f"{asking} in the map of {mapping}"


def both(figures: Mapping[str, Any]) -> str:
    """Return percent right / wrong but sure; `*` marks a model trained on scans of the drive."""
    right, wrong = (
        percent(figures[key], digits)
        for key, digits in (("localised_right", 1), ("wrong_but_sure", 2))
    )
    return f"{right} / {wrong}{' *' if figures.get('seen') else ''}"


def bounded(report: Mapping[str, Any], key: str) -> str:
    """Return a share with its bounds, in percent."""
    low, high = report["bounds_95"][key]
    return f"{percent(report[key], 2)} ({100 * low:.2f} to {100 * high:.2f})"


def percent(share: float | None, digits: int) -> str:
    """Return a share in percent, or `-` if there were no queries."""
    return "-" if share is None else f"{100 * share:.{digits}f}"


def head(names: Sequence[str]) -> Iterator[str]:
    """Yield the first two lines of a table."""
    yield line(names)
    yield line(["---"] * len(names))


def line(cells: Sequence[str]) -> str:
    """Return a line of a table."""
    return f"| {' | '.join(cells)} |"
