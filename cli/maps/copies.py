"""`placecell maps push` and `pull`: between a service and files."""

import os
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from cli.maps.options import HERE, PATIENCE, IfMatch, Key, Name, Timeout, Url, service

VERSION_SUFFIX = ".version"
"""Of the file beside a pulled map that says which version it is."""


def push(
    name: Name,
    file: Annotated[Path, typer.Argument(help="A map file, or a delta file to edit the map by.")],
    if_match: IfMatch = None,
    new: Annotated[bool, typer.Option("--new", help="Replace no map.")] = False,
    deduplicate: Annotated[
        bool,
        typer.Option("--deduplicate", help="Of a delta: store nothing again that is seen again."),
    ] = False,
    timeout: Timeout = PATIENCE,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Store a map file whole, or edit a map by a delta file.

    A map that is there with other content is replaced only with --if-match.
    """
    from placecell_client import MapFileError, decode, decode_delta

    with service(url, key, timeout) as client:
        data = file.read_bytes()
        try:
            decode(data)
        except MapFileError as not_a_map:
            try:
                delta = decode_delta(data)
            except MapFileError as not_a_delta:
                raise ValueError(f"{file}: {not_a_map}; {not_a_delta}") from not_a_delta
            done = client.edit_map(
                name, delta, create=new, deduplicate=deduplicate, if_match=if_match
            )
            typer.echo(
                f"{name}: {done.changed} segments changed, {done.removed} removed, "
                f"{done.repeats} seen again; version {done.sequence}, {done.etag}"
            )
        else:
            stored = client.put_map(name, data, if_match=if_match, create_only=new)
            typer.echo(
                f"{name}: {stored.segments:,} segments; version {stored.sequence}, {stored.etag}"
            )


def pull(
    name: Name,
    file: Annotated[Path, typer.Argument(help="Where the map is kept.")],
    version: Annotated[
        int | None, typer.Option(min=1, help="An old version, instead of the newest.")
    ] = None,
    timeout: Timeout = PATIENCE,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Bring a map file up to date, or get it.

    Only what has changed since the last pull is sent; FILE.version says which version that was.
    """
    from placecell_client import MapCopy, MapFileError, decode, encode

    mark = file.with_name(file.name + VERSION_SUFFIX)
    with service(url, key, timeout) as client:
        if version is not None:
            mark.unlink(missing_ok=True)
            _write(file, client.get_map_file(name, version))
            typer.echo(f"{file}: version {version} of {name}")
            return
        copy = MapCopy(name)
        if file.exists() and mark.exists():
            try:
                copy = MapCopy(name, decode(file.read_bytes()), mark.read_text().strip())
            except MapFileError:
                typer.echo(f"{file}: damaged; the map is got anew", err=True)
        before = copy.sequence
        client.pull(copy)
        assert copy.content is not None
        # Should this end in between, the mark is that of no file, and all is got anew.
        mark.unlink(missing_ok=True)
        _write(file, encode(copy.content))
        _write(mark, f"{copy.etag}\n".encode())
        since = f" (was {before})" if before else ""
        typer.echo(
            f"{file}: {len(copy.content):,} segments; version {copy.sequence}{since}, {copy.etag}"
        )


def _write(file: Path, data: bytes) -> None:
    """All of it, or nothing."""
    descriptor, unfinished = tempfile.mkstemp(".unfinished", ".", file.parent)
    with os.fdopen(descriptor, "wb") as written:
        written.write(data)
    Path(unfinished).chmod(0o644)
    Path(unfinished).replace(file)
