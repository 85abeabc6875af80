"""Stand-ins for the simulated drives of the town: small, and with a known content."""

from pathlib import Path
from typing import Any

import pytest

import town
from tests.benchmarks.drive_builders import trip


def replace_town(patched: pytest.MonkeyPatch, blind: str = "") -> list[dict[str, Any]]:
    """Replace the simulation of two robots by two short trips; return the arguments of each call.

    Args:
        patched: the test's patches.
        blind: sensor of robots that see nothing.
    """
    calls: list[dict[str, Any]] = []

    def two_robots(folder: Path, *, scans: int, lidar: str, **words: Any) -> tuple[Path, Path]:
        calls.append({"lidar": lidar, "scans": scans, **words})
        left = range(scans if lidar == blind else 0)
        names = ("robot_a", "robot_b")
        # Maps of two sensors must differ.
        unseen = 1 if lidar == "narrow" else 0
        one, other = (trip(folder / name, scans, left, unseen).folder for name in names)
        return one, other

    def sensor(name: str) -> str:
        if name == "unknown":
            raise ValueError(f"Unknown sensor {name!r}")
        return name

    patched.setattr(town, "two_robots", two_robots)
    patched.setattr(town, "sensor", sensor, raising=False)
    patched.setattr(town, "SENSORS", {"wide": None, "narrow": None}, raising=False)
    return calls
