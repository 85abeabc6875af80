"""Which service the commands speak to, and maps by name or file."""

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

Name = Annotated[str, typer.Argument(metavar="MAP", help="The map's name.")]

KEY_VARIABLE = "PLACECELL_KEY"
"""A key on the command line could be read by everyone on the machine."""


@contextmanager
def service(url: str) -> Iterator["Client"]:
    """A client of the service; what it refuses ends the command with a line."""
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
            fail(f"{url} cannot be reached: {error}")


def is_delta(data: bytes) -> bool:
    """Whether a file says of itself that it is a delta file; it may be cut all the same."""
    return b"placecell-delta" in data[:4096]


def map_from(client: "Client", source: str) -> "CompactMap":
    """A map: of a file, or by name, or an earlier version as NAME@VERSION.

    Raises:
        ValueError: neither a file nor what could be a version.
    """
    from placecell_client import decode

    if Path(source).is_file():
        return decode(Path(source).read_bytes())
    name, _, version = source.partition("@")
    if version and not version.isdigit():
        raise ValueError(f"{source}: a version is a number, such as {name}@3")
    return client.get_map(name, int(version) if version else None)
