"""`placecell backup`, `restore` and `migrate`: copies of all maps, and moves between stores."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from cli.sources import clear_errors, fail
from cli.tables import JsonFlag, print_json, progress_console

Database = Annotated[
    str | None,
    typer.Option(
        metavar="DATABASE",
        help="Data directory of a service, or postgresql://HOST/DATABASE. (default: the one of the "
        "service's settings)",
    ),
]
Endpoint = Annotated[
    str | None,
    typer.Option(
        help="Address of the service that speaks S3, such as http://minio:9000. (default: Amazon "
        "S3, or AWS_ENDPOINT_URL)"
    ),
]


def backup(
    target: Annotated[str, typer.Argument(metavar="TARGET", help="Folder, or s3://BUCKET/PREFIX.")],
    database: Database = None,
    endpoint_url: Endpoint = None,
    as_json: JsonFlag = False,
) -> None:
    """Back up all maps with all versions, tags, anchors and ids, also while the service runs.

    A second backup to the same target writes only what is new, and replaces the first when it is
    complete. A killed backup leaves the previous one as it was.
    """
    with _explained():
        from service.backup.counting import CountedSnapshot
        from service.backup.databases import reading
        from service.backup.targets import target_at
        from service.backup.writing import BackupWriter
        from service.core.version import version

        writer = BackupWriter(target_at(target, endpoint_url))
        with reading(_database(database)) as source, _progress("Back up") as (total, add):
            total(sum(head.bytes for head in source.heads()))
            manifest = writer.write(CountedSnapshot(source, add), version(), time.time())
    stored = sum(manifest.objects.values())
    if as_json:
        maps = [{"name": each.name, "etag": each.etag} for each in manifest.maps]
        print_json({"maps": maps, "bytes": stored, "new_bytes": writer.new_bytes})
    else:
        typer.echo(
            f"Backed up {len(manifest.maps)} maps to {target}: {stored:,} bytes, "
            f"{writer.new_bytes:,} of them new."
        )


def restore(
    source: Annotated[
        str,
        typer.Argument(metavar="SOURCE", help="Folder or s3://BUCKET/PREFIX that holds a backup."),
    ],
    database: Database = None,
    replace: Annotated[
        bool, typer.Option("--replace", help="Remove all maps that the store has now.")
    ] = False,
    verify: Annotated[
        bool,
        typer.Option("--verify", help="Read and check the whole backup, and restore nothing."),
    ] = False,
    endpoint_url: Endpoint = None,
    as_json: JsonFlag = False,
) -> None:
    """Restore all maps of a backup in one transaction, into SQLite or PostgreSQL.

    Stop the service first. A killed restore leaves the store as it was. The service gives out no
    id twice: it skips 4,194,304 ids of each map, or fewer if it knows which ids it gave out.
    """
    with _explained():
        from service.backup.counting import CountedSnapshot
        from service.backup.databases import writing
        from service.backup.reading import BackupSnapshot
        from service.backup.targets import target_at
        from service.maps.sqlite.id_ledger import SKIPPED

        found = BackupSnapshot(target_at(source, endpoint_url))
        manifest = found.manifest
        with _progress("Check" if verify else "Restore") as (total, add):
            total(sum(each.bytes for each in manifest.maps))
            counted = CountedSnapshot(found, add)
            faults = []
            if verify:
                faults = found.faults(add)
            else:
                with writing(_database(database)) as store:
                    if store.heads() and not replace:
                        fail(
                            "The store has maps. Use --replace to remove them, or --database to "
                            "name an empty store. Nothing was changed."
                        )
                    store.import_maps(counted, SKIPPED, replaces=replace)
    names = [each.name for each in manifest.maps]
    created = time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(manifest.created))
    if as_json:
        print_json(
            {
                "maps": names,
                "created": manifest.created,
                "restored": not verify,
                "whole": not faults,
                "faults": faults,
            }
        )
    else:
        for line in faults:
            typer.echo(line)
        done = "Checked" if verify else "Restored"
        typer.echo(f"{done} {len(names)} maps of the backup of {created}: {len(faults)} errors.")
    if faults:
        raise typer.Exit(1)


def migrate(
    source: Annotated[
        str,
        typer.Option(
            "--from", metavar="DATABASE", help="Store to read; it stays. No service may use it."
        ),
    ],
    target: Annotated[str, typer.Option("--to", metavar="DATABASE", help="Empty store to fill.")],
    as_json: JsonFlag = False,
) -> None:
    """Move all maps from one store to another, and compare every version, ETag and byte.

    A DATABASE is the data directory of a service, or postgresql://HOST/DATABASE. The password of
    PostgreSQL can be in PGPASSWORD or in ~/.pgpass. A killed command leaves the target empty or
    complete; repeat it.
    """
    with _explained():
        from service.backup import migration

        with _progress("Migrate") as (total, add):
            heads = migration.migrate(source, target, total, add)
    if as_json:
        print_json({"maps": [head.name for head in heads]})
    else:
        typer.echo(
            f"Moved and compared {len(heads)} maps. All versions, ETags and bytes are equal."
        )


def _database(named: str | None) -> str:
    from service.backup.databases import database_of
    from service.core.settings import Settings

    return database_of(Settings()) if named is None else named


@contextmanager
def _explained() -> Iterator[None]:
    """Show errors of stores, backups and S3 as one line."""
    from service.maps.store import StoreError, StoreLockedError

    with clear_errors():
        try:
            yield
        except StoreLockedError as error:
            fail(f"{error}. Nothing was changed.")
        except StoreError as error:
            fail(error)


@contextmanager
def _progress(title: str) -> Iterator[tuple[Callable[[int], None], Callable[[int], None]]]:
    """Show a progress bar in bytes; yield functions that set the total and add to it."""
    from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn(title), BarColumn(), DownloadColumn(), TimeRemainingColumn()
    with Progress(*columns, console=progress_console(), transient=True) as progress:
        task = progress.add_task(title)
        yield (
            lambda total: progress.update(task, total=total),
            lambda count: progress.advance(task, count),
        )
