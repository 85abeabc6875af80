"""`placecell maps uploads`: lists or removes unfinished uploads of large map files."""

from datetime import datetime
from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def uploads(
    name: Name,
    remove: Annotated[
        bool, typer.Option("--remove", help="Remove the unfinished uploads; the map is unchanged.")
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """List unfinished uploads of large map files and the bytes that the service has received.

    A repeated push continues its upload. The service removes an upload one day after its last part.
    """
    with service(url) as client:
        found = client.uploads(name)
        for each in found if remove else ():
            client.delete_upload(name, each.digest)
    if as_json:
        facts = [{"sha256": each.digest, "bytes": each.bytes, "time": each.time} for each in found]
        print_json({"map": name, "uploads": facts, "removed": remove})
        return
    for each in found:
        when = datetime.fromtimestamp(each.time).isoformat(" ", "seconds")
        suffix = ", removed" if remove else ""
        typer.echo(f"Upload {each.digest}: {each.bytes:,} bytes, last part at {when}{suffix}")
    if not found:
        typer.echo(f"Map {name} has no unfinished uploads.")
