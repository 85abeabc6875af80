"""`placecell maps restore`, `compact`, `age` and `delete`: a map's past and its end."""

from datetime import datetime
from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service


def restore(
    name: Name,
    version: Annotated[int, typer.Argument(min=1, help="As 'placecell maps show' lists them.")],
    url: Url = LOCAL,
) -> None:
    """Make a map again what it was. That is a new version: it can be undone the same way."""
    with service(url) as client:
        done = client.restore_map(name, version)
        typer.echo(f"{name}: {done.segments:,} segments as in version {version}, "
                   f"now version {done.sequence}")  # fmt: skip


def compact(
    name: Name,
    keep: Annotated[int, typer.Option(min=1, help="Versions to keep, the newest.")] = 1,
    url: Url = LOCAL,
) -> None:
    """Let go of old versions; the room is given back to the disk."""
    with service(url) as client:
        typer.echo(f"{name}: version {client.compact_map(name, keep)} is the oldest now")


def age(
    name: Name,
    unseen_since: Annotated[
        datetime, typer.Option(help="Segments that were last seen before then go; local time.")
    ],
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only tell how many.")] = False,
    url: Url = LOCAL,
) -> None:
    """Remove what was not seen again for long."""
    with service(url) as client:
        done = client.age_map(name, unseen_since.timestamp(), dry_run)
        would = "would go" if dry_run else "removed"
        typer.echo(f"{name}: {done.removed:,} segments {would}")


def delete(
    name: Name,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    url: Url = LOCAL,
) -> None:
    """Remove a map with all its versions."""
    if not yes:
        typer.confirm(f"Remove {name} and all its versions for good?", abort=True)
    with service(url) as client:
        client.delete_map(name)
        typer.echo(f"{name} is gone")
