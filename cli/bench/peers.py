"""`placecell bench peers`: other systems on the scans that ours is measured on."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables

DEFAULT_PYTHON = Path(".venv-peers/bin/python")


def peers(
    map_drive: Annotated[Path, typer.Argument(help="A drive's folder: the map.")],
    query_drive: Annotated[
        Path | None,
        typer.Argument(
            help="The drive that asks, in a frame known to both ('placecell town' makes such "
            "pairs). (default: the map's own, by alternate blocks)"
        ),
    ] = None,
    peer: Annotated[
        list[str] | None, typer.Option(help="A peer's name; may be repeated. (default: all)")
    ] = None,
    json_file: JsonFile = None,
    radius: Annotated[
        float | None,
        typer.Option(
            min=10.0, help="Of the local maps, metres. (default: as our segments are cut from)"
        ),
    ] = None,
    queries: Annotated[
        int | None, typer.Option(min=1, help="So many, spread evenly. (default: all frames)")
    ] = None,
    refine: Annotated[
        bool, typer.Option(help="Also with poses refined by generalised ICP.")
    ] = True,
    python: Annotated[
        Path, typer.Option(help="Interpreter of the peers' environment: make peers.")
    ] = DEFAULT_PYTHON,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the local maps and the answers.")
    ] = Path("out/peers"),
    seed: Annotated[int, typer.Option(help="Of the queries' headings.")] = 0,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Go on with what a stopped run of the same words left in the folder: its local "
            "maps, and the answers of the peers that had finished.",
        ),
    ] = False,
) -> None:
    """Measure other systems: MapClosures, KISS-Matcher, Scan Context.

    They see the local maps that our segments are cut from, each query turned by a random angle,
    and answer in an environment of their own. Times are from a local map's points to the pose, on
    this machine as busy as it is: believe their ratios. A kilometre takes 0.9 GB for local maps.
    """
    from benchmarks.peers.compare import compare_peers
    from benchmarks.peers.runner import PEERS

    with clear_errors():
        names = list(peer or PEERS)
        if unknown := [name for name in names if name not in PEERS]:
            raise ValueError(f"no peer {unknown[0]!r}; there are {', '.join(PEERS)}")
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
            progress=show,
        )
        write_json(report, json_file)
    print_rows(report)


def stretches(map_drive: Path, query_drive: Path | None, radius: float | None) -> Any:
    """What makes the map, and what asks."""
    import numpy as np

    from benchmarks.peers.frames import stretches_of_one, stretches_of_two
    from evaluation.poses.queries import origin_of
    from placecell.datasets import open_drive

    mapped = open_drive(map_drive)
    if query_drive is None:
        return stretches_of_one(mapped, radius)
    asking = open_drive(query_drive)
    to_map = np.linalg.inv(origin_of(map_drive)) @ origin_of(query_drive)
    return stretches_of_two(mapped, asking, to_map, radius)


def print_rows(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    typer.echo(
        f"{report['rows'][0]['queries']} queries of {report['query_drive']} in a map of "
        f"{report['map_frames']} frames of {report['map_drive']}, {report['accumulated_scans']} "
        f"scans each, within {report['local_map_radius']:.0f} m"
    )
    table = new_table("", "right", "wrong", "unknown", "m", "deg", "p50 ms", "p99 ms")
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


def percent(value: float | None) -> str:
    """A share for people to read."""
    return "-" if value is None else f"{value:.1%}"
