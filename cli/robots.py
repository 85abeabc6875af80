"""`placecell robots`: lists the last pose of each robot."""

import typer

from cli.maps.connection import LOCAL, Url, service
from cli.tables import JsonFlag, new_table, print_json, print_tables


def robots(as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """List the robots that reported to a service: last pose, age, state, and how sure it is."""
    with service(url) as client:
        found = client.robots()
    if as_json:
        print_json(
            {
                "robots": [
                    {
                        "robot": each.robot,
                        "map": each.map,
                        "position": None if each.position is None else each.position.tolist(),
                        "probability": each.probability,
                        "state": each.state,
                        "reason": each.reason,
                        "age": each.age,
                        "pose_age": each.pose_age,
                        "source": each.source,
                    }
                    for each in found
                ]
            }
        )
        return
    table = new_table("robot", "map", "x, y, z (m)", "pose age (s)", "probability", "state")
    for each in found:
        position = "" if each.position is None else ", ".join(f"{v:.1f}" for v in each.position)
        table.add_row(
            each.robot,
            each.map or "",
            position,
            "" if each.pose_age is None else f"{each.pose_age:.0f}",
            "" if each.probability is None else f"{each.probability:.3f}",
            f"{each.state}: {each.reason}" if each.reason else each.state,
        )
    print_tables(table)
    if not found:
        typer.echo("No robot reported within the last hour.")
