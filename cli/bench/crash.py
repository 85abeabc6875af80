"""`placecell bench crash`: the service killed while robots write."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors, show


def crash(
    kills: Annotated[int, typer.Option(min=1, help="How often it is killed.")] = 200,
    writers: Annotated[int, typer.Option(min=1, help="Robots that write at once.")] = 3,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Kill the service while robots write, and see whether anything is lost.

    Robots put, edit, restore, age, compact and delete maps of the real server over loopback; it is
    killed (SIGKILL) in the midst of such writes, of saving a cache, of a start. After each start
    every version of every map is held against what was acknowledged. Ends with status 1 if one is
    not there, or a map was ever seen that never was.
    """
    from benchmarks.durability.crash import run_crashes
    from benchmarks.durability.crasher import CrashPlan

    with clear_errors():
        report = run_crashes(CrashPlan(kills=kills, writers=writers), seed, progress=show)
        write_json(report, json_file)
    starts = report["restart_seconds"]
    typer.echo(
        f"{report['kills']} kills, {report['writes_acknowledged']:,} writes acknowledged: "
        f"{report['losses']} lost, {report['half_seen']} half seen, of "
        f"{report['versions_compared']:,} versions and {report['reads']:,} reads; "
        f"a start took {starts['p50']:.1f} s (p50), {starts['max']:.1f} s at most"
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if report["wrong"]:
        raise typer.Exit(1)
