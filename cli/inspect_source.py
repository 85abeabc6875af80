"""`placecell inspect`: tells what a source holds, and how to cure its problems."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.outputs import picture_file
from cli.sources import clear_errors, show
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

if TYPE_CHECKING:
    from placecell.inspection.inspect import Inspection

COLORS = {"error": "red", "warning": "yellow", "info": "cyan"}


def inspect(
    source: Annotated[
        Path,
        typer.Argument(help="Drive folder, bag, point clouds, trajectory, or file of Placecell."),
    ],
    scans: Annotated[
        int,
        typer.Option(min=1, help="Number of scans to look at, evenly spread."),
    ] = 40,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a picture of one scan: raw, ground and segments, obliquely and "
            "from above.",
        ),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Check a robot's data: what is in it, what Placecell uses, and how to cure its problems.

    The exit status is 0 if Placecell can use the source, and 1 if not.

        placecell inspect run.mcap --plot run.png
    """
    from placecell.inspection.inspect import inspect_source

    with clear_errors():
        if json_file:
            json_file.parent.mkdir(parents=True, exist_ok=True)
        found = inspect_source(source, scans, show)
        write_json(found.as_dict(), json_file)
        if plot:
            draw(found, plot)
    print_inspection(found)
    if not found.usable:
        raise typer.Exit(1)


def draw(found: "Inspection", file: Path) -> None:
    """Draw a scan, if there is one."""
    if not found.samples.clouds:
        typer.echo(f"placecell: {found.subject.path} has no scan to draw.", err=True)
        return
    from placecell.inspection.picture import draw_scan

    draw_scan(found, file)


def print_inspection(found: "Inspection") -> None:
    """Print the facts as a table, then each problem with its cure."""
    facts = found.as_dict()
    table = new_table("", "found", title=str(found.subject.path))
    for name, value in rows(found, facts):
        table.add_row(name, value)
    print_tables(table)
    if facts["topics"]:
        topics = new_table("topic", "type", "messages", "rate")
        for topic in facts["topics"]:
            rate = f"{topic['rate_hz']:g} Hz"
            topics.add_row(topic["name"], topic["type"], f"{topic['messages']:,}", rate)
        print_tables(topics)
    for problem in found.problems:
        typer.secho(f"{problem.severity}: ", fg=COLORS[problem.severity], nl=False)
        typer.echo(f"{problem.what.rstrip('.')}.")
        typer.echo(f"    {problem.cure}")
    if found.usable:
        typer.echo("Placecell can use this source.")
    else:
        typer.echo("Placecell cannot use this source as it is.")


def rows(found: "Inspection", facts: dict[str, object]) -> "list[tuple[str, str]]":
    """Return names and values of the facts, as text."""
    read = found.samples.scans
    looked_at = facts["scans_looked_at"]
    listed = [
        ("format", str(facts["format"])),
        ("scans", f"{facts['scans']:,} ({looked_at} were looked at)"),
    ]
    if read:
        listed += [
            ("points a scan", f"{facts['points_mean']:,.0f}"),
            ("fields", ", ".join(found.subject.fields()) or "not stated"),
            (
                "times of points",
                f"yes, {facts['sweep_s']} s a sweep" if facts["per_point_time"] else "no",
            ),
            ("NaN points", percent(float(str(facts["nan_share"])))),
            ("points at (0, 0, 0)", percent(float(str(facts["zero_share"])))),
            ("frame of the points", str(facts["frame"]) or "not stated"),
            ("view", f"{facts['view_deg']:g} degrees around"),
            ("rate", "unknown" if facts["rate_hz"] is None else f"{facts['rate_hz']:g} Hz"),
            ("gaps", f"{facts['gaps']} ({facts['missing_scans']} scans missing)"),
        ]
        ground = found.mount.ground
        if ground is None:
            listed.append(("sensor height and tilt", f"unknown. {found.mount.reason}"))
        else:
            listed.append(("sensor height", f"{ground.height:.2f} m above the ground"))
            listed.append(("tilt", f"{ground.tilt_deg:.1f} degrees"))
    if found.imu is not None:
        gravity = found.imu.gravity
        told = found.imu.reason if gravity is None else f"tilt of {gravity.tilt_deg:.1f} degrees"
        listed.append(("IMU", f"{found.imu.samples.topic}: {told}"))
    if found.leveled_by:
        listed.append(("odometry is leveled by", found.leveled_by))
    poses = found.subject.trajectory
    if poses is None:
        listed.append(("poses", "none"))
    else:
        frames = " to ".join(each for each in (poses.frame, poses.world) if each)
        facts_of = facts["trajectory"]
        assert isinstance(facts_of, dict)
        length = facts_of["length_m"]
        way = "no finite length" if length is None else f"{length:,.1f} m"
        listed.append(("poses", f"{len(poses):,} over {way}{f' ({frames})' if frames else ''}"))
    if found.subject.transform:
        listed.append(("sensor on the robot", found.subject.transform))
    return listed
