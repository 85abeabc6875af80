"""`placecell maps list` and `show`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.options import HERE, Key, Url, map_at, moment, service

if TYPE_CHECKING:
    from placecell_client import CompactMap


def show_all(url: Url = HERE, key: Key = None) -> None:
    """List the maps of a service."""
    from rich.console import Console
    from rich.table import Table

    with service(url, key) as client:
        table = Table("map", "segments", "version", "kB", "robots", "from", "to", "model", "ETag")
        for each in client.maps():
            span = [moment(time) for time in each.time_span] if each.time_span else ["-", "-"]
            table.add_row(
                each.name,
                f"{each.segments:,}",
                str(each.sequence),
                f"{each.bytes / 1000:,.0f}",
                ", ".join(f"{robot} {count:,}" for robot, count in each.robots.items()),
                *span,
                each.model_id,
                each.etag,
            )
    Console(width=max(Console().width, 160)).print(table)


def show(
    source: Annotated[
        str, typer.Argument(help="A map file, or the name of a map; NAME@N: its version N.")
    ],
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it from above into this PNG.")
    ] = None,
    url: Url = HERE,
    key: Key = None,
) -> None:
    """Show what is in a map."""
    with service(url, key) as client:
        content = map_at(source, client)
    for line in described(content):
        typer.echo(line)
    if plot:
        from bench.map_picture import draw_map

        draw_map(plot, content, source)


def described(content: "CompactMap") -> list[str]:
    """A map in lines."""
    import numpy as np
    from placecell_client import encode

    n = len(content)
    size = len(encode(content))
    lines = [
        f"segments       {n:,}",
        f"file           {size:,} bytes" + (f", {size / n:.1f} a segment" if n else ""),
        f"model          {content.model_id}, {content.code_bytes} bytes of codes",
        f"preprocessing  {content.preprocessing}",
        f"frame          {content.frame}",
        f"frames         {len(content.frame_times):,}",
    ]
    counts = np.bincount(content.robot, minlength=len(content.robots))
    lines += [
        f"robot          {robot}: {count:,} segments"
        for robot, count in zip(content.robots, counts, strict=True)
    ]
    if content.time_span:
        lines.append(f"time           {' to '.join(map(moment, content.time_span))}")
    if n:
        low, high = content.centroids.min(axis=0), content.centroids.max(axis=0)
        sides = (f"{axis} {a:.1f} to {b:.1f}" for axis, a, b in zip("xyz", low, high, strict=True))
        lines.append(f"extent         {', '.join(sides)} m")
    if content.views is not None:
        lines.append(f"things         {len(np.unique(content.views)):,}, by their views")
    lines.append(f"optional       {', '.join(content.optional) or 'no columns'}")
    return lines
