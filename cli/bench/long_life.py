"""`placecell bench long-life`: finds what is gone on another day, and compares with the truth."""

from pathlib import Path
from typing import Annotated

import typer

from cli.bench.options import JsonFile, write_json
from cli.drive_options import tell
from cli.outputs import output_folder
from cli.sources import clear_errors
from cli.tables import new_table, print_tables


def long_life(
    seed: Annotated[
        list[int] | None, typer.Option(help="Seed of a town. Repeatable. (default: 7, 205)")
    ] = None,
    sensor: Annotated[
        list[str] | None,
        typer.Option(help="Name of a sensor. Repeatable. (default: hdl-64e, vlp-16, os1-64)"),
    ] = None,
    scans: Annotated[int, typer.Option(min=10, help="Number of scans of each drive.")] = 120,
    cache: Annotated[
        Path,
        typer.Option(
            metavar="FOLDER",
            callback=output_folder,
            help="Folder where segments of drives are kept.",
        ),
    ] = Path("out/long-life"),
    json_file: JsonFile = None,
) -> None:
    """Measure which segments another day confirms, and which it finds absent.

    A robot drives the same way through a simulated town on two days. All parked cars and people
    have changed in between, and nothing else. So it is known which segments of the first day are
    gone. The map of the second day is also moved by some decimeters. Precision is the share of
    right verdicts. Recall is a share of the segments that the second day looked at.
    """
    from benchmarks.drift.long_life import LongLifePlan, run_long_life

    with clear_errors():
        plan = LongLifePlan(
            seed or [7, 205], sensor or ["hdl-64e", "vlp-16", "os1-64"], scans, cache
        )
        report = run_long_life(plan, tell)
        write_json(report, json_file)
    table = new_table(
        "town", "sensor", "off", "gone", "absent", "recall", "stays", "confirmed", "recall"
    )
    for row in report["rows"]:
        keys = ("absent_precision", "absent_recall", "confirmed_precision", "confirmed_recall")
        shares = ["-" if row[key] is None else f"{row[key]:.1%}" for key in keys]
        where = str(row["town"]), row["sensor"], f"{row['offset_m']} m"
        table.add_row(*where, str(row["gone"]), *shares[:2], str(row["stays"]), *shares[2:])
    print_tables(table)
