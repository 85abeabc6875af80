"""`placecell demo`: two robots share a map through a real service."""

import json
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.outputs import output_folder
from cli.sources import clear_errors, fail, show
from cli.tables import JsonFile, new_table, print_tables, write_json

if TYPE_CHECKING:
    from demo.meeting import Meeting


def demo(
    drive: Annotated[
        Path | None,
        typer.Option(
            help="Recorded drive; the robots get alternate blocks of it. "
            "(default: a simulated drive through the synthetic town)"
        ),
    ] = None,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the pictures and the figures.",
        ),
    ] = Path("out/demo"),
    seed: Annotated[
        int, typer.Option(help="Random seed of the town and of robot B's coordinate frame.")
    ] = 7,
    scans: Annotated[int, typer.Option(min=20, help="Scans per robot in the town.")] = 120,
    json_file: JsonFile = None,
) -> None:
    """Run two robots and a service: robot B is localized in robot A's map; both maps are merged.

    The service matches robot B's segments with robot A's map, localizes robot B, and merges the
    maps of both robots. The command ends with status 0 only if all results are right. On a drive
    shorter than 24 m only the matches must be right; the command reports the other results.
    """
    from demo.run import is_short, run_demo
    from evaluation.poses.queries import random_frame
    from evaluation.poses.robots import in_own_frame, robots_of_drive, robots_of_town
    from placecell.descriptors.manifest import Manifest
    from placecell.descriptors.shipped_models import BASELINE, DEFAULT_MODEL, MODELS_FOLDER

    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-demo-") as scratch:
        if drive is None:
            typer.echo(
                "Two robots drive the same streets of a synthetic town in opposite directions."
            )
            mapper, asker = robots_of_town(Path(scratch), seed, scans, show)
        else:
            mapper, asker = robots_of_drive(drive, show)
            if is_short(mapper.drive):
                typer.echo(
                    f"Drive {drive} is short ({mapper.drive.path_length():.0f} m, "
                    f"{len(mapper.drive)} scans): it shows few places, each in few scans. The "
                    "figures below say little."
                )
            seen = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL).has_seen(
                hash_ for recording in mapper.recordings for hash_ in recording.scan_hashes
            )
            if seen:
                typer.echo(f"The model {DEFAULT_MODEL} was trained on scans of this drive.")
        # Only the segments show how robot B's frame lies relative to robot A's.
        asker = in_own_frame(asker, random_frame(seed))
        data = output / "service"
        shutil.rmtree(data, ignore_errors=True)  # of an earlier demo
        outcome = run_demo(mapper, asker, data, DEFAULT_MODEL, output)
        baseline = run_demo(mapper, asker, Path(scratch) / "baseline", BASELINE)
    figures = outcome.figures | {BASELINE: baseline.figures}
    (output / "figures.json").write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    write_json(figures, json_file)
    print_outcome(outcome.figures, baseline.figures)
    names = [name for name in ("matches.png", "site.png", "page.png") if (output / name).exists()]
    typer.echo(f"The pictures are in {output}: {', '.join(names)}.")
    typer.echo(
        f"To see the maps, run 'placecell serve --data-dir {data}' and open "
        "http://127.0.0.1:8000/#map=site in a browser."
    )
    if not outcome.score.findable:
        fail("No segment of robot B lies in robot A's map, so nothing can be recognized.")
    if not outcome.score.recognized:
        fail("The matches of robot B are hardly better than chance.")
    meeting = outcome.meeting
    assert meeting is not None  # the demo always runs it
    claims = conclude(meeting)
    failures = [failure for _, failure in claims if failure]
    if not failures:
        typer.echo(
            "It works: robot B is localized in robot A's map, and both robots share one map."
        )
    elif not is_short(mapper.drive):
        fail(". ".join(failures) + ".")
    else:
        typer.echo(
            "The matches of robot B are right. The drive is too short to require more. Results:"
        )
        for claim, failure in claims:
            typer.echo(f"  no: {failure}." if failure else f"  yes: {claim}.")


def conclude(meeting: "Meeting") -> list[tuple[str, str]]:
    """Return the claims of the demo, each with the reason why it failed; empty if it holds."""
    poses = merged = ""
    if not meeting.is_localized:
        wrong = sum(each.position is not None for each in meeting.answers)
        poses = (
            f"Robot B was never localized rightly: of {len(meeting.answers)} answers {wrong} are "
            "wrong poses, the others are 'not localized'"
        )
    if meeting.alignment is None:
        merged = f"The two maps could not be aligned ({meeting.refusal})"
    elif not meeting.is_merged:
        meters, degrees = meeting.alignment_error
        merged = f"The alignment of the two maps is {meters:.1f} m and {degrees:.1f} deg off"
    return [
        ("Robot B is localized in robot A's map", poses),
        ("Both robots share one map", merged),
    ]


def print_outcome(figures: dict[str, Any], baseline: dict[str, Any]) -> None:
    """Print the figures of the model and of the baseline side by side."""
    names = {
        "path_m": "path length, m",
        "segments_in_map": "segments in robot A's map",
        "map_bytes": "size of the map file, bytes",
        "bytes_per_segment": "bytes per segment",
        "requests": "match requests of robot B",
        "queries": "segments in these requests",
        "queries_findable": "  of them in robot A's map",
        "right_by_chance": "  right by chance",
        "right_at_1": "  right first candidate",
        "right_at_5": "  right among the first 5",
        "right_at_25": "  right among the first 25",
        "request_p50_ms": "time per match request, median, ms",
        "request_p99_ms": "time per match request, p99, ms",
        "poses_asked": "localize requests of robot B",
        "poses_right": "  right pose, within 1 m and 3 degrees",
        "poses_wrong": "  wrong pose",
        "not_localised": "  not localized",
        "pose_median_m": "position error, median, m",
        "pose_median_deg": "yaw error, median, degrees",
        "localize_p50_ms": "time per localize request, median, ms",
        "maps_merged": "the maps are merged",
        "merged_off_m": "alignment error, m",
        "merged_off_deg": "alignment error, degrees",
        "segments_in_site": "segments in the merged map",
        "repeats_left_out": "segments of robot B that repeat robot A's",
    }
    table = new_table("", figures["model_id"], baseline["model_id"])
    for key in [name for name in names if name in figures]:
        table.add_row(names[key], *(shown(key, each.get(key, "")) for each in (figures, baseline)))
    print_tables(table)
    if "poses_asked" in figures:
        typer.echo(poses_in_words(figures))


def poses_in_words(figures: dict[str, Any]) -> str:
    """Summarize robot B's localization in one sentence."""
    right = figures["poses_right"]
    error = f" (median error {100 * figures['pose_median_m']:.0f} cm)" if right else ""
    return (
        f"Robot B asks for its pose {figures['poses_asked']} times; the answers are: "
        f"{right} right{error}, {figures['poses_wrong']} wrong, "
        f"{figures['not_localised']} 'not localized'."
    )


def shown(key: str, value: object) -> str:
    """Format a figure for the table."""
    if isinstance(value, float) and key.startswith("right"):
        return f"{value:.1%}"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:,}" if isinstance(value, int) else str(value)
