"""`placecell maps prune`: removes segments that were not seen since a time."""

from datetime import datetime
from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def prune(
    name: Name,
    unseen_since: Annotated[
        datetime,
        typer.Option(
            help="Local time, such as 2026-11-01 or 2026-11-01T08:00; removes segments last seen "
            "before it."
        ),
    ],
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only count the segments; remove none.")
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Remove segments that no robot has seen since a time."""
    with service(url) as client:
        done = client.prune_map(name, unseen_since.timestamp(), dry_run)
    if as_json:
        print_json({"map": name, "removed": done.removed, "dry_run": dry_run})
    else:
        verb = "would be" if dry_run else "were"
        typer.echo(f"{done.removed:,} segments {verb} removed from map {name}.")
