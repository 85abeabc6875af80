"""`placecell bench powerloss`: simulates power cuts during writes."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors, show


def powerloss(
    writes: Annotated[int, typer.Option(min=2, help="Number of writes to the service.")] = 60,
    cuts: Annotated[
        int,
        typer.Option(
            min=0, help="Approximate number of simulated power cuts; 0: one at every moment."
        ),
    ] = 0,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Simulate power cuts at every moment, and check that nothing is lost.

    The command needs strace. It writes to a real server and records the server's disk operations.
    It replays them up to each moment on a simulated disk, which keeps all synced data and none, all
    or a random part of the rest, down to single sectors. Then it opens the result with the store.
    It ends with status 1 if an acknowledged write is lost, or if the maps do not belong to one
    moment.
    """
    from benchmarks.durability.power_loss.power_cuts import PowerLossPlan, run_power_cuts

    with clear_errors():
        report = run_power_cuts(PowerLossPlan(writes=writes, cuts=cuts), seed, progress=show)
        write_json(report, json_file)
    typer.echo(
        f"{report['power_cuts']:,} power cuts, {report['distinct_disks']:,} different disks: "
        f"{report['losses']} lost a write, {report['half_seen']} hold a partial map"
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if report["wrong"]:
        raise typer.Exit(1)
