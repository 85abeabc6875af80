"""`placecell maps reset-ids`: frees segment ids that no kept version of a map uses."""

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def reset_ids(name: Name, as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """Free segment ids that no kept version of the map uses; this needs an admin key.

    Ids that robots have reserved are freed too. Run 'maps compact' first to free the ids of removed
    segments.
    """
    with service(url) as client:
        free = client.reset_ids(name)
    if as_json:
        print_json({"map": name, "first": free.start, "count": len(free)})
    else:
        typer.echo(f"Map {name} has {len(free):,} free ids from {free.start:,} on.")
