"""`placecell bench read`: measures how fast clouds are read from files."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors
from cli.tables import new_table, print_tables


def read(
    json_file: JsonFile = None,
    clouds: Annotated[int, typer.Option(min=2, help="Number of clouds in each file.")] = 40,
    repeats: Annotated[int, typer.Option(min=1, help="Measurements of each reader.")] = 5,
    seed: Drawn = 7,
) -> None:
    """Measure clouds of 120,000 points a second, from file to array, on one core.

    The files are a ROS 1 bag, a rosbag2 folder, MCAP files, PCD files and .bin files. kiss-icp's
    loaders read the same files in the same run, where they can.
    """
    from benchmarks.load.reading import measure_reading, one_core

    with clear_errors(), one_core():
        report = measure_reading(clouds, repeats, seed)
        write_json(report, json_file)
    table = new_table("format", "clouds a second", "kiss-icp", "ratio")
    for name, row in report["rows"].items():
        theirs = row["kiss_icp"].get("clouds_per_second", row["kiss_icp"].get("failed"))
        ours = row["placecell"]["clouds_per_second"]
        table.add_row(name, f"{ours:g}", f"{theirs}", f"{row.get('ratio', '-')}")
    print_tables(table)
