"""`placecell bench fleet`: robots that share a map over links that break."""

from typing import Annotated

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors


def fleet(
    minutes: Annotated[float, typer.Option(min=0.05, help="How long.")] = 5.0,
    clients: Annotated[int, typer.Option(min=2, help="Robots.")] = 8,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Let robots share a map while links are cut and the service is killed and restarted.

    Each edits segments of its own and pulls what the others changed. Ends with status 1 unless all
    end with the same map, byte for byte, that holds what was acknowledged and nothing else.
    """
    from benchmarks.durability.fleet import FleetPlan, run_fleet

    with clear_errors():
        report = run_fleet(FleetPlan(clients=clients, seconds=60 * minutes), seed)
        write_json(report, json_file)
    typer.echo(
        f"{report['clients']} robots, {report['edits_acknowledged']:,} edits, "
        f"{report['pulls']:,} pulls; {report['connections_cut']} connections cut, the service "
        f"killed {report['kills']} and stopped {report['stops']} times"
    )
    typer.echo(
        f"{report['robots_with_the_service_s_map']} robots have the service's map of "
        f"{report['segments']:,} segments; it is {'' if report['map_is_the_union'] else 'not '}"
        f"the union of theirs; {report['ids_reserved_twice']} ids were given twice"
    )
    for told in report["wrong"]:
        typer.echo(told, err=True)
    if not report["good"]:
        raise typer.Exit(1)
