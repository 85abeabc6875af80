"""The examples of the page on the HTTP API: what they need, and how they are run."""

import json
import re
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import Client, CompactMap, Delta, encode, encode_delta
from placecell_client.maps.edit import take

from placecell.core.geodesy import GeoAnchor, to_geodetic
from tests.service.clouds.scan_files import scan_file

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "http-api.md"
LOCAL = "http://127.0.0.1:8000"

SILENT = 'curl() { command curl --silent --show-error --fail-with-body "$@"; }\nset -e\n'
"""Shell prelude: an error status ends the example."""

PART_BYTES = 10_000


@dataclass(frozen=True)
class Example:
    """One route's example.

    Attributes:
        route: such as `GET /maps`.
        commands: shell commands.
        answer: what the page shows of the last command's answer; empty if nothing.
    """

    route: str
    commands: str
    answer: str


def examples(text: str) -> Iterator[Example]:
    """Yield the examples of the page, in order."""
    for section in re.split(r"^### ", text, flags=re.MULTILINE)[1:]:
        route = re.match(r"`([A-Z]+ /[^`]*)`", section)
        if route is None:
            continue
        commands = re.search(r"```sh\n(.*?)```\n", section, re.DOTALL)
        assert commands is not None, f"{route[1]}: the page has no example"
        shown = re.search(r"```json\n(.*?)```\n", section[commands.end() :], re.DOTALL)
        yield Example(route[1], commands[1], shown[1] if shown else "")


def prepare(
    client: Client,
    folder: Path,
    yard: CompactMap,
    newer: CompactMap,
    hall: CompactMap,
    clouds: Sequence[np.ndarray],
    sensors: Sequence[Sequence[float]],
    edit: Delta,
) -> None:
    """Write the files that the examples name, and store the maps that they read."""
    data = encode(yard)
    (folder / "yard.map").write_bytes(data)
    (folder / "newer.map").write_bytes(encode(newer))
    (folder / "scan.pcd").write_bytes(scan_file("pcd")[2])
    (folder / "edit.delta").write_bytes(encode_delta(edit))
    (folder / "part-1").write_bytes(data[:PART_BYTES])
    (folder / "part-2").write_bytes(data[PART_BYTES:])
    scan: dict[str, Any] = {
        "segments": [
            {"points": np.round(points, 2).tolist(), "sensor": list(sensor)}
            for points, sensor in zip(clouds, sensors, strict=True)
        ]
    }
    (folder / "scan.json").write_text(json.dumps(scan))
    (folder / "match.json").write_text(json.dumps({"maps": ["yard"], "k": 2} | scan))
    (folder / "localize.json").write_text(json.dumps({"maps": ["yard"]} | scan))
    steps = np.linspace(0.0, 95.0, 20)
    places = to_geodetic(np.outer(steps, [1.0, 0.0, 0.0]), GeoAnchor(49.0112, 8.4243, 115.0, 37.0))
    fixes = [
        {"position": [x, 0.0, 0.0], "lat": lat, "lon": lon, "height": height, "accuracy": 1.0}
        for x, (lat, lon, height) in zip(steps.tolist(), places.tolist(), strict=True)
    ]
    (folder / "fixes.json").write_text(json.dumps({"fixes": fixes}))
    client.put_map("yard", data)
    client.put_map("hall", hall)
    client.put_map("shed", hall)
    client.put_map("far-yard", take(yard, np.zeros(0, np.int64)))


def run(example: Example, address: str, folder: Path) -> bytes:
    """Run the commands of an example; return the last command's answer.

    Raises:
        CalledProcessError: a command failed, or was refused.
    """
    *before, last = example.commands.replace(LOCAL, address).splitlines()
    script = "\n".join([*(f"{line} > /dev/null" for line in before), last])
    done = subprocess.run(
        ["bash", "-c", SILENT + script], cwd=folder, capture_output=True, timeout=60, check=False
    )
    assert done.returncode == 0, f"{example.route}: {done.stdout!r:.500} {done.stderr!r:.500}"
    return done.stdout
