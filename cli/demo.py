"""`placecell demo`: the whole way, from a drive to matches over HTTP."""

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.sources import clear_errors, fail, show
from cli.tables import JsonFile, new_table, print_tables, write_json

if TYPE_CHECKING:
    from demo.meeting import Meeting


def demo(
    drive: Annotated[
        Path | None,
        typer.Option(help="A recorded drive's folder instead of the town: alternate blocks of it."),
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the picture and the figures.")
    ] = Path("out/demo"),
    seed: Annotated[int, typer.Option(help="Of the town.")] = 7,
    scans: Annotated[int, typer.Option(min=20, help="Scans of each robot in the town.")] = 120,
    json_file: JsonFile = None,
) -> None:
    """Let robot A share its map through a real service, robot B find its place in it, and merge.

    Robot B is told which segments of the map it sees, and its pose in it; then both maps become
    one. Ends with status 0 only if that came out right; on a drive of less than 24 m robot B must
    be recognised, and the rest is told.
    """
    from demo.meeting import in_own_frame
    from demo.run import is_short, run_demo
    from evaluation.poses.queries import random_frame
    from evaluation.poses.robots import robots_of_drive, robots_of_town
    from placecell.descriptors.manifest import Manifest
    from placecell.descriptors.shipped_models import BASELINE, DEFAULT_MODEL, MODELS_FOLDER

    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-demo-") as scratch:
        if drive is None:
            typer.echo("Two robots drive through a synthetic town, the same streets opposite ways.")
            mapper, asker = robots_of_town(Path(scratch), seed, scans, show)
        else:
            mapper, asker = robots_of_drive(drive, show)
            if is_short(mapper.drive):
                typer.echo(
                    f"{drive}: the drive is short ({mapper.drive.path_length():.0f} m, "
                    f"{len(mapper.drive)} scans): few places to recognise, and each seen from few "
                    "scans; the figures below say little."
                )
            seen = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL).has_seen(
                hash_ for recording in mapper.recordings for hash_ in recording.scan_hashes
            )
            if seen:
                typer.echo(f"{DEFAULT_MODEL} was trained on scans of this drive.")
        # Nothing but the segments tells how robot B's frame lies to robot A's.
        asker = in_own_frame(asker, random_frame(seed))
        outcome = run_demo(mapper, asker, Path(scratch) / "service", DEFAULT_MODEL, output)
        baseline = run_demo(mapper, asker, Path(scratch) / "baseline", BASELINE)
    figures = outcome.figures | {BASELINE: baseline.figures}
    (output / "figures.json").write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    write_json(figures, json_file)
    print_outcome(outcome.figures, baseline.figures)
    typer.echo(f"pictures: {output / 'matches.png'}, {output / 'site.png'}")
    if not outcome.score.findable:
        fail("no segment of robot B lies in robot A's map; nothing could be recognised")
    if not outcome.score.recognized:
        fail("robot B was not recognised: its candidates are hardly better than chance")
    meeting = outcome.meeting
    assert meeting is not None  # it was asked for
    claims = conclude(meeting)
    failures = [failure for _, failure in claims if failure]
    if not failures:
        typer.echo("It works: robot B knows where it is in robot A's map, and both share one map.")
    elif not is_short(mapper.drive):
        fail("; ".join(failures))
    else:
        typer.echo("Robot B is recognised; the drive is too short to demand more. What came out:")
        for claim, failure in claims:
            typer.echo(f"  no: {failure}" if failure else f"  yes: {claim}")


def conclude(meeting: "Meeting") -> list[tuple[str, str]]:
    """What the demo is to show, each with why it did not come out; empty if it did."""
    poses = merged = ""
    if not meeting.is_told:
        wrong = sum(each.place is not None for each in meeting.told)
        poses = (
            f"robot B was nowhere told its right pose; of {len(meeting.told)} answers {wrong} tell "
            "a wrong one, the others that it is not known"
        )
    if meeting.laid is None:
        merged = f"the two maps could not be laid on each other ({meeting.refusal})"
    elif not meeting.is_merged:
        meters, degrees = meeting.off
        merged = f"the two maps were laid on each other {meters:.1f} m and {degrees:.1f} deg off"
    return [
        ("robot B knows where it is in robot A's map", poses),
        ("both robots share one map", merged),
    ]


def print_outcome(figures: dict[str, Any], baseline: dict[str, Any]) -> None:
    """The figures as a table on the terminal, the baseline's beside them."""
    names = {
        "path_m": "metres driven",
        "segments_in_map": "segments in robot A's map",
        "map_bytes": "map file, bytes",
        "bytes_per_segment": "bytes a segment",
        "requests": "requests of robot B",
        "queries": "segments asked about",
        "queries_findable": "of those, in the map",
        "right_by_chance": "  a random candidate would be right",
        "right_at_1": "  found by the first candidate",
        "right_at_5": "  among the first 5",
        "right_at_25": "  among the first 25",
        "request_p50_ms": "milliseconds a request, median",
        "request_p99_ms": "milliseconds a request, p99",
        "poses_asked": "times that robot B asked where it is",
        "poses_right": "  told its pose, within 1 m and 3 degrees",
        "poses_wrong": "  told a wrong one",
        "not_localised": "  told that it is not known",
        "pose_median_m": "metres off, median",
        "pose_median_deg": "degrees off, median",
        "localize_p50_ms": "milliseconds a request, median",
        "maps_merged": "both maps merged",
        "merged_off_m": "metres that they lie off each other",
        "merged_off_deg": "degrees",
        "segments_in_site": "segments in the map of both",
        "repeats_left_out": "segments of robot B left out: seen by robot A",
    }
    table = new_table("", figures["model_id"], baseline["model_id"])
    for key in [name for name in names if name in figures]:
        table.add_row(names[key], *(shown(key, each.get(key, "")) for each in (figures, baseline)))
    print_tables(table)


def shown(key: str, value: object) -> str:
    """A figure for people to read."""
    if isinstance(value, float) and key.startswith("right"):
        return f"{value:.1%}"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:,}" if isinstance(value, int) else str(value)
