"""What the commands for maps share: which service, and what stands for a map."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.sources import clear_errors, fail

if TYPE_CHECKING:
    from placecell_client import Client, CompactMap

Url = Annotated[str, typer.Option("--url", envvar="PLACECELL_URL", help="Address of the service.")]
Key = Annotated[
    str | None,
    typer.Option("--key", envvar="PLACECELL_KEY", help="Key; better in the environment."),
]
Timeout = Annotated[
    float, typer.Option(min=0.001, help="Seconds that a request may take, repetitions included.")
]
IfMatch = Annotated[
    str | None,
    typer.Option(
        metavar="ETAG", help="Only if the map is at this version, as 'list' tells; *: at any."
    ),
]
Name = Annotated[str, typer.Argument(help="Of the map.")]

HERE = "http://127.0.0.1:8000"
PATIENCE = 120.0


@contextmanager
def service(url: str, key: str | None, timeout: float = PATIENCE) -> "Iterator[Client]":
    """A client; what the service refuses, or that it is not there, ends the command with a line."""
    import httpx
    from placecell_client import Client, ServiceError

    with clear_errors():
        try:
            with Client(url, timeout, key=key, compress=True) as client:
                yield client
        except ServiceError as error:
            fail(error)
        except (httpx.TransportError, httpx.InvalidURL) as error:
            fail(f"{url}: {error or type(error).__name__}")


def map_at(source: str, client: "Client") -> "CompactMap":
    """The map of a file, or a service's by name; NAME@N is its version N.

    Raises:
        ValueError: the file is no map.
    """
    from placecell_client import decode

    if Path(source).is_file():
        return decode(Path(source).read_bytes())
    name, at, sequence = source.rpartition("@")
    if at and re.fullmatch("[0-9]{1,15}", sequence):
        return client.get_map(name, int(sequence))
    return client.get_map(source)


def moment(seconds: float) -> str:
    """A time for people: in UTC, if it looks like Unix seconds."""
    from datetime import UTC, datetime

    if 1e8 < seconds < 9e9:
        return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M:%S")
    return f"{seconds:.1f} s"
