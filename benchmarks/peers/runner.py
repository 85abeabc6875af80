"""Runner of one peer in the peers' environment: answers all queries.

Run it by hand with:

    python -m benchmarks.peers.runner kiss-matcher FOLDER ANSWERS
"""

import time
from collections.abc import Sequence
from dataclasses import asdict
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
    "scan-context": {},
    "map-closures": {},
    "map-closures-level": {"density_map_resolution": 0.25, "level": True},
    "kiss-matcher": {},
    "kiss-matcher-3": {"candidates": 3},
    "kiss-matcher-map": {"candidates": 0},
}
"""Settings of each peer that differ from the defaults, chosen on the town of seed 7."""

REFINED = "+gicp"
"""Suffix of the name of a peer with refined poses."""

PACKAGES = ("numpy", "scipy", "map-closures", "kiss-matcher", "small-gicp")


class Locator(Protocol):
    """Interface of a peer; `parameters` are its settings."""

    parameters: Any

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""


def open_peer(name: str) -> Locator:
    """Return a peer by name, and import its package."""
    settings = PEERS[name]
    if name.startswith("map-closures"):
        from benchmarks.peers.map_closures import MapClosuresParameters, MapClosuresPeer

        return MapClosuresPeer(MapClosuresParameters(**settings))
    if name.startswith("kiss-matcher"):
        from benchmarks.peers.kiss_matcher import KissMatcherParameters, KissMatcherPeer

        return KissMatcherPeer(KissMatcherParameters(**settings))
    from benchmarks.peers.scan_context import ScanContextParameters, ScanContextPeer

    return ScanContextPeer(ScanContextParameters(**settings))


def run_locator(
    name: Annotated[str, typer.Argument(help=f"Name of the peer: {', '.join(PEERS)}.")],
    folder: Annotated[Path, typer.Argument(help="Folder with the map and the queries.")],
    answers: Annotated[Path, typer.Argument(help="Folder for PEER.jsonl.")],
    refine: Annotated[
        bool, typer.Option(help=f"Also write refined poses, to PEER{REFINED}.jsonl.")
    ] = False,
) -> None:
    """Answer all queries with one peer."""
    if name not in PEERS:
        raise typer.BadParameter(f"Unknown peer {name!r}. Known peers: {', '.join(PEERS)}.")
    locator, frames = open_peer(name), read_map(folder)
    started = time.perf_counter()
    locator.learn(frames)
    learning = time.perf_counter() - started
    plain, refined = [], []
    # The packages write to standard output, so the progress goes to standard error.
    for file in track(query_files(folder), name, console=Console(stderr=True)):
        cloud = np.load(file)
        started = time.perf_counter()
        estimate = locator.locate(cloud)
        spent = 1000 * (time.perf_counter() - started)
        plain.append(PeerAnswer(estimate, spent))
        if refine:
            started = time.perf_counter()
            estimate = refine_estimate(estimate, cloud, frames)
            refined.append(PeerAnswer(estimate, spent + 1000 * (time.perf_counter() - started)))
    peer = Peer(name, asdict(locator.parameters), versions(), learning)
    answers.mkdir(parents=True, exist_ok=True)
    write_answers(answers / f"{name}.jsonl", peer, plain)
    if refine:
        peer = Peer(name + REFINED, peer.settings, peer.versions, learning)
        write_answers(answers / f"{peer.name}.jsonl", peer, refined)


def refine_estimate(estimate: Estimate, cloud: Cloud, frames: Sequence[MapFrame]) -> Estimate:
    """Refine the pose of an estimate; import the package only when needed."""
    from benchmarks.peers.refinement import refine

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
