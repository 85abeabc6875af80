"""`placecell maps merge`: merges maps into one."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Url, service
from cli.maps.poses import POSE, Motion, pose_text
from cli.sources import fail
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from placecell_client import Merge, MergePair, Overlap


def merge(
    merged_map: Annotated[
        str,
        typer.Argument(metavar="MERGED", help="Name of the merged map; it is created if needed."),
    ],
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="MAP",
            help="Names of the maps to merge. A new merged map needs two or more and takes the "
            "frame of the first.",
        ),
    ],
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only report the result; write nothing.")
    ] = False,
    keep_repeats: Annotated[
        bool,
        typer.Option(
            "--keep-repeats", help="Also store segments that repeat a segment of another map."
        ),
    ] = False,
    if_match: Annotated[
        str | None,
        typer.Option(
            metavar="ETAG",
            help="Merge only if the merged map is at this version; 'pull' writes it to FILE.etag. "
            "(default: any version)",
        ),
    ] = None,
    motion: Motion = "yaw",
    bend: Annotated[
        bool,
        typer.Option(
            "--bend", help="Also remove drift: optimize the merged map before it is written."
        ),
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Align maps and merge their segments into one map; the output names the undo command.

    Maps that cannot be aligned are left out. The command ends with status 1 if no maps can be
    aligned.
    """
    with service(url) as client:
        merged = client.merge_maps(
            merged_map,
            names,
            dry_run=dry_run,
            deduplicate=not keep_repeats,
            motion=motion,
            rigid=not bend,
            if_match=if_match,
        )
    if as_json:
        print_json(asdict(merged))
    else:
        print_merge(merged)
    if not is_any_aligned(merged):
        fail(f"No two of the maps {', '.join(names)} can be aligned: none would be merged.")


def is_any_aligned(merged: "Merge") -> bool:
    """Return whether two maps are aligned; a merged map that held segments before is one of them.

    A merge of a single map is not an alignment.
    """
    has_merged_map = any(merged.map in (pair.map, pair.other) for pair in merged.alignments)
    return sum(part.merged for part in merged.parts) + has_merged_map >= 2


def print_merge(merged: "Merge") -> None:
    """Print the alignment of each pair, the outcome for each map, and how to undo the merge."""
    pairs = new_table("map", "other", "result", "pairs", "agreement", "overlap")
    for pair in merged.alignments:
        counts = str(pair.pairs), f"{pair.agreement:.0%}", overlap_text(pair.overlap)
        pairs.add_row(pair.map, pair.other, verdict(pair), *counts)
    parts = new_table("map", f"in {merged.map}: {POSE}", "new", "known", "repeats", "removed")
    for part in merged.parts:
        place = pose_text(part.pose) if part.pose is not None else "left out"
        numbers = (part.added, part.known, part.repeats, part.removed)
        parts.add_row(part.map, place, *(f"{number:,}" for number in numbers))
    print_tables(pairs, parts)
    for pair in merged.alignments:
        if not pair.aligned:
            typer.echo(f"{pair.map} and {pair.other}: {pair.detail}")
    for loop in merged.loops:
        way = " - ".join((*loop.maps, loop.maps[0]))
        closes = "closes" if loop.closes else "does not close"
        typer.echo(f"Loop {way} {closes}: error {loop.meters:.2f} m and {loop.degrees:.1f} degrees")
    if is_any_aligned(merged):
        typer.echo(summary(merged))


def summary(merged: "Merge") -> str:
    """Describe the merged map after the merge, and the command that undoes it."""
    changes = f"{merged.changed:,} changed, {merged.removed:,} removed"
    if merged.dry_run:
        return (
            f"Map {merged.map} would have {merged.segments:,} segments: {changes}. "
            "Nothing was written (dry run)."
        )
    after = f"Map {merged.map} has {merged.segments:,} segments, version {merged.sequence}"
    if merged.sequence == merged.previous:
        return f"{after}. The maps held nothing new."
    undo = f"delete {merged.map}"
    if merged.previous is not None:
        undo = f"restore {merged.map} {merged.previous}"
    return f"{after}: {changes}.\nTo undo the merge: placecell maps {undo}"


def verdict(pair: "MergePair") -> str:
    """Name the result of aligning two maps in one or two words."""
    if pair.rejected:
        return "rejected"
    if pair.aligned:
        return "proven" if pair.proven else "aligned"
    return pair.reason or "not aligned"


def overlap_text(overlap: "Overlap | None") -> str:
    """Format the overlap as a share of each map."""
    return f"{overlap.of_map:.0%}, {overlap.of_other:.0%}" if overlap is not None else ""
