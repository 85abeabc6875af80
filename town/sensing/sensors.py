"""Catalog of the simulated sensors; docs/explanation/sensors.md has the sources of the values."""

from dataclasses import replace

import numpy as np

from town.sensing.lidar import HDL_64E, Lidar
from town.sensing.rosette import Rosette

MOUNTS = (0.3, 3.0)
"""Lowest and highest mounting height of a sensor above the ground, meters."""


def evenly(highest: float, lowest: float, beams: int) -> tuple[float, ...]:
    """Return evenly spaced elevations, degrees, from the highest to the lowest beam."""
    return tuple(float(angle) for angle in np.linspace(highest, lowest, beams))


HDL_32E = Lidar(
    columns=2170,
    elevations=evenly(10.67, -30.67, 32),
    height=1.73,
    range_noise=0.02,
    min_range=1.0,
    max_range=100.0,
    range_at_tenth=35.4,
)

VLP_16 = Lidar(
    columns=1808,
    elevations=evenly(15.0, -15.0, 16),
    height=0.6,
    range_noise=0.03,
    min_range=1.0,
    max_range=100.0,
    range_at_tenth=35.4,
)

OS0 = Lidar(
    columns=1024,
    height=1.0,
    range_noise=0.03,
    resolution=0.003,
    dropout=0.04,
    min_range=0.3,
    max_range=50.0,
    range_at_tenth=20.0,
)

OS1 = Lidar(
    columns=1024,
    height=1.73,
    range_noise=0.02,
    resolution=0.003,
    dropout=0.04,
    min_range=0.3,
    max_range=120.0,
    range_at_tenth=45.0,
)

SOLID_STATE = Rosette(
    columns=4000,
    elevations=evenly(3.4, -3.4, 6),
    height=1.0,
    range_noise=0.02,
    resolution=0.001,
    min_range=1.0,
    max_range=120.0,
    range_at_tenth=190.0,
)

SENSORS: dict[str, Lidar] = {
    "hdl-64e": HDL_64E,
    "hdl-32e": HDL_32E,
    "vlp-16": VLP_16,
    **{f"os0-{beams}": replace(OS0, elevations=evenly(45, -45, beams)) for beams in (32, 64, 128)},
    **{
        f"os1-{beams}": replace(OS1, elevations=evenly(22.5, -22.5, beams))
        for beams in (32, 64, 128)
    },
    "solid-state": SOLID_STATE,
}


def sensor(
    name: str,
    *,
    columns: int | None = None,
    mount: float | None = None,
    rain: float = 0.0,
    dropout: float | None = None,
) -> Lidar:
    """Return a sensor of the catalog.

    Args:
        name: name of the sensor.
        columns: number of azimuth steps, or shots of each laser; None for the sensor's own.
        mount: height above the ground, meters; None for that of the sensor's usual carrier.
        rain: rain rate, millimeters per hour.
        dropout: share of the returns that are lost; None for the sensor's own.

    Raises:
        ValueError: The name is unknown, or a value is out of range.
    """
    if name not in SENSORS:
        raise ValueError(f"Unknown sensor {name!r}: expected one of {', '.join(SENSORS)}.")
    if mount is not None and not MOUNTS[0] <= mount <= MOUNTS[1]:
        raise ValueError(
            f"Invalid mounting height {mount} m: expected {MOUNTS[0]} to {MOUNTS[1]} m above the "
            "ground."
        )
    found = SENSORS[name]
    return replace(
        found,
        columns=found.columns if columns is None else columns,
        height=found.height if mount is None else mount,
        dropout=found.dropout if dropout is None else dropout,
        rain=rain,
    )
