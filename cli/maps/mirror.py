"""`placecell maps mirror`: keeps a read-only copy of another service's map."""

import os
import time
from pathlib import Path
from typing import Annotated

import typer

from cli.maps.connection import KEY_VARIABLE, LOCAL, Name, Url
from cli.sources import clear_errors, fail
from cli.tables import JsonFlag, print_json

REMOTE_KEY_VARIABLE = "PLACECELL_REMOTE_KEY"
"""Environment variable with the key of the remote service."""

TIMEOUT_SECONDS = 300.0


def mirror(
    remote: Annotated[str, typer.Argument(metavar="REMOTE", help="Address of the remote service.")],
    name: Name,
    local_name: Annotated[
        str | None,
        typer.Option("--as", metavar="NAME", help="Name of the local copy. (default: MAP)"),
    ] = None,
    every: Annotated[float, typer.Option(min=1.0, help="Time between two rounds, seconds.")] = 60.0,
    once: Annotated[bool, typer.Option("--once", help="Copy once, and end.")] = False,
    end: Annotated[
        bool,
        typer.Option("--end", help="End the mirror: the copy stays and takes writes again."),
    ] = False,
    key_file: Annotated[
        Path | None,
        typer.Option(
            help="File with the API key of the remote service. (default: PLACECELL_REMOTE_KEY)"
        ),
    ] = None,
    spool: Annotated[
        Path | None,
        typer.Option(
            help="Folder of incomplete copies. (default: mirrors in PLACECELL_CACHE, or in "
            "~/.cache/placecell)"
        ),
    ] = None,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Keep a read-only copy of another service's map in the local service.

    The command transfers only changes, and goes on where it was after a cut link or a restart. The
    local service refuses all other writes to the copy. Tags and anchors are copied too.
    """
    import httpx
    from placecell_client import Client, ServiceError

    from cli.maps.mirroring import Mirror

    with clear_errors():
        key = key_file.read_text(encoding="utf-8").strip() if key_file else None
        source = source_of(remote, name)
        target = local_name or name
        local_key = os.environ.get(KEY_VARIABLE)
        with (
            Client(remote, TIMEOUT_SECONDS, key=key or os.environ.get(REMOTE_KEY_VARIABLE)) as far,
            Client(url, TIMEOUT_SECONDS, key=local_key, mirrors=source) as near,
        ):
            try:
                if end:
                    near.delete_mirror(target)
                    typer.echo(f"Map {target} takes writes again. It is no longer updated.")
                    return
                rounds = Mirror(far, near, name, target, source, spool or default_spool())
                while True:
                    try:
                        done = rounds.step()
                        if as_json:
                            print_json(
                                {
                                    "map": target,
                                    "source": source,
                                    "etag": done.etag,
                                    "segments": done.segments,
                                    "changed": done.is_new,
                                }
                            )
                        elif done.is_new or once:
                            typer.echo(
                                f"Map {target}: {done.segments:,} segments, version {done.etag} "
                                f"of {source}."
                            )
                    except (ServiceError, httpx.TransportError) as error:
                        if once:
                            raise
                        typer.echo(f"placecell: {error} The next try is in {every:g} s.", err=True)
                    if once:
                        return
                    time.sleep(every)
            except (ServiceError, httpx.TransportError) as error:
                fail(error)


def source_of(remote: str, name: str) -> str:
    """Return the URL of a map at a service; ValueError if the address has a user or password."""
    if "@" in remote or not remote.startswith(("http://", "https://")):
        raise ValueError(
            f"Invalid address {remote.rpartition('@')[2]!r}: expected http://HOST:PORT or "
            f"https://HOST without user and password. Put the key into {REMOTE_KEY_VARIABLE}."
        )
    return f"{remote.rstrip('/')}/maps/{name}"


def default_spool() -> Path:
    """Return the folder of incomplete copies."""
    cache = os.environ.get("PLACECELL_CACHE")
    return (Path(cache) if cache else Path.home() / ".cache" / "placecell") / "mirrors"
