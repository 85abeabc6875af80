"""`placecell maps restore`: restores an old version of a map."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def restore(
    name: Name,
    version: Annotated[int, typer.Argument(min=1, help="Version number, from 'maps show'.")],
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Restore an old version of a map as its new version; restore the previous one to undo it."""
    with service(url) as client:
        done = client.restore_map(name, version)
    if as_json:
        facts = {"segments": done.segments, "version": done.sequence, "etag": done.etag}
        print_json({"map": name, "restored": version} | facts)
    else:
        typer.echo(
            f"Map {name} has {done.segments:,} segments as in version {version}; "
            f"this is now version {done.sequence}."
        )
