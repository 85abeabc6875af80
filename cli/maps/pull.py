"""`placecell maps pull`: downloads a map, or updates a map file."""

from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import Classes, Ignore
from cli.maps.connection import LOCAL, Name, Url, service
from cli.maps.local_files import etag_file, replace_file
from cli.tables import JsonFlag, print_json


def pull(
    name: Name,
    file: Annotated[
        Path | None, typer.Argument(help="Map file to write or update. (default: MAP.map)")
    ] = None,
    version: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Earlier version to download, a number from 'maps show'; "
            "the default file is MAP@VERSION.map. (default: the newest)",
        ),
    ] = None,
    classes: Classes = None,
    ignore: Ignore = None,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Download a map, or update a map file; only changes since the file's version are transferred.

    The version is stored in FILE.etag for the next pull or push. An earlier version gets no
    FILE.etag, so that it cannot replace newer versions by mistake. With --classes or --ignore, the
    file is downloaded whole, and gets no FILE.etag either.
    """
    from placecell_client import MapCopy, decode, encode

    from placecell.core.segment_classes import ClassFilter

    with service(url) as client:
        if ClassFilter.of(classes, ignore or ()) is not None:
            target = file or Path(f"{name}.map" if version is None else f"{name}@{version}.map")
            if etag_file(target).exists():
                raise ValueError(
                    f"{target} is a copy of a whole map, as {etag_file(target)} says. Name another "
                    "file for the filtered map."
                )
            content = client.get_map_file(name, version, classes=classes, ignore=ignore)
            count = len(decode(content))
            replace_file(target, content)
            if as_json:
                print_json({"map": name, "file": str(target), "segments": count})
            else:
                typer.echo(f"{target} holds {count:,} segments of map {name}.")
            return
        if version is not None:
            target = file or Path(f"{name}@{version}.map")
            replace_file(target, client.get_map_file(name, version))
            if as_json:
                print_json({"map": name, "file": str(target), "version": version})
            else:
                typer.echo(f"{target} holds version {version} of map {name}.")
            return
        target = file or Path(f"{name}.map")
        beside, copy = etag_file(target), MapCopy(name)
        if target.is_file() and beside.is_file():
            copy = MapCopy(
                name, decode(target.read_bytes()), beside.read_text(encoding="utf-8").strip()
            )
        before = copy.sequence
        copy = client.pull(copy)
        assert copy.content is not None
        replace_file(target, encode(copy.content))
        beside.write_text(f"{copy.etag}\n", encoding="utf-8")
        count = len(copy.content)
        if as_json:
            versions = {"before": before, "version": copy.sequence, "etag": copy.etag}
            print_json({"map": name, "file": str(target), "segments": count} | versions)
        else:
            typer.echo(
                f"{target} holds map {name}: {count:,} segments, "
                f"updated from version {before} to {copy.sequence}."
            )
