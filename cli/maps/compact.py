"""`placecell maps compact`: drops old versions of a map."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def compact(
    name: Name,
    keep: Annotated[int, typer.Option(min=1, help="Number of newest versions to keep.")] = 1,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Drop old versions of a map and free their disk space."""
    with service(url) as client:
        oldest = client.compact_map(name, keep)
    if as_json:
        print_json({"map": name, "oldest": oldest})
    else:
        typer.echo(f"Version {oldest} is now the oldest version of map {name}.")
