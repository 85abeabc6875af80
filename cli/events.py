"""`placecell events`: prints what happens in a service."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Url, service


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
