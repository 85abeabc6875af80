"""Runner of one peer in the peers' environment: answers all queries.

Run it by hand with:

    python -m benchmarks.peers.runner kiss-matcher FOLDER ANSWERS
"""

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated, Any, Protocol

import numpy as np
import typer
from rich.console import Console
from rich.progress import track

from benchmarks.peers.exchange import (
    Cloud,
    Estimate,
    MapFrame,
    Peer,
    PeerAnswer,
    query_files,
    read_map,
    write_answers,
)

PEERS: dict[str, dict[str, Any]] = {
    "scan-context": {
        "clouds": "submap",
        "method": "GICP",
        "gates": [5.0, 1.0],
        "sure_below": 0.6,
    },
    "map-closures": {"clouds": "long", "density_map_resolution": 0.25, "level": True},
    "kiss-slam": {"clouds": "long", "level": True},
    "kiss-matcher": {"clouds": "submap", "voxel_size": 1.0, "least_inliers": 20},
    "fpfh-fgr": {"clouds": "submap", "voxel_size": 1.0, "least_overlap": 0.7},
}
"""Settings of each peer that differ from its authors' values.

They were chosen on drives that no table shows (docs/results/peers.md).
"""

VARIANTS: dict[str, list[dict[str, Any]]] = {
    "scan-context": [
        {"clouds": clouds, "radius": radius} | steps
        for clouds, radius in (("submap", 80.0), ("near", 40.0))
        for steps in ({}, {"method": "GICP", "gates": [5.0, 1.0]})
    ],
    "map-closures": [
        {"clouds": "long", "density_map_resolution": pixel, "level": level}
        for pixel in (0.5, 0.25)
        for level in (False, True)
    ],
    "kiss-slam": [
        {"clouds": "long", "density_map_resolution": pixel, "level": level}
        for pixel in (0.5, 0.25)
        for level in (False, True)
    ],
    "kiss-matcher": [
        {"clouds": clouds, "voxel_size": voxel}
        for clouds, voxel in (("submap", 1.0), ("submap", 0.5), ("near", 0.5), ("near", 0.3))
    ],
    "fpfh-fgr": [
        {"clouds": clouds, "voxel_size": voxel}
        for clouds, voxel in (("submap", 1.0), ("submap", 0.5), ("near", 0.5))
    ],
}
"""Settings to choose from, of each peer."""

REFINED = "+gicp"
"""Suffix of the name of a peer with refined poses."""

PACKAGES = ("numpy", "scipy", "map-closures", "kiss-matcher", "kiss-slam", "open3d", "small-gicp")


@dataclass(frozen=True, slots=True)
class System:
    """Peer with its settings, under the name of its row.

    Attributes:
        row: name of its row in the report.
        peer: name of the peer.
        settings: settings that differ from the defaults.
    """

    row: str
    peer: str
    settings: dict[str, Any]

    @property
    def clouds(self) -> str:
        """Return the kind of local maps that the peer reads."""
        return str(self.settings["clouds"])


def systems_of(peers: Sequence[str], *, choose: bool) -> list[System]:
    """Return the systems to measure: each peer, or all its variants.

    Args:
        peers: names of the peers.
        choose: whether to return the variants from which the settings are chosen.
    """
    if not choose:
        return [System(name, name, PEERS[name]) for name in peers]
    return [
        System(f"{name} {described(settings)}", name, settings)
        for name in peers
        for settings in VARIANTS[name]
    ]


def described(settings: Mapping[str, Any]) -> str:
    """Return settings as words of one line."""
    return ", ".join(f"{name}={value}" for name, value in settings.items())


class Locator(Protocol):
    """Interface of a peer; `parameters` are its settings."""

    parameters: Any

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""


def open_peer(name: str, settings: Mapping[str, Any]) -> Locator:
    """Return a peer by name, and import its package."""
    if name == "map-closures":
        from benchmarks.peers.systems.map_closures import MapClosuresParameters, MapClosuresPeer

        return MapClosuresPeer(MapClosuresParameters(**settings))
    if name == "kiss-slam":
        from benchmarks.peers.systems.kiss_slam import KissSlamParameters, KissSlamPeer

        return KissSlamPeer(KissSlamParameters(**settings))
    if name == "kiss-matcher":
        from benchmarks.peers.systems.kiss_matcher import KissMatcherParameters, KissMatcherPeer

        return KissMatcherPeer(KissMatcherParameters(**settings))
    if name == "fpfh-fgr":
        from benchmarks.peers.systems.fast_global import FastGlobalParameters, FastGlobalPeer

        return FastGlobalPeer(FastGlobalParameters(**settings))
    from benchmarks.peers.systems.registered_context import (
        RegisteredContextParameters,
        RegisteredContextPeer,
    )

    return RegisteredContextPeer(RegisteredContextParameters(**settings))


def run_locator(
    name: Annotated[str, typer.Argument(help=f"Name of the peer: {', '.join(PEERS)}.")],
    folder: Annotated[Path, typer.Argument(help="Folder with the map and the queries.")],
    answers: Annotated[Path, typer.Argument(help="Folder for ROW.jsonl.")],
    refine: Annotated[
        bool, typer.Option(help=f"Also write refined poses, to ROW{REFINED}.jsonl.")
    ] = False,
    row: Annotated[
        str | None, typer.Option(help="Name of the peer's row. (default: its name)")
    ] = None,
    settings: Annotated[
        str | None, typer.Option(help="Settings of the peer, JSON. (default: the chosen ones)")
    ] = None,
) -> None:
    """Answer all queries with one peer."""
    if name not in PEERS:
        raise typer.BadParameter(f"Unknown peer {name!r}. Known peers: {', '.join(PEERS)}.")
    system = System(row or name, name, PEERS[name] if settings is None else json.loads(settings))
    locator, frames = open_peer(name, system.settings), read_map(folder, system.clouds)
    started = time.perf_counter()
    locator.learn(frames)
    learning = time.perf_counter() - started
    plain, refined = [], []
    # The packages write to standard output, so the progress goes to standard error.
    files = query_files(folder, system.clouds)
    for file in track(files, system.row, console=Console(stderr=True)):
        cloud = np.load(file)
        started = time.perf_counter()
        estimate = locator.locate(cloud)
        spent = 1000 * (time.perf_counter() - started)
        plain.append(PeerAnswer(estimate, spent))
        if refine:
            started = time.perf_counter()
            estimate = refine_estimate(estimate, cloud, frames)
            refined.append(PeerAnswer(estimate, spent + 1000 * (time.perf_counter() - started)))
    peer = Peer(system.row, asdict(locator.parameters), versions(), learning)
    answers.mkdir(parents=True, exist_ok=True)
    write_answers(answers / f"{system.row}.jsonl", peer, plain)
    if refine:
        peer = Peer(system.row + REFINED, peer.settings, peer.versions, learning)
        write_answers(answers / f"{peer.name}.jsonl", peer, refined)


def refine_estimate(estimate: Estimate, cloud: Cloud, frames: Sequence[MapFrame]) -> Estimate:
    """Refine the pose of an estimate; import the package only when needed."""
    from benchmarks.peers.systems.registration import refine

    return refine(estimate, cloud, frames)


def versions() -> dict[str, str]:
    """Return the versions of the installed packages."""
    found = {}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


if __name__ == "__main__":
    typer.run(run_locator)
