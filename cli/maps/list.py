"""`placecell maps list`: lists the maps of a service."""

from dataclasses import asdict

import typer

from cli.maps.connection import LOCAL, Url, service
from cli.tables import JsonFlag, new_table, print_json, print_tables


def list_maps(as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """List the maps of the service, with their segments per robot, and the damaged maps."""
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
        typer.echo(
            f"Map {damaged} is damaged and not served. The service's log names the fault.", err=True
        )
