"""`placecell bench fleet`: robots share a map over unreliable links."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors


def fleet(
    minutes: Annotated[float, typer.Option(min=0.05, help="Duration, minutes.")] = 5.0,
    clients: Annotated[int, typer.Option(min=2, help="Number of robots.")] = 8,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Let robots share a map while links are cut and the service is killed and restarted.

    Each robot edits its own segments and pulls the changes of the others. The command ends with
    status 1 unless all robots end with the same map, byte for byte, and the map holds exactly the
    acknowledged writes.
    """
    from benchmarks.durability.fleet import FleetPlan, run_fleet

    with clear_errors():
        report = run_fleet(FleetPlan(clients=clients, seconds=60 * minutes), seed)
        write_json(report, json_file)
    typer.echo(
        f"{report['clients']} robots, {report['edits_acknowledged']:,} edits, "
        f"{report['pulls']:,} pulls. {report['connections_cut']} connections were cut; the service "
        f"was killed {report['kills']} times and stopped {report['stops']} times."
    )
    typer.echo(
        f"{report['robots_with_the_service_s_map']} robots have the service's map of "
        f"{report['segments']:,} segments. It is {'' if report['map_is_the_union'] else 'not '}"
        f"the union of all acknowledged edits. {report['ids_reserved_twice']} ids were reserved "
        "twice."
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if not report["good"]:
        raise typer.Exit(1)
