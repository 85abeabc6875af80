"""`placecell bench attack`: attacks a service that the command starts."""

from typing import Annotated, Any

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.sources import clear_errors, show


def attack(
    case: Annotated[
        list[str] | None,
        typer.Option(
            "--case",
            metavar="ID",
            help="Case to run, such as A4; repeatable. (default: all cases)",
        ),
    ] = None,
    short: Annotated[
        bool, typer.Option("--short", help="Use smaller sizes and shorter times, for CI.")
    ] = False,
    memory_limit_mb: Annotated[
        float,
        typer.Option(
            min=100,
            help="Resident memory limit of the service, MB; above it the service is killed.",
        ),
    ] = 1_000.0,
    victim_seconds: Annotated[
        float,
        typer.Option(
            min=0.01, help="Longest allowed wait of another key's small request, seconds."
        ),
    ] = 1.0,
    json_file: JsonFile = None,
    seed: Drawn = 0,
) -> None:
    """Attack a service and report which attacks it withstands.

    Each case starts its own service on the loopback interface, attacks it as one client could,
    and measures how long another key's small requests (the victim) wait. A case fails if the
    service dies or exceeds the memory limit, if the victim waits too long, if an acknowledged write
    is lost, or if the service gives a wrong answer. The command ends with status 1 if a case fails.
    """
    from benchmarks.attack.suite import AttackPlan, failures, run_attacks

    def tell(name: str, result: dict[str, Any]) -> None:
        outcome = "held" if result["held"] else "FAILED"
        typer.echo(
            f"{name:4} {outcome:6} peak {result['peak_mb']:5.0f} MB, "
            f"victim {result['victim_max_s']:6.2f} s (idle {result['victim_idle_max_s']:.2f} s), "
            f"lost {result['lost']}, {result['seconds']:.0f} s"
        )

    with clear_errors():
        plan = AttackPlan(tuple(case or ()), short, memory_limit_mb, victim_seconds, seed)
        report = run_attacks(plan, progress=show, report_case=tell)
        write_json(report, json_file)
    typer.echo(f"{report['held']} cases held, {report['failed']} failed, {report['seconds']:.0f} s")
    for line in failures(report):
        typer.echo(line, err=True)
    if report["failed"]:
        raise typer.Exit(1)
