"""`placecell bench crash` and `powerloss`: whether what was promised holds when all goes wrong."""

from typing import Annotated, Any

import typer

from cli.benches.options import JsonFile, write_json
from cli.sources import clear_errors

Drawn = Annotated[int, typer.Option("--seed", help="Of everything that is drawn.")]


def crash(
    kills: Annotated[int, typer.Option(min=1, help="How often the service is killed.")] = 200,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Kill the service with SIGKILL, again and again, while robots write to it.

    After each start every write that was acknowledged must be there, and every version whole; ends
    with status 1 if one is not. Kills fall into uploads, edits, index saves, compactions, starts.
    """
    from rich.console import Console

    from bench.crash import Plan
    from bench.crash import crash as run

    with clear_errors(), Console(stderr=True).status("killing") as status:
        report = run(Plan(kills=kills), seed, progress=status.update)
    finish(report, f"{kills} kills, {report['writes_acknowledged']:,} writes", json_file)


def powerloss(
    writes: Annotated[int, typer.Option(min=1, help="Writes to the service.")] = 60,
    cuts: Annotated[int, typer.Option(min=0, help="Of the power; 0: at every step.")] = 0,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Cut the power at each step of what the service writes to the disk, and start it again.

    Records its writes, renames and fsyncs with strace (which must be installed), makes every disk
    that may be left (nothing, all, or some of the sectors that no fsync covers), opens each, and
    checks the acknowledged writes; ends with status 1 if one is lost.
    """
    from rich.console import Console

    from bench.powerloss import Plan
    from bench.powerloss import powerloss as run

    with clear_errors(), Console(stderr=True).status("recording") as status:
        report = run(Plan(writes=writes, cuts=cuts), seed, progress=status.update)
    finish(report, f"{report['power_cuts']:,} cuts, {writes} writes", json_file)


def finish(report: dict[str, Any], what: str, json_file: JsonFile) -> None:
    """Write and tell what came of it."""
    write_json(report, json_file)
    typer.echo(f"{what}: {report['losses']} lost, {report['half_seen']} half seen")
    for wrong in report["wrong"]:
        typer.echo(wrong, err=True)
    if report["losses"] or report["half_seen"] or report["wrong"]:
        raise typer.Exit(1)
