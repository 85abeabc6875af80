"""`placecell maps versions`, `restore`, `age` and `compact`."""

from typing import Annotated

import typer

from cli.maps.options import HERE, IfMatch, Key, Name, Url, moment, service


def versions(
    name: Name,
    limit: Annotated[int, typer.Option(min=1, help="So many, at most.")] = 20,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """List the versions of a map, newest first."""
    from rich.console import Console
    from rich.table import Table

    table = Table("version", "time (UTC)", "by", "operation", "changed", "removed", "ETag")
    with service(url, key) as client:
        for each in client.versions(name, limit):
            table.add_row(
                str(each.sequence),
                moment(each.time),
                each.author,
                each.operation,
                f"{each.changed:,}",
                f"{each.removed:,}",
                each.etag,
            )
    Console(width=max(Console().width, 110)).print(table)


def restore(
    name: Name,
    version: Annotated[int, typer.Argument(min=1, help="As 'versions' numbers them.")],
    if_match: IfMatch = None,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Make a map again what it was. That is a new version; restore the one before to undo it."""
    with service(url, key) as client:
        done = client.restore_map(name, version, if_match)
    typer.echo(
        f"{name}: as in version {version}; {done.changed} segments changed, {done.removed} "
        f"removed; version {done.sequence}"
    )


def age(
    name: Name,
    unseen_since: Annotated[
        float, typer.Option(metavar="SECONDS", help="Of the clock of the maps' frames.")
    ],
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only tell how many.")] = False,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Remove the segments that were last seen before a time. 'restore' brings them back."""
    with service(url, key) as client:
        done = client.age_map(name, unseen_since, dry_run)
    would = "would be " if dry_run else ""
    typer.echo(f"{name}: {done.removed:,} segments {would}removed; version {done.sequence}")


def compact(
    name: Name,
    keep: Annotated[int, typer.Option(min=1, help="Of the newest versions, so many.")] = 1,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Let go of old versions; that cannot be undone."""
    with service(url, key) as client:
        oldest = client.compact_map(name, keep)
    typer.echo(f"{name}: version {oldest} is the oldest now")
