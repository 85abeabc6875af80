"""`placecell maps diff`: compares two maps, versions or map files."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Url, map_from, service
from cli.outputs import picture_file
from cli.tables import JsonFlag, print_json

if TYPE_CHECKING:
    from placecell_client import CompactMap

    from placecell.lasting.difference import WorldDifference


def diff(
    old: Annotated[str, typer.Argument(help="Old map: a map file, MAP, or MAP@VERSION.")],
    new: Annotated[str, typer.Argument(help="New map: a map file, MAP, or MAP@VERSION.")],
    world: Annotated[
        bool,
        typer.Option(
            "--world",
            help="Compare what stands in the world: segments of the new map that appeared, and of "
            "the old map that are gone, changed or kept. Both maps need one coordinate frame.",
        ),
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", callback=picture_file, help="PNG file for a top view of --world."
        ),
    ] = None,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Count the segments that were added, changed and removed between two maps."""
    with service(url) as client:
        before, after = map_from(client, old), map_from(client, new)
        if world or plot is not None:
            found = _compared(before, after)
            if plot is not None:
                draw(before, after, found, plot)
            counts = found.counts
        else:
            counts = _counted(before, after)
    if as_json:
        print_json(counts)
    else:
        words = {"same": "unchanged", "unseen": "not in sight", "new_place": "in new places"}
        typer.echo(", ".join(f"{count:,} {words.get(key, key)}" for key, count in counts.items()))


def _counted(before: "CompactMap", after: "CompactMap") -> dict[str, int]:
    """Count the segments by id and value."""
    import numpy as np
    from placecell_client.maps.edit import difference

    changed, removed = difference(before, after)
    replaced = int(np.isin(changed.ids, before.ids).sum())
    return {
        "added": len(changed) - replaced,
        "changed": replaced,
        "removed": len(removed),
        "same": len(before) - replaced - len(removed),
    }


def _compared(before: "CompactMap", after: "CompactMap") -> "WorldDifference":
    """Compare what stands in the world.

    Raises:
        ValueError: the maps have different coordinate frames.
    """
    from placecell.lasting.difference import world_difference
    from service.maps.writes.long_life import observed_segments

    if before.frame != after.frame:
        raise ValueError(
            f"The maps have the coordinate frames {before.frame!r} and {after.frame!r}; expected "
            "one. Merge them (placecell maps merge), and compare versions of the merged map."
        )
    return world_difference(observed_segments(before), observed_segments(after))


COLORS = {"kept": "0.75", "changed": "tab:orange", "gone": "tab:red", "appeared": "tab:green"}
"""Colors of the top view."""


def draw(before: "CompactMap", after: "CompactMap", found: "WorldDifference", file: Path) -> None:
    """Draw what changed in the world from above into a PNG file."""
    from evaluation.figure import figure
    from placecell.lasting.judgment import ABSENT, CHANGED, CONFIRMED

    counts = found.counts
    with figure(file, size=7) as (axes,):
        for outcome, content, rows in (
            ("kept", before, found.before == CONFIRMED),
            ("changed", before, found.before == CHANGED),
            ("gone", before, found.before == ABSENT),
            ("appeared", after, found.after == ABSENT),
        ):
            x, y, _ = content.centroids[rows].T
            label = f"{outcome}: {counts[outcome]:,}"
            axes.plot(x, y, ".", markersize=3, color=COLORS[outcome], label=label)
        axes.plot(*after.frame_positions[:, :2].T, "k,", label="sensor")
        axes.set(aspect="equal", xlabel="x, meters", ylabel="y, meters")
        axes.legend()
