"""`placecell maps anchor`: the place of a map on the Earth."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.maps.connection import LOCAL, Name, Url, service
from cli.sources import clear_errors
from cli.tables import JsonFlag, print_json

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from placecell_client import MapAnchor

anchor = typer.Typer(
    help="Show, set, fit and remove the place of a map on the Earth (WGS 84).",
    no_args_is_help=True,
)

COLUMNS = 7
"""Columns of a file of fixes: x, y, z, latitude, longitude, height, accuracy."""


@anchor.command()
def show(name: Name, as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """Show the place of a map on the Earth."""
    with service(url) as client:
        found = client.anchor(name)
    if as_json:
        print_json(asdict(found))
    else:
        typer.echo(_text(found))


@anchor.command("set", context_settings={"ignore_unknown_options": True})
def set_anchor(
    name: Name,
    lat: Annotated[float, typer.Argument(help="Latitude, degrees, north positive.")],
    lon: Annotated[float, typer.Argument(help="Longitude, degrees, east positive.")],
    height: Annotated[float, typer.Option(help="Height above the WGS 84 ellipsoid, meters.")] = 0.0,
    yaw_deg: Annotated[
        float,
        typer.Option(help="Angle from east to the map's x axis, degrees, counter-clockwise."),
    ] = 0.0,
    accuracy: Annotated[
        float, typer.Option(min=0.0, help="Standard deviation of the position, meters.")
    ] = 0.0,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Set where the origin of a map is on the Earth, and the direction of its x axis."""
    with service(url) as client:
        found = client.set_anchor(name, lat, lon, height=height, yaw_deg=yaw_deg, accuracy=accuracy)
    if as_json:
        print_json(asdict(found))
    else:
        typer.echo(_text(found))


@anchor.command()
def fit(
    name: Name,
    file: Annotated[
        Path,
        typer.Argument(
            help="CSV file with a fix in each line: x, y, z of the antenna in the map (meters), "
            "latitude, longitude (degrees), height, standard deviation (meters)."
        ),
    ],
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Write nothing.")] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Fit the place of a map on the Earth to GNSS fixes of localized robots."""
    with clear_errors():
        rows = read_fixes(file)
    with service(url) as client:
        found = client.fit_anchor(
            name,
            rows[:, :3],
            rows[:, 3],
            rows[:, 4],
            heights=rows[:, 5],
            accuracies=rows[:, 6],
            dry_run=dry_run,
        )
    if as_json:
        print_json(
            {
                "anchor": asdict(found.anchor),
                "dry_run": found.dry_run,
                "yaw_deviation_deg": found.yaw_deviation_deg,
                "inliers": int(found.is_inlier.sum()),
                "residuals": found.residuals.tolist(),
            }
        )
        return
    typer.echo(_text(found.anchor))
    typer.echo(
        f"{found.is_inlier.sum()} of {len(rows)} fixes agree; their largest residual is "
        f"{found.residuals[found.is_inlier].max():.2f} m. Standard deviation of the yaw: "
        f"{found.yaw_deviation_deg:.2f} degrees."
        + (" Nothing was written (--dry-run)." if dry_run else "")
    )


@anchor.command()
def delete(name: Name, as_json: JsonFlag = False, url: Url = LOCAL) -> None:
    """Remove the place of a map on the Earth."""
    with service(url) as client:
        client.delete_anchor(name)
    if as_json:
        print_json({"map": name, "deleted": True})
    else:
        typer.echo(f"Map {name} has no place on the Earth.")


def read_fixes(file: Path) -> "NDArray[np.float64]":
    """Read a CSV file of fixes, float64 (n, 7); a line that begins with a letter is a header.

    Raises:
        ValueError: a line has another number of values, or a value is not a number.
    """
    import numpy as np

    rows = []
    for number, line in enumerate(file.read_text(encoding="utf-8-sig").splitlines(), start=1):
        if not line.strip() or line.strip()[0].isalpha() or line.lstrip().startswith("#"):
            continue
        try:
            values = [float(part) for part in line.split(",")]
        except ValueError:
            values = []
        if len(values) != COLUMNS or not np.isfinite(values).all():
            raise ValueError(
                f"{file}: line {number} is {line!r:.80}; expected seven numbers: x, y, z, "
                "latitude, longitude, height, accuracy."
            )
        rows.append(values)
    return np.array(rows, dtype=np.float64).reshape(-1, COLUMNS)


def _text(found: "MapAnchor") -> str:
    x, y, z = found.position
    note = "" if found.applies else f" It is not used: it belongs to the frame {found.frame}."
    return (
        f"Map {found.map}: point ({x:.2f}, {y:.2f}, {z:.2f}) is at {found.lat:.7f}, "
        f"{found.lon:.7f}, height {found.height:.2f} m, yaw {found.yaw_deg:.3f} degrees from east, "
        f"accuracy {found.accuracy:.2f} m.{note}"
    )
