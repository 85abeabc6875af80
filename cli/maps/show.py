"""`placecell maps show`: shows the versions and sources of a map."""

from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.outputs import picture_file
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import CompactMap, MapSummary


def show(
    name: Name,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", callback=picture_file, help="PNG file for a top view of the map."
        ),
    ] = None,
    limit: Annotated[int, typer.Option(min=1, help="Largest number of versions to list.")] = 20,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Show a map's versions, newest first, and the maps that were merged into it."""
    with service(url) as client:
        versions = list(client.versions(name, limit))
        summary = next((one for one in client.maps() if one.name == name), None)
        if plot:
            draw(client.get_map(name), plot)
    if as_json:
        about = None if summary is None else asdict(summary)
        print_json({"map": about, "versions": [asdict(one) for one in versions]})
        return
    table = new_table("version", "time (UTC)", "author", "operation", "changed", "removed")
    for one in versions:
        when = datetime.fromtimestamp(one.time, UTC).strftime("%Y-%m-%d %H:%M:%S")
        counts = f"{one.changed:,}", f"{one.removed:,}"
        table.add_row(str(one.sequence), when, one.author, one.operation, *counts)
    print_tables(table)
    if summary is not None and summary.sources:
        typer.echo(_sources(summary))


def _sources(summary: "MapSummary") -> str:
    merged = (f"{count:,} from {source}" for source, count in summary.sources.items())
    return f"{summary.segments:,} segments, merged from other maps: {', '.join(merged)}"


def draw(compact_map: "CompactMap", file: Path) -> None:
    """Draw a map from above into a PNG file, each robot in its own color."""
    from evaluation.figure import figure

    with figure(file, size=7) as (axes,):
        for index, robot in enumerate(compact_map.robots):
            x, y, _ = compact_map.centroids[compact_map.robot == index].T
            axes.plot(x, y, ".", markersize=2, label=f"{robot}: {len(x):,} segments")
        axes.plot(*compact_map.frame_positions[:, :2].T, "k,", label="sensor")
        axes.set(aspect="equal", xlabel="x, meters", ylabel="y, meters")
        axes.legend(loc="best", fontsize=8)
