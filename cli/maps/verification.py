"""`placecell maps verify`: files, or the data directory of a service that does not run."""

from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors


def verify(
    paths: Annotated[
        list[Path],
        typer.Argument(help="Map files, delta files, or a service's data directory."),
    ],
) -> None:
    """Read all of it, and tell what is damaged. Ends with status 1 if anything is.

    A data directory must not be in use: stop its service, or verify a copy.
    """
    with clear_errors():
        wrong = 0
        for path in paths:
            found = _directory(path) if path.is_dir() else _file(path)
            for fault in found:
                typer.echo(f"{path}: {fault}")
            wrong += len(found)
            if not found:
                typer.echo(f"{path}: good")
    raise typer.Exit(1 if wrong else 0)


def _file(path: Path) -> list[str]:
    from placecell_client import MapFileError, decode, decode_delta

    data = path.read_bytes()
    try:
        decode(data)
    except MapFileError as not_a_map:
        try:
            decode_delta(data)
        except MapFileError as not_a_delta:
            return [f"{not_a_map}; {not_a_delta}"]
    return []


def _directory(path: Path) -> list[str]:
    from placecell_client import MapFileError

    from service.map_store import StoreError, StoreLockedError
    from service.replay import version_of
    from service.sqlite_store import FILE, SqliteMapStore

    if not (path / FILE).exists():
        raise ValueError(f"{path}: has no {FILE}, so it is no data directory")
    try:
        with SqliteMapStore.owned(path) as store:
            found = store.verify()
            for head in store.heads():
                try:
                    with store.read(head.uid) as history:
                        version_of(history, head.sequence)
                except (StoreError, MapFileError) as error:
                    found.append(str(error))
            return list(dict.fromkeys(found))
    except (StoreError, StoreLockedError) as error:
        return [str(error)]
