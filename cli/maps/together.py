"""`placecell maps align` and `merge`: how maps lie to each other, and one map of them all."""

from dataclasses import asdict
from math import degrees
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.sources import fail
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import MapAlignment, Merge, MergePair, Overlap, Pose

POSE = "x, y, z, yaw"

Motion = Annotated[
    Literal["yaw", "se3"],
    typer.Option(help="yaw: yaw and translation, for frames are level; se3: all six degrees."),
]


def align(
    name: Name,
    other: Annotated[str, typer.Argument(metavar="OTHER", help="The map to lay on it.")],
    motion: Motion = "yaw",
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Tell how another map lies to a map; ends with status 1 if the two are not aligned."""
    with service(url) as client:
        found = client.align_maps(name, other, motion=motion)
    if as_json:
        print_json(asdict(found))
    else:
        print_alignment(found)
    if found.pose is None:
        fail(f"{name} and {other} are not aligned ({found.reason}): {found.detail}")


def merge(
    site: Annotated[str, typer.Argument(metavar="SITE", help="The map to put them into.")],
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="MAP", help="For a new site two or more; the first one's frame is its own."
        ),
    ],
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only tell what would be done.")
    ] = False,
    keep_repeats: Annotated[
        bool,
        typer.Option("--keep-repeats", help="Store also what another map's segment shows already."),
    ] = False,
    if_match: Annotated[
        str | None,
        typer.Option(
            metavar="ETAG",
            help="Only if the site is at this version, such as 'pull' keeps beside a file.",
        ),
    ] = None,
    motion: Motion = "yaw",
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Lay maps on each other and put their segments into one; says how to undo it.

    Maps that cannot be laid on the site are left out; ends with status 1 if that is all of them.
    """
    with service(url) as client:
        merged = client.merge_maps(
            site,
            names,
            dry_run=dry_run,
            deduplicate=not keep_repeats,
            motion=motion,
            if_match=if_match,
        )
    if as_json:
        print_json(asdict(merged))
    else:
        print_merge(merged)
    if not is_any_laid(merged):
        fail(f"no map of {', '.join(names)} can be laid on another: none would be merged")


def is_any_laid(merged: "Merge") -> bool:
    """Whether a map lies on another; the site is one of them, if it held segments before."""
    is_site_there = any(merged.map in (pair.map, pair.other) for pair in merged.alignments)
    return sum(part.merged for part in merged.parts) + is_site_there >= 2


def print_alignment(found: "MapAlignment") -> None:
    """The ways to lay one map on the other, the best one first; and what both have seen."""
    table = new_table("", f"{found.other} in {found.map}: {POSE}", "pairs", "agreement", "score")
    if found.pose is not None:
        counts = str(found.pairs), f"{found.agreement:.0%}", f"{found.score:.1f}"
        table.add_row("aligned", told(found.pose), *counts)
    for way in found.others:
        counts = str(way.pairs), f"{way.agreement:.0%}", f"{way.score:.1f}"
        table.add_row("another way", told(way.pose), *counts)
    if table.row_count:
        print_tables(table)
    if found.overlap is not None:
        typer.echo(
            f"both were in {found.overlap.of_map:.0%} of the places of {found.map}, "
            f"in {found.overlap.of_other:.0%} of those of {found.other}"
        )


def print_merge(merged: "Merge") -> None:
    """What was found of each two maps, what became of each, and how to undo it."""
    pairs = new_table("map", "other", "found", "pairs", "agreement", "overlap")
    for pair in merged.alignments:
        counts = str(pair.pairs), f"{pair.agreement:.0%}", shares(pair.overlap)
        pairs.add_row(pair.map, pair.other, verdict(pair), *counts)
    parts = new_table("map", f"in {merged.map}: {POSE}", "new", "known", "repeats", "removed")
    for part in merged.parts:
        place = told(part.pose) if part.pose is not None else "left out"
        numbers = (part.added, part.known, part.repeats, part.removed)
        parts.add_row(part.map, place, *(f"{number:,}" for number in numbers))
    print_tables(pairs, parts)
    for pair in merged.alignments:
        if not pair.aligned:
            typer.echo(f"{pair.map} and {pair.other}: {pair.detail}")
    for loop in merged.loops:
        way = " - ".join((*loop.maps, loop.maps[0]))
        closes = "closes" if loop.closes else "does not close"
        typer.echo(f"{way} {closes}: {loop.metres:.2f} m and {loop.degrees:.1f} degrees off")
    if is_any_laid(merged):
        typer.echo(summary(merged))


def summary(merged: "Merge") -> str:
    """What the site holds after it, and how to undo it."""
    after = f"{merged.map}: {merged.segments:,} segments"
    changes = f"{merged.changed:,} changed, {merged.removed:,} removed"
    if merged.dry_run:
        return f"{after} it would hold, {changes}; nothing was written"
    if merged.sequence == merged.previous:
        return f"{after}, version {merged.sequence}: there was nothing new"
    undo = f"delete {merged.map}"
    if merged.previous is not None:
        undo = f"restore {merged.map} {merged.previous}"
    return f"{after}, version {merged.sequence}: {changes}\nto undo it: placecell maps {undo}"


def verdict(pair: "MergePair") -> str:
    """What was found of two maps, in a word or two."""
    if pair.rejected:
        return "rejected"
    if pair.aligned:
        return "proven" if pair.proven else "aligned"
    return pair.reason or "not aligned"


def shares(overlap: "Overlap | None") -> str:
    """How much of both maps is of the same places."""
    return f"{overlap.of_map:.0%}, {overlap.of_other:.0%}" if overlap is not None else ""


def told(pose: "Pose") -> str:
    """A pose as x, y and z in metres, and yaw."""
    x, y, z = pose.translation
    return f"{x:.2f}, {y:.2f}, {z:.2f}, {degrees(pose.yaw):.1f}\N{DEGREE SIGN}"
