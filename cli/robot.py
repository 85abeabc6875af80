"""`placecell robot`: localizes a robot while it drives, and sends what it maps."""

import os
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.maps.connection import KEY_VARIABLE
from cli.sources import clear_errors, parse_town, show
from cli.tables import JsonFlag, new_table, print_json, print_tables

if TYPE_CHECKING:
    from robot.agent import RobotAgent
    from robot.core.status import Summary
    from robot.outputs.output import AgentOutput
    from robot.playback import Playback

OUTPUTS = "Outputs"
LIVE = "Playback"


def robot(
    source: Annotated[
        str,
        typer.Argument(
            help="Drive (a bag, an MCAP file, a folder of scans, or a folder in a known layout), "
            "or town:SEED:SENSOR:PLACE for a simulated one."
        ),
    ],
    map_name: Annotated[str, typer.Option("--map", metavar="NAME", help="Name of the map.")],
    service: Annotated[
        str,
        typer.Option(
            "--service", metavar="URL", envvar="PLACECELL_URL", help="Address of the service."
        ),
    ] = "http://127.0.0.1:8000",
    localize: Annotated[
        bool, typer.Option("--localize/--no-localize", help="Localize in the map.")
    ] = True,
    upload: Annotated[
        bool, typer.Option("--upload/--no-upload", help="Send the robot's segments to the service.")
    ] = True,
    localize_map: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Map to localize in. (default: that of --map)"),
    ] = None,
    upload_map: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Map that receives the segments. If it is another robot's, a map NAME-ROBOT is "
            "begun. (default: that of --map)",
        ),
    ] = None,
    robot_name: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Name of the robot. (default: that of the source)"),
    ] = None,
    keyframe_meters: Annotated[
        float,
        typer.Option(
            min=0.1, help="Distance between two keyframes, at which segments are extracted, meters."
        ),
    ] = 2.0,
    localize_meters: Annotated[
        float,
        typer.Option(
            min=0.1, help="Distance between two requests while the pose is known, meters."
        ),
    ] = 4.0,
    state: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Folder of what must survive a reboot: edits that were not sent, the last pose, "
            "the pulled map. A command that was killed continues there. (default: kept in memory)",
        ),
    ] = None,
    local: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Folder of the pulled map, in which the robot localizes without a link. "
            "(default: that of --state)",
        ),
    ] = None,
    model: Annotated[
        str, typer.Option(help="Model name or folder; the map must have the same model.")
    ] = "context",
    spool_mb: Annotated[
        float, typer.Option(min=0.1, help="Largest size of the edits that wait, megabytes.")
    ] = 1000.0,
    wait: Annotated[
        float,
        typer.Option(
            min=0.0, metavar="SECONDS", help="Longest time to send the rest at the end, seconds."
        ),
    ] = 60.0,
    realtime: Annotated[
        bool,
        typer.Option(
            "--realtime",
            help="Play a recording at its own pace; scans that come too late are dropped. "
            "(default: as fast as possible, and none is dropped)",
            rich_help_panel=LIVE,
        ),
    ] = False,
    speed: Annotated[
        float,
        typer.Option(
            min=0.01, help="Recorded seconds in a second of --realtime.", rich_help_panel=LIVE
        ),
    ] = 1.0,
    trajectory: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Trajectory in the map: KITTI format if the name ends in .kitti, else TUM format.",
            rich_help_panel=OUTPUTS,
        ),
    ] = None,
    mcap: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="MCAP file for Foxglove: clouds, segments and poses.",
            rich_help_panel=OUTPUTS,
        ),
    ] = None,
    events: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="File to which fixes, states and keyframes are appended, one JSON object a line.",
            rich_help_panel=OUTPUTS,
        ),
    ] = None,
    as_json: JsonFlag = False,
) -> None:
    """Localize a robot in a map while it drives, and send its segments to the service.

    The robot writes only a map that it has begun itself, in the frame of its odometry: NAME, or
    NAME-ROBOT if NAME is another's. Without a link it goes on with the pulled map, and sends the
    edits later.

        placecell robot run.mcap --service http://10.0.0.2:8000 --map yard --state ~/placecell

    docs/how-to/run-on-a-robot.md describes the ways to use it.
    """
    from robot.agent import RobotAgent
    from robot.core.settings import AgentSettings
    from robot.service_link import ServiceLink, robot_client

    with clear_errors(), ExitStack() as opened:
        playback = open_any(source, opened)
        settings = AgentSettings(
            map=map_name,
            robot=robot_name or playback.title,
            session=playback.session,
            state=state,
            maps_folder=local,
            localize=localize,
            upload=upload,
            localize_map=localize_map,
            upload_map=upload_map,
            keyframe_meters=keyframe_meters,
            localize_meters=localize_meters,
            spool_bytes=int(spool_mb * 1e6),
            model=model,
        )
        key = os.environ.get(KEY_VARIABLE)
        client = opened.enter_context(robot_client(service, key))
        asking = opened.enter_context(robot_client(service, key, timeout=3.0))
        agent = RobotAgent(
            settings, ServiceLink(client, asking), outputs_of(trajectory, mcap, events)
        )
        opened.callback(agent.close)
        drive(agent, playback, speed if realtime else None)
        agent.finish()
        if not agent.wait_for_uploads(wait):
            left = agent.status.spool.entries
            where = f"They stay in {state}; run the command again." if state else "They are lost."
            typer.echo(f"placecell: {left} edits could not be sent. {where}", err=True)
        summary = agent.close()
    if as_json:
        print_json(asdict(summary))
    else:
        print_summary(summary, playback.title)


