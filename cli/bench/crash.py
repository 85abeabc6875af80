"""`placecell bench crash`: kills the service while robots write."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors, show


def crash(
    kills: Annotated[
        int, typer.Option(min=1, help="Number of times that the service is killed.")
    ] = 200,
    writers: Annotated[
        int, typer.Option(min=1, help="Number of robots that write concurrently.")
    ] = 3,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Kill the service while robots write, and check that nothing is lost.

    Robots put, edit, restore, prune, compact and delete maps on a real server over loopback.
    SIGKILL ends the server during such writes, while it saves a cache, and while it starts. After
    each start the command compares every version of every map with the acknowledged writes. It ends
    with status 1 if a version is lost, or if a reader saw a map that was never written.
    """
    from benchmarks.durability.crash import run_crashes
    from benchmarks.durability.crasher import CrashPlan

    with clear_errors():
        report = run_crashes(CrashPlan(kills=kills, writers=writers), seed, progress=show)
        write_json(report, json_file)
    starts = report["restart_seconds"]
    typer.echo(
        f"{report['kills']} kills, {report['writes_acknowledged']:,} acknowledged writes: "
        f"{report['losses']} of {report['versions_compared']:,} compared versions are lost, "
        f"{report['half_seen']} of {report['reads']:,} reads saw a partial write. "
        f"A start took {starts['p50']:.1f} s (p50), at most {starts['max']:.1f} s."
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if report["wrong"]:
        raise typer.Exit(1)
