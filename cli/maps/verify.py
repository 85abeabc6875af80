"""`placecell maps verify`: checks map files, delta files and a stopped service's data folder."""

from pathlib import Path
from typing import Annotated

import typer

from cli.maps.local_files import is_delta
from cli.sources import clear_errors, fail
from cli.tables import JsonFlag, print_json


def verify(
    paths: Annotated[
        list[Path],
        typer.Argument(help="Map files, delta files, or the data folder of a stopped service."),
    ],
    as_json: JsonFlag = False,
) -> None:
    """Check that files and stored maps are intact; the command ends with status 1 if one is not."""
    from placecell_client import MapFileError, decode, decode_delta

    files = []
    for path in paths:
        with clear_errors():
            faults = []
            if path.is_dir():
                faults = _faults_of_store(path)
            else:
                data = path.read_bytes()
                try:
                    (decode_delta if is_delta(data) else decode)(data)
                except MapFileError as error:
                    faults = [str(error)]
        files.append({"path": str(path), "whole": not faults, "faults": faults})
        for line in [] if as_json else faults or ["intact"]:
            typer.echo(f"{path}: {line}")
    if as_json:
        print_json({"files": files})
    if not all(file["whole"] for file in files):
        raise typer.Exit(1)


def _faults_of_store(data_dir: Path) -> list[str]:
    from service.maps.sqlite.store import FILE, SqliteMapStore
    from service.maps.store import StoreError, StoreLockedError

    if not (data_dir / FILE).is_file():
        raise ValueError(f"{data_dir} holds no {FILE}. Expected the data folder of a service.")
    try:
        with SqliteMapStore.owned(data_dir) as store:
            return store.verify()
    except StoreLockedError as error:
        fail(f"{error}. Stop the service first.")
    except StoreError as error:
        return [str(error)]