def open_any(source: str, opened: ExitStack) -> "Playback":
    """Open a drive, or simulate one."""
    import tempfile

    from robot.playback import DrivePlayback, open_playback

    if not source.startswith("town:"):
        return open_playback(Path(source))
    import town
    from placecell.datasets import open_drive

    seed, sensor, place = parse_town(source)
    folder = opened.enter_context(tempfile.TemporaryDirectory(prefix="placecell-town-"))
    drives = town.two_robots(
        Path(folder), seed=seed, scans=300, place=place, lidar=town.sensor(sensor), progress=show
    )
    return DrivePlayback(open_drive(drives[0]))


def outputs_of(
    trajectory: Path | None, mcap: Path | None, events: Path | None
) -> "list[AgentOutput]":
    """Open the outputs that were asked for."""
    from robot.outputs.events import EventLog
    from robot.outputs.mcap_output import McapOutput
    from robot.outputs.trajectory import TrajectoryFile

    outputs: list[AgentOutput] = []
    if trajectory is not None:
        outputs.append(TrajectoryFile(trajectory))
    if events is not None:
        outputs.append(EventLog(events))
    if mcap is not None:
        outputs.append(McapOutput(mcap))
    return outputs


def drive(agent: "RobotAgent", playback: "Playback", speed: float | None) -> None:
    """Give the scans of a recording to the agent.

    Args:
        agent: the agent.
        playback: the recording.
        speed: recorded seconds in a second; None: as fast as possible, and each request is
            answered before the next scan.
    """
    from robot.playback import at_own_pace

    scans = playback.scans(agent.first_scan)
    if speed is not None:
        scans = at_own_pace(scans, speed, agent.drop_scan)
    for scan in scans:
        agent.on_scan(scan.points, scan.time, scan.pose)
        if speed is None:
            agent.wait(10.0)
        for message in agent.messages:
            typer.echo(f"placecell: {message}", err=True)


def print_summary(summary: "Summary", title: str) -> None:
    """Print the summary as a table."""
    table = new_table("", "", title=title)
    for name, value in summary_rows(summary):
        table.add_row(name, value)
    print_tables(table)


def summary_rows(summary: "Summary") -> list[tuple[str, str]]:
    """Return names and values of the summary, as text."""
    first: Any = summary.meters_until_first_fix
    return [
        ("meters", f"{summary.meters:,.1f}"),
        ("scans", f"{summary.scans:,} ({summary.scans_dropped:,} more came too late)"),
        ("keyframes", f"{summary.keyframes:,}"),
        ("fixes", f"{summary.fixes:,} ({summary.fixes_refused:,} more were not used)"),
        ("meters until the first fix", "-" if first is None else f"{first:.1f}"),
        ("carried away", f"{summary.kidnaps:,}"),
        ("segments mapped", f"{summary.segments:,}"),
        ("edits sent", f"{summary.uploads:,} ({summary.spool.entries:,} wait)"),
        ("maps written", ", ".join(summary.upload_maps) or "-"),
        ("state", f"{summary.state.value}, link {summary.link.value}"),
    ]
