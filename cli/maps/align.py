"""`placecell maps align`: aligns two maps and prints the transform between their frames."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.maps.poses import POSE, Motion, pose_text
from cli.sources import fail
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import MapAlignment


def align(
    name: Name,
    other: Annotated[str, typer.Argument(metavar="OTHER", help="Name of the map to align to MAP.")],
    motion: Motion = "yaw",
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Compute the pose of map OTHER in the frame of MAP; nothing is written.

    The command ends with status 1 if the maps cannot be aligned.
    """
    with service(url) as client:
        found = client.align_maps(name, other, motion=motion)
    if as_json:
        print_json(asdict(found))
    else:
        print_alignment(found)
    if found.pose is None:
        fail(f"Maps {name} and {other} cannot be aligned ({found.reason}): {found.detail}")


def print_alignment(found: "MapAlignment") -> None:
    """Print the pose hypotheses, best first, and the overlap of the two maps."""
    table = new_table("", f"{found.other} in {found.map}: {POSE}", "pairs", "agreement", "score")
    if found.pose is not None:
        counts = str(found.pairs), f"{found.agreement:.0%}", f"{found.score:.1f}"
        table.add_row("aligned", pose_text(found.pose), *counts)
    for hypothesis in found.others:
        counts = str(hypothesis.pairs), f"{hypothesis.agreement:.0%}", f"{hypothesis.score:.1f}"
        table.add_row("other hypothesis", pose_text(hypothesis.pose), *counts)
    if table.row_count:
        print_tables(table)
    if found.overlap is not None:
        typer.echo(
            f"The overlap is {found.overlap.of_map:.0%} of {found.map} "
            f"and {found.overlap.of_other:.0%} of {found.other}."
        )
