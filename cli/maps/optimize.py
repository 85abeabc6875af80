"""`placecell maps optimize`: removes the drift of a map."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.outputs import picture_file
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import Optimization


def optimize(
    name: Name,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only report what would move; write nothing.")
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of the captures and loops before and after.",
        ),
    ] = None,
    if_match: Annotated[
        str | None,
        typer.Option(
            metavar="ETAG",
            help="Optimize only if the map is at this version; 'pull' writes it to FILE.etag. "
            "(default: any version)",
        ),
    ] = None,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Remove the drift of a map by loops within it; the output names the undo command.

    The captures of the map are localized in its other parts, and move to the poses that fit
    odometry and loops best. Loops that drift does not explain are rejected. For the trajectories
    before and after, pull both versions and export them with 'placecell export --to tum'.
    """
    with service(url) as client:
        found = client.optimize_map(
            name, dry_run=dry_run, frames=plot is not None, if_match=if_match
        )
        if plot is not None:
            draw(found, plot)
    if as_json:
        print_json(asdict(found))
    else:
        print_optimization(found)


def print_optimization(found: "Optimization") -> None:
    """Print the loops by verdict, the parts, and how to undo the optimization."""
    verdicts = [each.verdict for each in found.loops]
    loops = new_table("loops", "number")
    for verdict in sorted(set(verdicts)):
        loops.add_row(verdict.replace("-", " "), str(verdicts.count(verdict)))
    parts = new_table("part", "robots", "captures", "moves up to")
    for number, part in enumerate(found.parts, start=1):
        parts.add_row(
            str(number), ", ".join(part.robots), f"{part.captures:,}", f"{part.moved_m:.2f} m"
        )
    print_tables(loops, parts)
    typer.echo(
        f"Loops are {found.residual_before_m:.2f} m off before and {found.residual_after_m:.2f} m "
        f"after. Captures move by {found.moved_median_m:.2f} m (median), at most "
        f"{found.moved_max_m:.2f} m."
    )
    if found.dry_run:
        typer.echo(f"{found.changed:,} segments would move. Nothing was written (dry run).")
    elif found.sequence == found.previous:
        typer.echo("No capture moves by more than the accuracy of loops: nothing was written.")
    else:
        typer.echo(
            f"Map {found.map} has version {found.sequence}: {found.changed:,} segments moved.\n"
            f"To undo the optimization: placecell maps restore {found.map} {found.previous}"
        )


COLORS = {"accepted": "tab:green"}
"""Colors of the loops in the plot; rejected loops are red."""


def draw(found: "Optimization", file: Path) -> None:
    """Plot the captures and the loops before and after."""
    from evaluation.figure import figure

    with figure(file, 2) as panels:
        for axes, title in zip(panels, ("before", "after"), strict=True):
            places = [each.before if title == "before" else each.after for each in found.frames]
            for robot in sorted({each.robot for each in found.frames}):
                rows = [
                    place[:2]
                    for place, each in zip(places, found.frames, strict=True)
                    if each.robot == robot
                ]
                axes.plot(*zip(*rows, strict=True), linewidth=0.8, label=robot)
            for loop in found.loops:
                ends = [places[capture][:2] for capture in loop.captures]
                color = COLORS.get(loop.verdict, "tab:red")
                axes.plot(*zip(*ends, strict=True), color=color, linewidth=0.6)
            axes.set(title=title, xlabel="x, meters", ylabel="y, meters", aspect="equal")
            axes.grid(alpha=0.3)
        panels[0].legend()
