"""`placecell maps diff`."""

from pathlib import Path
from typing import Annotated

import typer

from cli.maps.options import HERE, Key, Url, map_at, service


def diff(
    old: Annotated[str, typer.Argument(help="A map file, or a map's name; NAME@N: version N.")],
    new: Annotated[str, typer.Argument(help="Another.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Write a delta file that leads from OLD to NEW."),
    ] = None,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Show how two maps differ. Ends with status 1 if they do."""
    import numpy as np
    from placecell_client import Delta, encode_delta
    from placecell_client.map_edit import difference, take
    from rich.console import Console
    from rich.table import Table

    with service(url, key) as client:
        before, after = map_at(old, client), map_at(new, client)
        changed, removed = difference(before, after)
        if output:
            output.write_bytes(encode_delta(Delta(changed, removed)))
    is_added = ~np.isin(changed.ids, before.ids)
    kinds = {
        "added": take(changed, is_added),
        "replaced": take(changed, ~is_added),
        "removed": take(before, np.isin(before.ids, removed)),
    }
    if not len(changed) and not len(removed):
        typer.echo("no difference")
        return
    table = Table("robot", *kinds)
    for robot in sorted({*before.robots, *after.robots}):
        counts = []
        for segments in kinds.values():
            names = np.array(segments.robots, dtype=object)[segments.robot]
            counts.append(f"{np.count_nonzero(names == robot):,}")
        table.add_row(robot, *counts)
    Console().print(table)
    raise typer.Exit(1)
