"""`placecell maps list`, `show` and `verify`: what there is, and whether it is whole."""

from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, is_delta, service
from cli.sources import clear_errors, fail
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import CompactMap, MapSummary


def list_maps(as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """List the maps, and whose segments they hold; and those that are damaged."""
    with service(url) as client:
        stored = client.maps()
    if as_json:
        print_json({"maps": [asdict(one) for one in stored], "damaged": stored.damaged})
        return
    table = new_table("map", "segments", "version", "kB", "robots", "model")
    for one in stored:
        robots = ", ".join(f"{robot} {count:,}" for robot, count in one.robots.items())
        size = f"{one.bytes / 1000:,.0f}"
        table.add_row(one.name, f"{one.segments:,}", str(one.sequence), size, robots, one.model_id)
    print_tables(table)
    for damaged in stored.damaged:
        typer.echo(f"{damaged} is damaged and not served; the service's log says how", err=True)


def show(
    name: Name,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it from above into this PNG.")
    ] = None,
    limit: Annotated[int, typer.Option(min=1, help="Versions to list, at most.")] = 20,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Show a map's versions, newest first: who did what, when; and what was merged into it."""
    with service(url) as client:
        versions = list(client.versions(name, limit))
        summary = next((one for one in client.maps() if one.name == name), None)
        if plot:
            draw(client.get_map(name), plot)
    if as_json:
        about = None if summary is None else asdict(summary)
        print_json({"map": about, "versions": [asdict(one) for one in versions]})
        return
    table = new_table("version", "when (UTC)", "who", "what", "changed", "removed")
    for one in versions:
        when = datetime.fromtimestamp(one.time, UTC).strftime("%Y-%m-%d %H:%M:%S")
        counts = f"{one.changed:,}", f"{one.removed:,}"
        table.add_row(str(one.sequence), when, one.author, one.operation, *counts)
    print_tables(table)
    if summary is not None and summary.sources:
        typer.echo(_whence(summary))


def _whence(summary: "MapSummary") -> str:
    merged = (f"{count:,} from {source}" for source, count in summary.sources.items())
    return f"{summary.segments:,} segments, of these merged: {', '.join(merged)}"


def draw(compact_map: "CompactMap", file: Path) -> None:
    """A map from above, each robot in a colour, as a PNG."""
    from evaluation.figure import figure

    with figure(file, size=7) as (axes,):
        for index, robot in enumerate(compact_map.robots):
            x, y, _ = compact_map.centroids[compact_map.robot == index].T
            axes.plot(x, y, ".", markersize=2, label=f"{robot}: {len(x):,} segments")
        axes.plot(*compact_map.frame_positions[:, :2].T, "k,", label="sensor")
        axes.set(aspect="equal", xlabel="x, metres", ylabel="y, metres")
        axes.legend(loc="best", fontsize=8)


def verify(
    paths: Annotated[
        list[Path],
        typer.Argument(help="Map files, delta files, or the data folder of a stopped service."),
    ],
    as_json: JsonFlag = False,
) -> None:
    """See whether files and stored maps are whole; ends with status 1 if one is not."""
    from placecell_client import MapFileError, decode, decode_delta

    files = []
    for path in paths:
        with clear_errors():
            found = []
            if path.is_dir():
                found = _wrong_with(path)
            else:
                data = path.read_bytes()
                try:
                    (decode_delta if is_delta(data) else decode)(data)
                except MapFileError as error:
                    found = [str(error)]
        files.append({"path": str(path), "whole": not found, "faults": found})
        for wrong in [] if as_json else found or ["whole"]:
            typer.echo(f"{path}: {wrong}")
    if as_json:
        print_json({"files": files})
    if not all(file["whole"] for file in files):
        raise typer.Exit(1)


def _wrong_with(data_dir: Path) -> list[str]:
    from service.maps.sqlite.store import FILE, SqliteMapStore
    from service.maps.store import StoreError, StoreLockedError

    if not (data_dir / FILE).is_file():
        raise ValueError(f"{data_dir}: holds no {FILE}")
    try:
        with SqliteMapStore.owned(data_dir) as store:
            return store.verify()
    except StoreLockedError as error:
        fail(f"{error}: stop it first")
    except StoreError as error:
        return [str(error)]
