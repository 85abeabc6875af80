"""`placecell maps diff`: compares two maps, versions or map files."""

from typing import Annotated

import typer

from cli.maps.connection import LOCAL, Url, map_from, service
from cli.tables import JsonFlag, print_json


def diff(
    old: Annotated[str, typer.Argument(help="Old map: a map file, MAP, or MAP@VERSION.")],
    new: Annotated[str, typer.Argument(help="New map: a map file, MAP, or MAP@VERSION.")],
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Count the segments that were added, changed and removed between two maps."""
    import numpy as np
    from placecell_client.maps.edit import difference

    with service(url) as client:
        before, after = map_from(client, old), map_from(client, new)
        changed, removed = difference(before, after)
        replaced = int(np.isin(changed.ids, before.ids).sum())
    counts = {
        "added": len(changed) - replaced,
        "changed": replaced,
        "removed": len(removed),
        "same": len(before) - replaced - len(removed),
    }
    if as_json:
        print_json(counts)
    else:
        words = {"same": "unchanged"}
        typer.echo(", ".join(f"{count:,} {words.get(key, key)}" for key, count in counts.items()))
