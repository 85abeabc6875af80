"""`placecell maps restore`, `compact`, `age`, `delete`, `reset-ids`: a map's past and end."""

from datetime import datetime
from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.tables import JsonFlag, print_json


def restore(
    name: Name,
    version: Annotated[int, typer.Argument(min=1, help="As 'placecell maps show' lists them.")],
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Make a map again what it was. That is a new version: it can be undone the same way."""
    with service(url) as client:
        done = client.restore_map(name, version)
    if as_json:
        facts = {"segments": done.segments, "version": done.sequence, "etag": done.etag}
        print_json({"map": name, "restored": version} | facts)
    else:
        typer.echo(
            f"{name}: {done.segments:,} segments as in version {version}, "
            f"now version {done.sequence}"
        )


def compact(
    name: Name,
    keep: Annotated[int, typer.Option(min=1, help="Versions to keep, the newest.")] = 1,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Let go of old versions; the room is given back to the disk."""
    with service(url) as client:
        oldest = client.compact_map(name, keep)
    if as_json:
        print_json({"map": name, "oldest": oldest})
    else:
        typer.echo(f"{name}: version {oldest} is the oldest now")


def age(
    name: Name,
    unseen_since: Annotated[
        datetime, typer.Option(help="Segments that were last seen before then go; local time.")
    ],
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only tell how many.")] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Remove what was not seen again for long."""
    with service(url) as client:
        done = client.age_map(name, unseen_since.timestamp(), dry_run)
    if as_json:
        print_json({"map": name, "removed": done.removed, "dry_run": dry_run})
    else:
        typer.echo(f"{name}: {done.removed:,} segments {'would go' if dry_run else 'removed'}")


def delete(
    name: Name,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Remove a map with all its versions."""
    if not yes:
        typer.confirm(f"Remove {name} and all its versions for good?", abort=True)
    with service(url) as client:
        client.delete_map(name)
    if as_json:
        print_json({"map": name, "deleted": True})
    else:
        typer.echo(f"{name} is gone")


def reset_ids(name: Name, as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """Make ids free again that no kept version of the map has; needs an administrator's key.

    Reservations of ids are given up. Compact the map first to free ids of removed segments.
    """
    with service(url) as client:
        free = client.reset_ids(name)
    if as_json:
        print_json({"map": name, "first": free.start, "count": len(free)})
    else:
        typer.echo(f"{name}: {len(free):,} ids from {free.start:,} on are free")
