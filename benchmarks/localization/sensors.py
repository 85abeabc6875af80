"""Localization across sensors: robot B in the map of robot A, for pairs of sensors in one place."""

import json
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.localization.pose_tables import head, line, percent
from evaluation.calibration import calibration_figures
from evaluation.machine import machine
from evaluation.poses.evaluate import outcome_of
from evaluation.poses.queries import (
    DescribedCapture,
    Pair,
    PoseQuery,
    described_captures,
    localize_query,
    random_frame,
)
from evaluation.poses.report import Outcome, bounds, report, share
from evaluation.poses.robot import Robot
from evaluation.poses.town_drives import TownDrives
from placecell.localization import LocalizationParameters
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

MAP = "map"

ERROR = "expected_calibration_error"

Cell = tuple[str, str]
"""Sensor of the map, and sensor of the queries."""

FIGURES = (
    "queries",
    "localised_right",
    "wrong_but_sure",
    "not_localised",
    "best_pose_right",
    "told_share_of_right",
    "success_2m_5deg",
    "expected_calibration_error",
    "brier",
    "median_position_error_m",
    "median_yaw_error_deg",
    "counts",
    "bounds_95",
    "reasons",
)
"""Figures of `evaluate-poses` that a cell has."""


@dataclass(frozen=True, slots=True)
class SensorMatrix:
    """Measurement of pairs of sensors.

    Each finished cell is written to `file` at once, so that a stopped run continues where it was.

    Attributes:
        drives: drives of both robots with every sensor.
        file: JSON file of the figures.
        most: largest number of queries of a cell, spread evenly; None: all captures.
        k: candidates per segment.
        jobs: number of threads.
        parameters: parameters of the localization.
    """

    drives: TownDrives
    file: Path
    most: int | None = None
    k: int = 25
    jobs: int = 1
    parameters: LocalizationParameters = field(default_factory=LocalizationParameters)

    def prepare(self, cells: Iterable[Cell], progress: Progress = silent) -> None:
        """Simulate and segment the drives that the cache lacks, one sensor per thread.

        Raises:
            ValueError: a sensor or the place is unknown.
        """
        names = sensors_of(cells)
        self.drives.check(names)
        with ThreadPoolExecutor(self.jobs) as pool:
            done = pool.map(self.drives.prepare, names)
            for _ in progress(range(len(names)), len(names), "preparing sensors"):
                next(done)

    def measure(
        self, cells: Sequence[Cell], model: Path, progress: Progress = silent
    ) -> dict[str, Any]:
        """Measure the cells that the file lacks; return all figures of the file.

        Args:
            cells: cells to measure.
            model: folder of the model.
            progress: wraps the loops.

        Raises:
            ValueError: the file has figures of other settings or of another model, a sensor or the
                place is unknown, or a drive has no segments.
        """
        with Engine.temporary(model) as engine:
            figures = self._read(engine.model.id)
            known = {(row["map_sensor"], row["query_sensor"]) for row in figures["cells"]}
            missing = [cell for cell in dict.fromkeys(cells) if cell not in known]
            if missing:
                self.prepare(missing, progress)
                for row in self._rows(missing, engine, progress):
                    figures["cells"].append(row)
                    figures["summary"] = summary(figures["cells"])
                    self._write(figures)
        return figures

    def _rows(
        self, cells: Sequence[Cell], engine: Engine, progress: Progress
    ) -> Iterator[dict[str, Any]]:
        """Yield the figures of each cell. Each drive is read and described once."""
        askers = list(dict.fromkeys(asking for _, asking in cells))
        captures = {
            askers[number]: self._captures(askers[number], engine)
            for number in progress(range(len(askers)), len(askers), "describing queries")
        }
        ordered = sorted(cells, key=lambda cell: sensors_of(cells).index(cell[0]))
        mapper: Robot | None = None
        for number in progress(range(len(ordered)), len(ordered), "localizing"):
            mapping, asking = ordered[number]
            if mapper is None or mapper.sensor != mapping:
                if mapper is not None:
                    engine.delete_map(MAP)
                mapper = self.drives.robot("robot_a", mapping)
                compact = mapper.build_map(engine, MAP)
                engine.put_map(MAP, compact)
            robot, seen = captures[asking]
            queries = Pair(mapper, robot, blocks=False).posed(seen, random_frame(0))
            yield {
                "map_sensor": mapping,
                "query_sensor": asking,
                "map_segments": len(compact),
                "query_segments_mean": round(float(np.mean([len(each.codes) for each in seen])), 1),
                **cell_figures(self._localize(engine, list(queries))),
            }

    def _captures(self, sensor: str, engine: Engine) -> tuple[Robot, list[DescribedCapture]]:
        """Return robot B with a sensor, without the points of its segments, and its captures."""
        robot = self.drives.robot("robot_b", sensor)
        robot.check_segments()
        captures = list(described_captures(robot, engine, self.most))
        return replace(robot, recordings=()), captures

    def _localize(self, engine: Engine, queries: Sequence[PoseQuery]) -> list[Outcome]:
        """Localize the queries of a cell in the present map."""

        def localized(query: PoseQuery) -> Outcome:
            found, milliseconds = localize_query(engine, query, MAP, self.k, self.parameters)
            return outcome_of(found, query, milliseconds)

        with ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(localized, queries))

    def _read(self, model_id: str) -> dict[str, Any]:
        """Read the figures of an earlier run, or begin new ones.

        Raises:
            ValueError: the file has figures of other settings or of another model.
        """
        settings = {
            "seed": self.drives.seed,
            "place": self.drives.place,
            "scans": self.drives.scans,
            "every": self.drives.step,
            "queries": self.most,
            "k": self.k,
            "model_id": model_id,
        }
        if not self.file.exists():
            return settings | {"machine": machine(), "cells": [], "summary": summary([])}
        try:
            figures: dict[str, Any] = json.loads(self.file.read_text(encoding="utf-8"))
        except ValueError as error:
            raise ValueError(
                f"{self.file}: {error}. It is no file of 'placecell bench sensors'. Give another "
                "--json file."
            ) from error
        for name, value in settings.items():
            if figures.get(name) != value:
                raise ValueError(
                    f"{self.file} has figures with {name} {figures.get(name)}, not {value}. Give "
                    "another --json file."
                )
        return figures

    def _write(self, figures: dict[str, Any]) -> None:
        """Replace the file as a whole."""
        self.file.parent.mkdir(parents=True, exist_ok=True)
        part = self.file.with_name(self.file.name + ".part")
        part.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
        part.replace(self.file)


