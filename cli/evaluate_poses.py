"""`placecell evaluate-poses`: how well a robot finds its place in a map."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.sources import clear_errors, show
from cli.tables import JsonFile, new_table, print_tables, write_json


def evaluate_poses(
    map_drive: Annotated[Path, typer.Argument(help="Folder of the drive that the map is made of.")],
    query_drive: Annotated[
        Path | None,
        typer.Argument(
            help="Folder of the drive that asks, through the same town. Left out: alternate blocks "
            "of the one drive are map and queries."
        ),
    ] = None,
    model: Annotated[
        str | None,
        typer.Option(help="A model's name or folder. (default: the one that is served)"),
    ] = None,
    every: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="A frame every so many scans. (default: 2; 1 on drives of fewer than 100 scans)",
        ),
    ] = None,
    k: Annotated[int, typer.Option(min=1, help="Candidates a segment.")] = 25,
    motion: Annotated[
        str, typer.Option(help="yaw: yaw and translation, for gravity is known; se3: all six.")
    ] = "yaw",
    session: Annotated[
        bool, typer.Option(help="Requests of one session: those of the last seconds count too.")
    ] = False,
    queries: Annotated[
        int | None, typer.Option(min=1, help="So many, spread evenly. (default: all frames)")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the asking robot's own frame.")] = 0,
    map_recording: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="What 'placecell prepare' made of MAP_DRIVE, so as not to cut it again.",
        ),
    ] = None,
    query_recording: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The same of QUERY_DRIVE.")
    ] = None,
    json_file: JsonFile = None,
    answers: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Write what became of each query here, a line of JSON each."
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw precision, recall and reliability into this PNG."),
    ] = None,
) -> None:
    """Measure localisation: every frame of one drive is asked in the map of another.

    Through the service's own code, in this process. Definitions: docs/results/localization.md.
    """
    from evaluation.poses.evaluate import draw, evaluate
    from evaluation.poses.queries import Pair
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.localization import LocalizationParameters

    with clear_errors():
        if motion not in {"yaw", "se3"}:
            raise ValueError(f"--motion is yaw or se3, not {motion!r}")
        pair = Pair.of(map_drive, query_drive, every, (map_recording, query_recording), show)
        parameters = LocalizationParameters(model="se3" if motion == "se3" else "yaw")
        folder = model_folder(model or DEFAULT_MODEL)
        report, rows = evaluate(pair, folder, k, parameters, session, queries, seed, progress=show)
        write_json(report, json_file)
        if answers:
            answers.parent.mkdir(parents=True, exist_ok=True)
            answers.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
        if plot:
            draw(report, plot)
    print_report(report)


def print_report(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    where = "by blocks" if report["blocks"] else f"in the map of {report['map_drive']}"
    typer.echo(
        f"{report['query_drive']} {where}, protocol {report['protocol']}, {report['model_id']}: "
        f"{report['queries']:,} queries, {report['map_segments']:,} segments in the map"
    )
    table = new_table("", "share", "95% bounds")
    for name, (low, high) in report["bounds_95"].items():
        share = report[name]
        shown = "-" if share is None else f"{share:.2%}"
        table.add_row(name.replace("_", " "), shown, f"{low:.2%} to {high:.2%}")
    print_tables(table)
    beyond = report["beyond_the_map"]
    if beyond["queries"]:
        counts = beyond["counts"]
        typer.echo(
            f"beyond the map {beyond['queries']:,} more: {counts['localised_right']} right, "
            f"{counts['wrong_but_sure']} wrong but sure, {counts['not_localised']} not localised"
        )
    typer.echo(
        f"median error {report['median_position_error_m']} m, {report['median_yaw_error_deg']} "
        f"deg; {report['p50_ms']} ms (p50), {report['p99_ms']} ms (p99) from descriptors to pose"
    )
