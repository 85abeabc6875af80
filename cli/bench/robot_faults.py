"""`placecell bench robot-faults`: kills the robot's agent and the service, and cuts the link."""

from typing import Annotated

import typer

from cli.bench.options import JsonFile, write_json
from cli.drive_options import tell
from cli.sources import clear_errors


def robot_faults(
    source: Annotated[str, typer.Argument(help="Drive, as 'placecell robot' takes it.")],
    kills: Annotated[
        int, typer.Option(min=0, help="Number of times that the agent is killed.")
    ] = 50,
    restarts: Annotated[
        int, typer.Option(min=0, help="Number of times that the service is killed and restarted.")
    ] = 5,
    cut_seconds: Annotated[
        float, typer.Option(min=0.0, help="Duration of one long cut of the link, seconds.")
    ] = 600.0,
    seed: Annotated[int, typer.Option(help="Seed of the moments of all faults.")] = 0,
    json_file: JsonFile = None,
) -> None:
    """Check that faults do not change the map that a robot makes.

    The agent is killed with SIGKILL at random moments and started again, the service is killed and
    restarted, connections are cut at random bytes, and the link is cut once for a long time. The
    map must be equal, byte for byte, to that of a run without faults. The command ends with status
    1 if it is not.
    """
    from benchmarks.live.faults import FaultPlan, run_faults

    with clear_errors():
        plan = FaultPlan(source, kills, restarts, cut_seconds, seed=seed)
        report = run_faults(plan, tell)
        write_json(report, json_file)
    typer.echo(
        f"{report['kills']} kills of the agent, {report['service_kills']} of the service, "
        f"{report['connections_cut']} connections cut: the map is "
        f"{'equal byte for byte' if report['equal_bytes'] else 'NOT equal'} "
        f"({report['segments_found']:,} of {report['segments_expected']:,} segments, "
        f"{report['segments_twice']} twice). Fixes: {report['fixes']['service']} of the service, "
        f"{report['fixes']['local']} in the pulled map."
    )
    if not report["equal_bytes"]:
        raise typer.Exit(1)
