"""`placecell maps tag`: shows or replaces the tags of a map."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.sources import fail
from cli.tables import JsonFlag, print_json


def tag(
    name: Name,
    tags: Annotated[
        list[str] | None,
        typer.Argument(metavar="[TAG]...", help="New tags. Without any, the tags are shown."),
    ] = None,
    clear: Annotated[bool, typer.Option("--clear", help="Remove all tags.")] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Replace the tags of a map, or show them; requests select maps by their tags."""
    if clear and tags:
        fail("--clear removes all tags. Give either --clear or the new tags.")
    with service(url) as client:
        found = client.set_tags(name, tags or []) if tags or clear else client.tags(name)
    if as_json:
        print_json({"map": name, "tags": list(found)})
    else:
        typer.echo(f"Map {name}: {', '.join(found) or 'no tags'}")
