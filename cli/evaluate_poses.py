"""`placecell evaluate-poses`: measures how well a robot is localized in a map."""

import json
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.common_options import Every, Model
from cli.outputs import output_file, output_folder, picture_file
from cli.sources import clear_errors, parse_town, protocol_named, show
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

if TYPE_CHECKING:
    from evaluation.poses.queries import Pair
    from placecell.core.parameters import Parameters

TOWN = "Simulated drives (town:SEED)"


def evaluate_poses(
    map_drive: Annotated[
        Path,
        typer.Argument(
            help="Drive for the map. town:SEED or town:SEED:SENSOR:PLACE simulates two "
            "robots that drive the same way in opposite directions: A makes the map, B localizes."
        ),
    ],
    query_drive: Annotated[
        Path | None,
        typer.Argument(
            help="Drive for the queries, in the same place. (default: alternate blocks of "
            "MAP_DRIVE are map and queries)"
        ),
    ] = None,
    model: Model = None,
    every: Every = None,
    segmentation: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Segmentation protocol of both drives: v1; sparse, for few points in a local map; "
            "or auto: sparse if a capture has fewer than 30 segments by v1 (median of either "
            "drive); v1 with recordings and with town:SEED.",
        ),
    ] = "auto",
    k: Annotated[int, typer.Option(min=1, help="Number of candidates per segment.")] = 25,
    motion: Annotated[
        str,
        typer.Option(
            help="Degrees of freedom: yaw (x, y, z, yaw; gravity is known) or se3 (all six)."
        ),
    ] = "yaw",
    session: Annotated[
        bool,
        typer.Option(
            help="Send all queries in one session: the requests of the last seconds also count."
        ),
    ] = False,
    queries: Annotated[
        int | None,
        typer.Option(min=1, help="Number of queries, spread evenly. (default: all captures)"),
    ] = None,
    max_false_acceptance: Annotated[
        float | None,
        typer.Option(
            help="Largest expected share of queries with a false pose, off by more than 3 m or 10 "
            "degrees; more than 0 and at most 0.5. (default: 0.001, or the smallest share that the "
            "model supports)"
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Random seed for the query robot's coordinate frame.")
    ] = 0,
    map_recording: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Recording of MAP_DRIVE from 'placecell prepare'; saves segmenting it again.",
        ),
    ] = None,
    query_recording: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Recording of QUERY_DRIVE from 'placecell prepare'."),
    ] = None,
    map_sensor: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Sensor of robot A, as of 'placecell town --sensor'. (default: that of "
            "town:SEED:SENSOR, else hdl-64e)",
            rich_help_panel=TOWN,
        ),
    ] = None,
    query_sensor: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Sensor of robot B. (default: that of --map-sensor)",
            rich_help_panel=TOWN,
        ),
    ] = None,
    place: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Place, as of 'placecell town --place'. (default: that of town:SEED:SENSOR:PLACE, "
            "else streets)",
            rich_help_panel=TOWN,
        ),
    ] = None,
    scans: Annotated[
        int | None,
        typer.Option(min=1, help="Scans of each drive. (default: 300)", rich_help_panel=TOWN),
    ] = None,
    cache: Annotated[
        Path | None,
        typer.Option(
            callback=output_folder,
            help="Folder that keeps the prepared drives for the next call. (default: none)",
            rich_help_panel=TOWN,
        ),
    ] = None,
    other_cars: Annotated[
        bool,
        typer.Option(
            "--other-cars",
            help="Let robot B drive the way of robot A on another day, when all parked cars "
            "changed. (default: robot B drives in the opposite direction)",
            rich_help_panel=TOWN,
        ),
    ] = False,
    ignore: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CLASS",
            help="Class of segments to leave out of map and queries, or movable for vehicles and "
            "persons; repeatable. It needs a model with classes. (default: none)",
        ),
    ] = None,
    json_file: JsonFile = None,
    answers: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=output_file,
            help="File for the result of each query, one JSON object per line.",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of precision, recall and reliability.",
        ),
    ] = None,
) -> None:
    """Measure localization: each capture of one drive is localized in the map of another drive.

    This example localizes a robot with an OS1-64 in the map of a robot with a VLP-16:

        placecell evaluate-poses town:301 --map-sensor vlp-16 --query-sensor os1-64

    The command runs the service's code in its own process. docs/results/localization.md defines
    the figures.
    """
    from evaluation.poses.evaluate import draw, evaluate
    from evaluation.poses.queries import Pair
    from placecell.core.segment_classes import ClassFilter
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.localization import LocalizationParameters

    with clear_errors():
        if motion not in {"yaw", "se3"}:
            raise ValueError(f"Invalid --motion {motion!r}: expected yaw or se3.")
        recordings = (map_recording, query_recording)
        simulated = (map_sensor, query_sensor, place, scans, cache, other_cars or None)
        is_town = str(map_drive).startswith("town:")
        if is_town:
            if query_drive or any(recordings):
                raise ValueError(
                    f"{map_drive} is both drives. Omit QUERY_DRIVE, --map-recording and "
                    "--query-recording."
                )
            made = partial(pair_of_town, str(map_drive), every, *simulated)
        elif any(value is not None for value in simulated):
            raise ValueError(
                "--map-sensor, --query-sensor, --place, --scans, --cache and --other-cars need a "
                "simulated drive. Give town:SEED as MAP_DRIVE."
            )
        else:
            made = partial(Pair.of, map_drive, query_drive, every, recordings, show)
        pair = segmented(made, segmentation, can_change=not (is_town or any(recordings)))
        parameters = LocalizationParameters(
            model="se3" if motion == "se3" else "yaw", max_false_acceptance=max_false_acceptance
        )
        wanted = ClassFilter.of(None, ignore or ())
        folder = model_folder(model or DEFAULT_MODEL)
        report, rows = evaluate(
            pair, folder, k, parameters, session, queries, seed, wanted=wanted, progress=show
        )
        write_json(report, json_file)
        if answers:
            answers.parent.mkdir(parents=True, exist_ok=True)
            answers.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
        if plot:
            draw(report, plot)
    print_report(report)


