"""`placecell maps delete`: deletes a map with all its versions."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def delete(
    name: Name,
    yes: Annotated[bool, typer.Option("--yes", help="Delete without asking.")] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Delete a map with all its versions; this cannot be undone."""
    if not yes:
        typer.confirm(f"Delete map {name} and all its versions permanently?", abort=True)
    with service(url) as client:
        client.delete_map(name)
    if as_json:
        print_json({"map": name, "deleted": True})
    else:
        typer.echo(f"Map {name} is deleted.")
