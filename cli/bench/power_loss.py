"""`placecell bench powerloss`: a power cut at every moment."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors, show


def powerloss(
    writes: Annotated[int, typer.Option(min=2, help="To the service.")] = 60,
    cuts: Annotated[
        int, typer.Option(min=0, help="Moments at which the power is cut, about; 0: all.")
    ] = 0,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Cut the power at every moment, and see whether anything is lost.

    Needs strace. The real server is written to; what it does to its disk is recorded and replayed
    up to every moment, onto a disk that keeps what was synced, and of the rest nothing, all, or
    what chance will, down to single sectors. What is left is opened with the store. Ends with
    status 1 if an acknowledged write is not there, or the maps are of no one moment.
    """
    from benchmarks.durability.power_loss.power_cuts import PowerLossPlan, run_power_cuts

    with clear_errors():
        report = run_power_cuts(PowerLossPlan(writes=writes, cuts=cuts), seed, progress=show)
        write_json(report, json_file)
    typer.echo(
        f"{report['power_cuts']:,} power cuts, {report['distinct_disks']:,} different disks: "
        f"{report['losses']} with a loss, {report['half_seen']} with a map half there"
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if report["wrong"]:
        raise typer.Exit(1)
