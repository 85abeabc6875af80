"""`placecell bench peers`: measures other systems on the same scans."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, write_json
from cli.outputs import output_folder
from cli.sources import clear_errors, show
from cli.tables import new_table, percent, print_tables

DEFAULT_PYTHON = Path(".venv-peers/bin/python")


def peers(
    map_drive: Annotated[Path, typer.Argument(help="Drive for the map.")],
    query_drive: Annotated[
        Path | None,
        typer.Argument(
            help="Drive for the queries, in a known common frame, as from "
            "'placecell town'. (default: alternate blocks of MAP_DRIVE)"
        ),
    ] = None,
    peer: Annotated[
        list[str] | None, typer.Option(help="Name of the other system; repeatable. (default: all)")
    ] = None,
    json_file: JsonFile = None,
    radius: Annotated[
        float | None,
        typer.Option(
            min=10.0,
            help="Radius of Placecell's local maps, meters. (default: that of the segmentation)",
        ),
    ] = None,
    queries: Annotated[
        int | None,
        typer.Option(min=1, help="Number of queries, spread evenly. (default: all captures)"),
    ] = None,
    refine: Annotated[
        bool, typer.Option(help="Also measure poses that generalized ICP refined.")
    ] = True,
    choose: Annotated[
        bool,
        typer.Option(
            "--choose",
            help="Measure all variants of each system instead of the chosen one. Use drives that "
            "you do not report.",
        ),
    ] = False,
    python: Annotated[
        Path,
        typer.Option(help="Python interpreter of the other systems; 'make peers' installs it."),
    ] = DEFAULT_PYTHON,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the local maps and the results.",
        ),
    ] = Path("out/peers"),
    seed: Annotated[int, typer.Option(help="Random seed for the queries' headings.")] = 0,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Continue a stopped run with the same options: reuse its local maps and the "
            "results of the systems that had finished.",
        ),
    ] = False,
) -> None:
    """Measure other systems: MapClosures, KISS-SLAM, KISS-Matcher, Scan Context, FPFH with FGR.

    They get local maps of the same scans that Placecell segments, with the length and range that
    their authors recommend. Each query is rotated by a random angle.
    The systems run in their own Python environment. Times are from the points of a local map to
    the pose; on a busy machine trust the ratios. The local maps take 0.9 GB per kilometer.
    """
    from benchmarks.peers.compare import compare_peers
    from benchmarks.peers.runner import PEERS

    with clear_errors():
        names = list(peer or PEERS)
        if unknown := [name for name in names if name not in PEERS]:
            raise ValueError(f"unknown peer {unknown[0]!r}; expected one of {', '.join(PEERS)}")
        mapped, asking = stretches(map_drive, query_drive, radius)
        report = compare_peers(
            mapped,
            asking,
            names,
            python,
            output,
            refine=refine,
            most=queries,
            seed=seed,
            resume=resume,
            choose=choose,
            progress=show,
        )
        write_json(report, json_file)
    print_rows(report)


def stretches(map_drive: Path, query_drive: Path | None, radius: float | None) -> Any:
    """Return the stretch of the map and the stretch of the queries."""
    import numpy as np

    from benchmarks.peers.frames import stretches_of_one, stretches_of_two
    from evaluation.poses.queries import to_common
    from placecell.datasets import open_drive

    mapped = open_drive(map_drive)
    if query_drive is None:
        return stretches_of_one(mapped, radius)
    asking = open_drive(query_drive)
    to_map = np.linalg.inv(to_common(mapped)) @ to_common(asking)
    return stretches_of_two(mapped, asking, to_map, radius)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    typer.echo(
        f"{report['rows'][0]['queries']} queries of {report['query_drive']} in a map of "
        f"{report['map_frames']} captures of {report['map_drive']}; Placecell's local maps: "
        f"{report['accumulated_scans']} scans, radius {report['local_map_radius']:.0f} m"
    )
    table = new_table("", "right", "wrong", "not localized", "m", "deg", "p50 ms", "p99 ms")
    for row in report["rows"]:
        table.add_row(
            row["name"],
            *(percent(row[key]) for key in ("localised_right", "wrong_but_sure", "not_localised")),
            *(
                "-" if row[key] is None else f"{row[key]:.2f}"
                for key in ("median_position_error_m", "median_yaw_error_deg")
            ),
            f"{row['p50_ms']:.0f}",
            f"{row['p99_ms']:.0f}",
        )
    print_tables(table)