def segmented(made: "Callable[..., Pair]", name: str, can_change: bool) -> "Pair":
    """Return a pair of drives that are segmented by a protocol.

    Args:
        made: function of the keyword `protocol` that makes the pair.
        name: name of the protocol; `auto` for the one that suits both drives.
        can_change: whether `auto` may select another protocol than v1.

    Raises:
        ValueError: there is no such protocol.
    """
    from placecell.core.parameters import PROTOCOL_SPARSE, PROTOCOL_V1
    from placecell.segmentation.protocol_choice import is_sparse

    if name != "auto":
        return made(protocol=protocol_named(name))
    pair = made(protocol=PROTOCOL_V1)
    if can_change and any(is_sparse(robot.recordings) for robot in (pair.mapper, pair.asker)):
        typer.echo(
            "A capture has few segments by protocol v1, so protocol sparse is used. "
            "'--segmentation v1' keeps v1."
        )
        return made(protocol=PROTOCOL_SPARSE)
    return pair


def pair_of_town(
    text: str,
    every: int | None,
    map_sensor: str | None,
    query_sensor: str | None,
    place: str | None,
    scans: int | None,
    cache: Path | None,
    other_cars: bool | None,
    protocol: "Parameters",
) -> "Pair":
    """Simulate the robots of town:SEED:SENSOR:PLACE, or read them from the cache.

    Raises:
        ValueError: the text has another form, or a sensor or the place is unknown.
    """
    from evaluation.poses.town_drives import SCANS, TownDrives

    seed, sensor, named = parse_town(text)
    mapping = map_sensor or sensor
    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        drives = TownDrives(
            cache or Path(folder), seed, place or named, scans or SCANS, every, protocol
        )
        return drives.pair(mapping, query_sensor or mapping, show, other_day=bool(other_cars))


SHARES = ("best_pose_right", "told_share_of_right", "success_2m_5deg")


def print_report(report: dict[str, Any]) -> None:
    """Print the figures."""
    where = "by blocks" if report["blocks"] else f"in the map of {report['map_drive']}"
    typer.echo(
        f"{report['query_drive']} {where}, protocol {report['protocol']}, {report['model_id']}: "
        f"{report['queries']:,} queries, {report['map_segments']:,} segments in the map"
    )
    table = new_table("", "share", "95% bounds")
    for name, (low, high) in report["bounds_95"].items():
        share = report[name]
        shown = "-" if share is None else f"{share:.2%}"
        table.add_row(_label(name), shown, f"{low:.2%} to {high:.2%}")
    for name in SHARES:
        table.add_row(_label(name), percent(report[name]), "")
    print_tables(table)
    beyond = report["beyond_the_map"]
    if beyond["queries"]:
        counts = beyond["counts"]
        typer.echo(
            f"outside the map: {beyond['queries']:,} queries, {counts['localised_right']} right, "
            f"{counts['wrong_but_sure']} wrong but sure, {counts['not_localised']} not localized"
        )
    error, score = (
        "-" if report[name] is None else f"{report[name]:.3f}"
        for name in ("expected_calibration_error", "brier")
    )
    typer.echo(f"Expected calibration error: {error}. Brier score: {score}.")
    typer.echo(
        f"Median error: {report['median_position_error_m']} m, {report['median_yaw_error_deg']} "
        f"deg. Time from descriptors to pose: {report['p50_ms']} ms (p50), "
        f"{report['p99_ms']} ms (p99)."
    )


def _label(key: str) -> str:
    """Return the words for a key of the report; early keys have British spelling."""
    return key.replace("_", " ").replace("localised", "localized")
