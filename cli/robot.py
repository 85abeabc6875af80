"""`placecell robot`: localizes a robot while it drives, and sends what it maps."""

import os
import signal
import threading
import uuid
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.maps.connection import KEY_VARIABLE
from cli.outputs import output_file, output_folder
from cli.sources import TOWN_SCANS, clear_errors, parse_town, show
from cli.tables import JsonFlag, new_table, print_json, print_tables
from placecell.sources.scan_options import current_scan_options

if TYPE_CHECKING:
    from robot.agent import RobotAgent
    from robot.core.status import Summary
    from robot.outputs.output import AgentOutput
    from robot.playback import Playback
    from robot.zenoh.address import ZenohAddress

OUTPUTS = "Outputs"
LIVE = "Playback"
LARGEST_SPOOL = 1 << 62
"""Size of a spool without a limit, bytes."""


def robot(
    source: Annotated[
        str,
        typer.Argument(
            help="Drive (a bag, an MCAP file, a folder of scans, or a folder in a known layout), "
            "town:SEED:SENSOR:PLACE for a simulated one, or zenoh://HOST:PORT?points=TOPIC&odom="
            "TOPIC for the topics of a robot with ROS 2 (rmw_zenoh), until Ctrl-C."
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
    keep_moving: Annotated[
        bool,
        typer.Option(
            "--keep-moving/--drop-moving",
            help="Keep segments that move while they are seen, such as cars. By default, they are "
            "neither stored nor localized.",
        ),
    ] = False,
    ignore: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CLASS",
            help="Class of segments to leave out of localization, or movable for vehicles and "
            "persons; repeatable. They are mapped all the same. (default: none)",
        ),
    ] = None,
    unmapped: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CLASS",
            help="Class of segments that are not sent to the map, or movable; repeatable. "
            "(default: none)",
        ),
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
            callback=output_folder,
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
            callback=output_file,
            help="Trajectory in the map: KITTI format if the name ends in .kitti, else TUM format.",
            rich_help_panel=OUTPUTS,
        ),
    ] = None,
    mcap: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=output_file,
            help="MCAP file for Foxglove: clouds, segments and poses.",
            rich_help_panel=OUTPUTS,
        ),
    ] = None,
    events: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=output_file,
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
    from robot.core.settings import AgentSettings
    from robot.live import live_agent

    with clear_errors(), ExitStack() as opened:
        live = open_live(source) if source.startswith("zenoh:") else None
        playback = None if live else open_any(source, opened)
        title = playback.title if playback else "robot"
        settings = AgentSettings(
            map=map_name,
            robot=robot_name or title,
            session=playback.session if playback else uuid.uuid4().hex[:16],
            state=state,
            maps_folder=local,
            localize=localize,
            upload=upload,
            localize_map=localize_map,
            upload_map=upload_map,
            keep_moving=keep_moving,
            ignore=tuple(ignore or ()),
            unmapped=tuple(unmapped or ()),
            keyframe_meters=keyframe_meters,
            localize_meters=localize_meters,
            spool_bytes=int(min(spool_mb * 1e6, LARGEST_SPOOL)),
            model=model,
        )
        key = os.environ.get(KEY_VARIABLE)
        outputs = outputs_of(trajectory, mcap, events)
        with live_agent(settings, service, key, wait, outputs) as agent:
            if live:
                listen(agent, live)
            elif playback:
                drive(agent, playback, speed if realtime else None)
        summary = agent.close()
        if upload and not summary.segments and not agent.first_scan:
            tell(
                f"nothing is mapped: {summary.scans} scans gave no segment that can be stored. "
                "'placecell inspect' checks the source."
            )
        left = summary.spool.entries
        if left:
            where = f"They stay in {state}; run the command again." if state else "They are lost."
            typer.echo(f"placecell: {left} edits could not be sent. {where}", err=True)
    if as_json:
        print_json(asdict(summary))
    else:
        print_summary(summary, title)


def open_live(source: str) -> "ZenohAddress":
    """Parse the address of a live source; the packages for it must be there."""
    from robot.zenoh.address import ZenohAddress
    from robot.zenoh.bus import zenoh_modules

    address = ZenohAddress.of(source)
    zenoh_modules()
    return address


def listen(agent: "RobotAgent", address: "ZenohAddress") -> None:
    """Give the agent what a robot publishes, until SIGINT or SIGTERM."""
    from placecell.trajectories.extrinsic import parse_extrinsic
    from robot.node.settings import NodeSettings
    from robot.zenoh.node import run_on_zenoh

    options = current_scan_options()
    mount = None if options.extrinsic is None else parse_extrinsic(options.extrinsic)
    settings = NodeSettings(map_frame=address.map_frame, mount=mount, deskew=options.deskew)
    stop = threading.Event()
    before = {
        number: signal.signal(number, lambda *_: stop.set())
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        run_on_zenoh(agent, address, settings, stop, tell)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


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
        Path(folder),
        seed=seed,
        scans=TOWN_SCANS,
        place=place,
        lidar=town.sensor(sensor),
        progress=show,
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
        agent.on_scan(scan.points, scan.time, scan.pose, scan.covariance)
        if speed is None:
            agent.wait(10.0)
        for message in agent.messages:
            tell(message)


def tell(message: str) -> None:
    """Show a line of the agent."""
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
