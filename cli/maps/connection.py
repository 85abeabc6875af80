"""Connection of the commands to a service, and access to maps by name, version or file."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.sources import clear_errors, fail

if TYPE_CHECKING:
    from placecell_client import Client, CompactMap

Url = Annotated[
    str,
    typer.Option("--url", envvar="PLACECELL_URL", help="Address of the service."),
]
LOCAL = "http://127.0.0.1:8000"

Name = Annotated[str, typer.Argument(metavar="MAP", help="Name of the map.")]

KEY_VARIABLE = "PLACECELL_KEY"
"""Environment variable with the API key. Other users could read a key on the command line."""


@contextmanager
def service(url: str) -> Iterator["Client"]:
    """Open a client of the service; a refused or failed request ends the command with one line."""
    import httpx
    from placecell_client import Client, ServiceError
    from placecell_client.http.retry import may_be_done

    with clear_errors():
        try:
            with Client(url, key=os.environ.get(KEY_VARIABLE), timeout=300) as client:
                yield client
        except ServiceError as error:
            fail(error)
        except httpx.TransportError as error:
            if may_be_done(error):
                fail(f"{url} did not answer: {error} The request may still have been carried out.")
            fail(f"Cannot reach {url}: {error}")


def map_from(client: "Client", source: str) -> "CompactMap":
    """Load a map from a file, or from the service by NAME or NAME@VERSION.

    Raises:
        ValueError: the file is no map file, or the version is not a number.
    """
    from placecell_client import MapFileError, decode

    if Path(source).is_file():
        try:
            return decode(Path(source).read_bytes())
        except MapFileError as error:
            raise ValueError(f"{source}: {error}. Fetch the map again.") from error
    name, _, version = source.partition("@")
    if version and not version.isdigit():
        raise ValueError(f"Invalid version in {source!r}: expected a number, such as {name}@3.")
    return client.get_map(name, int(version) if version else None)
