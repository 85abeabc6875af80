"""`placecell events`: prints what happens in a service."""

from typing import Annotated

import typer

from cli.errors import fail
from cli.maps.connection import LOCAL, Url, service

OF_STREAM = ("missed", "dropped", "stopping")
"""Kinds of events about the stream itself."""


def events(
    limit: Annotated[
        int | None, typer.Option(min=1, help="Number of events after which to end.")
    ] = None,
    kind: Annotated[
        list[str] | None,
        typer.Option(help="Kind of event to print, such as fix or alarm. Default: all."),
    ] = None,
    after: Annotated[str, typer.Option(metavar="ID", help="Id of the event to begin after.")] = "",
    url: Url = LOCAL,
) -> None:
    """Print the events of a service as lines of JSON, until Ctrl+C; a broken link is reopened."""
    import json
    from typing import get_args

    from service.live.events import Kind

    known = (*get_args(Kind), *OF_STREAM)
    for each in kind or ():
        if each not in known:
            fail(f"Unknown kind {each!r}: expected one of {', '.join(known)}.")
    count = 0
    with service(url) as client:
        try:
            for event in client.events(after):
                if kind and event.kind not in kind:
                    continue
                typer.echo(json.dumps({"event": event.kind, "id": event.id} | event.data))
                count += 1
                if count == limit:
                    return
        except KeyboardInterrupt:
            return
