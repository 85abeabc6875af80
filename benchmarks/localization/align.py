"""Accuracy of map alignment: pairs of maps of stretches of a town's two drives."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from placecell_client import CompactMap, moved
from placecell_client.maps.edit import take

from evaluation.figure import figure
from evaluation.machine import machine
from evaluation.poses.recordings import recording_of
from evaluation.poses.report import bounds
from evaluation.poses.robot import Robot
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.localization import Pose
from placecell.map_alignment import MapAlignment
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

RIGHT = (0.5, 1.0)
"""Tolerance of a right alignment, meters and degrees, in the middle of the overlap."""

ENOUGH = 0.2
"""Overlap from which a pair of maps counts as alignable, a share of the map."""


@dataclass(frozen=True, slots=True)
class Drives:
    """Maps of two robots' whole drives.

    Attributes:
        maps: the maps, in the frames of their drives.
        scans: scan number of each capture, per map.
        first: number of earlier scans that a capture accumulates.
        protocol: version of the segmentation protocol.
    """

    maps: tuple[CompactMap, CompactMap]
    scans: tuple[np.ndarray, np.ndarray]
    first: int
    protocol: str

    @classmethod
    def of(
        cls,
        folders: Sequence[Path],
        prepared: Sequence[Path | None],
        engine: Engine,
        progress: Progress,
    ) -> "Drives":
        """Segment both drives, unless recordings are given, and describe the segments."""
        maps, scans = [], []
        for folder, file in zip(folders, prepared, strict=True):
            drive = open_drive(folder)
            recording = recording_of(drive, None, file, progress)
            robot = Robot(folder.name, drive, [recording], np.eye(4))
            maps.append(robot.build_map(engine, folder.name))
            scans.append(np.unique(recording.captures))
        first = recording.parameters.accumulated_scans - 1
        return cls((maps[0], maps[1]), (scans[0], scans[1]), first, recording.parameters.protocol)

    def stretch(self, which: int, ends: Sequence[int], frame: Float64) -> CompactMap:
        """Return the map of a stretch of one drive, in a frame of its own.

        Args:
            which: 0 or 1, the drive.
            ends: first and last scan. Captures that accumulate earlier scans are left out.
            frame: transform (4, 4) from the frame of the drive.
        """
        scan = self.scans[which][self.maps[which].frame_index]
        part = take(self.maps[which], (scan >= ends[0] + self.first) & (scan <= ends[1]))
        pose = Pose.of_matrix(frame)
        return moved(part, pose.rotation, pose.translation, f"stretch {which}")


def measure_alignment(
    folder: Path,
    model: Path,
    prepared: Sequence[Path | None] = (None, None),
    progress: Progress = silent,
) -> dict[str, Any]:
    """Align all map pairs of a town; return the report that `placecell bench align` writes.

    Args:
        folder: output folder of `placecell town --pairs`.
        model: folder of the model.
        prepared: recording of each drive; None: segment the drive.
        progress: wraps the loops.

    Raises:
        ValueError: the folder has no pairs, or a recording is of another drive.
    """
    file = folder / "pairs.json"
    if not file.is_file():
        raise ValueError(f"{file} does not exist. Run 'placecell town --meters M --pairs N'.")
    drawn = json.loads(file.read_text())
    with Engine.temporary(model) as engine:
        folders = [folder / name for name in drawn["drives"]]
        drives = Drives.of(folders, prepared, engine, progress)
        pairs = [(kind, pair) for kind in ("overlapping", "apart") for pair in drawn[kind]]
        rows = []
        for number in progress(range(len(pairs)), len(pairs), "aligning"):
            kind, pair = pairs[number]
            for which, name in enumerate("ab"):
                frame = np.array(pair[f"frame_{name}"])
                part = drives.stretch(which, pair[f"scans_{name}"], frame)
                engine.put_map(f"{name}-{number}", part)
            started = perf_counter()
            found = engine.align(f"a-{number}", f"b-{number}").found
            milliseconds = 1e3 * (perf_counter() - started)
            rows.append(row_of(kind, pair, found, milliseconds))
        model_id = engine.model.id
    return {
        "town": {"seed": drawn["seed"], "street_metres": drawn["street_metres"]},
        "map_metres": drawn["metres"],
        "protocol": drives.protocol,
        "model_id": model_id,
        "machine": machine(),
        "right_within": {"metres": RIGHT[0], "degrees": RIGHT[1]},
        **summarize(rows),
        "rows": rows,
    }


def row_of(
    kind: str, pair: dict[str, Any], found: MapAlignment, milliseconds: float
) -> dict[str, Any]:
    """Return the report row of a pair: its alignment, compared with the truth."""
    meters = degrees = None
    if found.best is not None and found.pose is not None:
        truth, middle = Pose.of_matrix(np.array(pair["b_to_a"])), found.best.source.mean(axis=0)
        meters, angle = found.pose.difference(truth, middle)
        degrees = float(np.degrees(angle))
    best = found.best
    return {
        "kind": kind,
        "overlap": pair["overlap"],
        "look_alike": pair["look_alike"],
        "aligned": found.pose is not None,
        "reason": found.reason,
        "metres": meters,
        "degrees": degrees,
        "right": meters is not None
        and degrees is not None
        and kind == "overlapping"
        and meters <= RIGHT[0]
        and degrees <= RIGHT[1],
        "pairs": 0 if best is None else len(best),
        "agreement": 0.0 if best is None else best.agreement,
        "score": 0.0 if best is None else best.score,
        "milliseconds": milliseconds,
    }


def summarize(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return counts with 95% bounds, per kind of pair."""
    overlapping = [row for row in rows if row["kind"] == "overlapping"]
    groups = {
        "overlapping": overlapping,
        "overlapping_enough": [row for row in overlapping if row["overlap"] >= ENOUGH],
        "apart": [row for row in rows if row["kind"] == "apart"],
    }
    right = [row for row in rows if row["right"]]
    return {
        **{
            name: {
                "pairs": len(group),
                "aligned": sum(row["aligned"] for row in group),
                "right": sum(row["right"] for row in group),
                "wrong": sum(row["aligned"] and not row["right"] for row in group),
                "right_bounds_95": bounds(sum(row["right"] for row in group), len(group)),
            }
            for name, group in groups.items()
            if group
        },
        "median_position_error_m": float(np.median([row["metres"] for row in right]))
        if right
        else None,
        "median_yaw_error_deg": float(np.median([row["degrees"] for row in right]))
        if right
        else None,
        "p50_ms": float(np.percentile([row["milliseconds"] for row in rows], 50)),
        "p99_ms": float(np.percentile([row["milliseconds"] for row in rows], 99)),
    }


def draw_alignment(report: dict[str, Any], file: Path) -> None:
    """Plot the agreement of each alignment against the overlap of the maps."""
    with figure(file, 1) as (axes,):
        for label, color, aligned, right in (
            ("right alignment", "tab:green", True, True),
            ("wrong alignment", "tab:red", True, False),
            ("not aligned", "0.6", False, False),
        ):
            wanted = {"aligned": aligned, "right": right}
            rows = [row for row in report["rows"] if wanted.items() <= row.items()]
            overlap, agreement = ([row[name] for row in rows] for name in ("overlap", "agreement"))
            axes.scatter(overlap, agreement, color=color, s=12, label=f"{label}: {len(rows)}")
        axes.set(xlabel="overlap of the maps, share", ylabel="agreement within the overlap, share")
        axes.legend()
        axes.grid(alpha=0.3)