def sensors_of(cells: Iterable[Cell]) -> list[str]:
    """Return the sensors of cells, each once."""
    return list(dict.fromkeys(sensor for cell in cells for sensor in cell))


def cell_figures(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return the figures of a cell; `best_poses` has each best hypothesis, for sums over cells.

    A row of `best_poses` has the stated probability, and 1 or 0 for: right, localized.
    """
    figures = report(outcomes)
    return {name: figures[name] for name in FIGURES} | {
        "beyond_the_map": figures["beyond_the_map"]["queries"],
        "best_poses": [
            [round(each.probability, 5), int(each.right), int(each.localized)]
            for each in outcomes
            if np.isfinite(each.meters)
        ],
    }


def summary(cells: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the figures over all cells, over those of one sensor, and over those of two."""
    same = [row for row in cells if row["map_sensor"] == row["query_sensor"]]
    other = [row for row in cells if row["map_sensor"] != row["query_sensor"]]
    return {"all": pooled(cells), "same_sensor": pooled(same), "cross_sensor": pooled(other)}


def pooled(cells: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the figures of several cells as if their queries were one cell's."""
    n = sum(row["queries"] for row in cells)
    counts = {
        name: sum(row["counts"][name] for row in cells)
        for name in ("localised_right", "wrong_but_sure", "not_localised")
    }
    poses = np.array([each for row in cells for each in row["best_poses"]]).reshape(-1, 3)
    right = sum(round(row["best_pose_right"] * row["queries"]) for row in cells if row["queries"])
    return {
        "cells": len(cells),
        "queries": n,
        **{name: share(count, n) for name, count in counts.items()},
        "best_pose_right": share(right, n),
        "told_share_of_right": share(counts["localised_right"], right),
        **calibration_figures(poses[:, 0], poses[:, 1]),
        "least_right": min(
            (row["localised_right"] for row in cells if row["queries"]), default=None
        ),
        "counts": counts,
        "bounds_95": {name: bounds(count, n) for name, count in counts.items()},
    }


TABLES = {
    "Right / wrong but sure, percent": ("localised_right", "wrong_but_sure"),
    "Best pose right, percent": ("best_pose_right",),
    "Told of the right best poses, percent": ("told_share_of_right",),
    "Expected calibration error": (ERROR,),
}
"""Tables of a matrix, and the figures of each cell."""

SUMMARY = ("localised_right", "wrong_but_sure", "best_pose_right", "told_share_of_right", ERROR)
"""Columns of the table of sums."""


def matrix_tables(figures: dict[str, Any]) -> Iterator[str]:
    """Yield Markdown tables: a row per map sensor, a column per query sensor; then the summary."""
    cells = {(row["map_sensor"], row["query_sensor"]): row for row in figures["cells"]}
    asking = list(dict.fromkeys(query for _, query in cells))
    for title, names in TABLES.items():
        yield from (f"**{title}**", "")
        yield from head(["map \\ queries", *asking])
        for mapping in dict.fromkeys(sensor for sensor, _ in cells):
            row = (
                " / ".join(shown(cells[mapping, query], name, 1) for name in names)
                if (mapping, query) in cells
                else ""
                for query in asking
            )
            yield line([mapping, *row])
        yield ""
    yield from head(["", "queries", *(name.replace("_", " ") for name in SUMMARY)])
    for title, sums in figures["summary"].items():
        row = (shown(sums, name, 2) for name in SUMMARY)
        yield line([title.replace("_", " "), f"{sums['queries']:,}", *row])


def shown(row: dict[str, Any], name: str, digits: int) -> str:
    """Return a figure of a row as text: a share in percent, an error as it is."""
    value = row[name]
    return percent(value, digits) if name != ERROR or value is None else f"{value:.3f}"
