"""`placecell maps push`: stores a map file, or applies a delta file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.maps.connection import LOCAL, Url, service
from cli.maps.local_files import etag_file, is_delta
from cli.tables import JsonFlag, print_json

if TYPE_CHECKING:
    from placecell_client import MapSummary, Written


def push(
    file: Annotated[Path, typer.Argument(help="Map file or delta file.")],
    name: Annotated[
        str, typer.Argument(metavar="[MAP]", help="Name of the map. (default: the file's name)")
    ] = "",
    replace: Annotated[
        bool,
        typer.Option("--replace", help="Replace the stored map, or segments of other robots."),
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Store a map file, or apply a delta file; the command returns when the data is on disk.

    An existing map is replaced only if its newest version is the one in FILE.etag, which 'pull'
    wrote, or with --replace. The same holds for a delta file that changes segments of other robots.
    A map file that is larger than the service's request limit is sent in parts. Repeat the command
    to continue an interrupted push with the next part.
    """
    with service(url) as client:
        beside = etag_file(file)
        seen = beside.read_text(encoding="utf-8").strip() if beside.is_file() else None
        if_match = "*" if replace else seen
        name, data = name or file.stem, file.read_bytes()
        stored: MapSummary | Written
        done: dict[str, Any] = {"map": name}
        if is_delta(data):
            stored = client.edit_map(name, data, if_match=if_match)
            done |= {"changed": stored.changed, "removed": stored.removed}
        else:
            stored = client.put_map(name, data, if_match=if_match)
        if seen is not None:
            beside.write_text(f"{stored.etag}\n", encoding="utf-8")
    done |= {"segments": stored.segments, "version": stored.sequence, "etag": stored.etag}
    if as_json:
        print_json(done)
        return
    if "changed" in done:
        typer.echo(f"The delta: {done['changed']:,} changed, {done['removed']:,} removed segments.")
    typer.echo(f"Map {name} has {stored.segments:,} segments, version {stored.sequence}.")
