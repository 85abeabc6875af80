"""`placecell bench robot`: measures a robot's own steps, from a scan to segments and a pose."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.bench.options import Drawn, JsonFile, Kept, write_json
from cli.common_options import Model
from cli.sources import clear_errors, parse_town, show
from cli.tables import new_table, print_tables

if TYPE_CHECKING:
    from evaluation.poses.robot import Robot
    from placecell.datasets import Drive


def robot(
    drive: Annotated[
        str,
        typer.Argument(
            help="Drive: a bag, an MCAP file, a folder of scans, or a folder in a known layout; or "
            "town:SEED:SENSOR:PLACE for a simulated drive, such as town:7:os1-128."
        ),
    ],
    json_file: JsonFile = None,
    cores: Annotated[
        int, typer.Option(min=1, help="Number of processor cores that may be used.")
    ] = 1,
    scans: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of scans to measure. The drive is played forward and backward as often as "
            "needed. (default: once through the drive)",
        ),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            help="Simulated seconds to measure, in place of --scans: 3600 is an hour of scans.",
        ),
    ] = None,
    localize_every: Annotated[
        int, typer.Option(min=1, help="Scans from one that is localized to the next.")
    ] = 1,
    town_scans: Annotated[
        int, typer.Option(min=20, help="Number of scans of a simulated drive.")
    ] = 60,
    town_columns: Annotated[
        int | None,
        typer.Option(
            min=16,
            help="Azimuth steps of a simulated sensor: 2048 for 210,000 points of 128 beams. "
            "(default: the sensor's own)",
        ),
    ] = None,
    model: Model = None,
    output: Kept = Path("out/bench"),
    seed: Drawn = 7,
) -> None:
    """Measure each step of a robot that localizes while it drives, by default at every scan.

    The steps are reading, odometry (apart), local map, ground, regions, ids, describing and
    localizing in a map of the same drive; of the other robot's drive in a town. The batch pipeline
    runs beside them. Processor times stand beside wall times.
    """
    from benchmarks.robot.live_steps import measure_robot, on_cores, period_of
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        if scans is not None and seconds is not None:
            raise ValueError("--scans and --seconds exclude each other.")
        driven, mapped = driven_robots(drive, output / "robot", town_scans, town_columns)
        if seconds is not None:
            scans = max(1, round(seconds / period_of(driven)))
        with on_cores(cores):
            report = measure_robot(
                driven,
                mapped,
                model_folder(model or DEFAULT_MODEL),
                scans=scans,
                localize_every=localize_every,
                seed=seed,
                progress=show,
            )
        write_json(report | {"source": drive}, json_file)
    print_steps(report)


def driven_robots(
    text: str, folder: Path, scans: int, columns: int | None
) -> "tuple[Drive, Robot | None]":
    """Open or simulate the drive; return it and, in a town, the robot that made the map."""
    from placecell.datasets import open_drive

    if not text.startswith("town:"):
        return open_drive(Path(text)), None
    import numpy as np

    import town
    from evaluation.poses.robot import Robot
    from placecell.core.parameters import PROTOCOL_V1
    from placecell.segmentation.pipeline import record

    seed, sensor, place = parse_town(text)
    name = folder / f"{place}-{seed}-{sensor}-{columns or 'own'}-{scans}"
    driven, other = name / "robot_a", name / "robot_b"
    if not (driven.exists() and other.exists()):
        driven, other = town.two_robots(
            name,
            seed=seed,
            scans=scans,
            place=place,
            lidar=town.sensor(sensor),
            columns=columns,
            overwrite=True,
            progress=show,
        )
    there = open_drive(other)
    recording = record(there, PROTOCOL_V1.for_drive(len(there)), progress=show)
    return open_drive(driven), Robot("robot B", there, [recording], np.eye(4))


def print_steps(report: dict[str, Any]) -> None:
    """Print the figures as a table."""
    table = new_table(
        "step",
        *("p50, ms", "p99, ms", "CPU p50, ms", "CPU p99, ms"),
        title=f"{report['drive']}: {report['points_a_scan']:,} points a scan, "
        f"{report['segments_a_scan']} segments, {report['scans']:,} scans, "
        f"{report['cores']} core(s)",
    )
    keys = ("p50_ms", "p99_ms", "cpu_p50_ms", "cpu_p99_ms")
    sums = {
        f"scan to {goal}": {key: report[f"scan_to_{goal}_{key}"] for key in keys}
        for goal in ("segments", "pose")
    }
    batch = {"batch pipeline, scan to segments": report["batch"]}
    for name, row in {**report["rows"], **sums, **batch}.items():
        if "not_measured" in row:
            table.add_row(name, "-", "-", "-", "-")
        else:
            table.add_row(name, *(f"{row[key]:.1f}" for key in keys))
    print_tables(table)
    typer.echo(
        f"batch / incremental {report['batch_ratio']:.1f} (CPU, p50); localized "
        f"{report['localized']:.0%}; {report['scans_dropped']} scans dropped at a period of "
        f"{report['period_ms']:g} ms; peak memory {report['peak_mb']:,.0f} MB"
    )
