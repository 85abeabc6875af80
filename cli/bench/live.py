"""`placecell bench live`: localizes a robot that drives through a town and is kidnapped."""

from typing import Annotated

import typer

from cli.bench.options import JsonFile, write_json
from cli.drive_options import tell
from cli.sources import clear_errors


def live(
    meters: Annotated[float, typer.Option(min=400.0, help="Length of the drive, meters.")] = 5000.0,
    kidnaps: Annotated[
        int, typer.Option(min=0, help="Number of times that the robot is carried away.")
    ] = 20,
    spacing: Annotated[
        float, typer.Option(min=0.1, help="Distance between two scans, meters.")
    ] = 1.0,
    sensor: Annotated[str, typer.Option(metavar="NAME", help="Simulated sensor.")] = "hdl-64e",
    columns: Annotated[
        int | None,
        typer.Option(min=16, help="Azimuth steps per revolution. (default: the sensor's own)"),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of town, routes and noise.")] = 7,
    json_file: JsonFile = None,
) -> None:
    """Localize a robot live in a simulated town, against the map of another robot.

    The other robot drives all streets the other way with its own agent, but leaves out 200 m in the
    middle. The robot has drifting odometry. Its first leg crosses the part without a map; then it
    is carried away to random places. Every pose is compared with the truth. The command ends with
    status 1 if a pose is wrong but sure.
    """
    from benchmarks.live.live import LivePlan, run_live

    with clear_errors():
        plan = LivePlan(
            meters=meters,
            kidnaps=kidnaps,
            spacing=spacing,
            sensor_name=sensor,
            columns=columns,
            seed=seed,
        )
        report = run_live(plan, tell)
        write_json(report, json_file)
    until = [each for each in report["meters_until_localized"] if each is not None]
    typer.echo(
        f"{report['meters']:,.0f} m, {report['kidnaps']} kidnaps: localized "
        f"{len(until)} of {report['kidnaps'] + 1} times, after at most {max(until, default=0)} m "
        "inside the map. "
        f"Worst offset {report['worst_offset_m']} m and {report['worst_angle_deg']} degrees there, "
        f"{report['wrong_but_sure']} poses wrong but sure. Leaving the map was "
        f"{'' if report['left_noticed'] else 'not '}noticed, coming back was "
        f"{'' if report['returned_noticed'] else 'not '}noticed."
    )
    if report["wrong_but_sure"]:
        raise typer.Exit(1)
