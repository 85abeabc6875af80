"""Comparison of peers on the same queries."""

import json
import os
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.peers.comparison_folder import ANSWERS, has_answered, prepare_folder
from benchmarks.peers.exchange import read_answers
from benchmarks.peers.frames import Stretch, map_poses, near_map, query_poses
from benchmarks.peers.runner import REFINED, System, systems_of
from benchmarks.peers.score import score_peer
from evaluation.machine import machine
from evaluation.poses.queries import MAPPED_METERS
from placecell.segmentation.pipeline import Progress, silent

ROOT = Path(__file__).resolve().parents[2]


def compare_peers(
    mapped: Sequence[Stretch],
    asking: Sequence[Stretch],
    peers: Sequence[str],
    python: Path,
    folder: Path,
    *,
    refine: bool = True,
    most: int | None = None,
    seed: int = 0,
    resume: bool = False,
    choose: bool = False,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run and score all peers; return the report that `placecell bench peers` writes.

    Args:
        mapped: stretches that make the map.
        asking: stretches that make the queries.
        peers: names of the peers.
        python: Python interpreter of the peers' environment.
        folder: folder for the local maps and the answers.
        refine: whether to report each peer also with refined poses.
        most: largest number of queries, spread evenly; None: all.
        seed: random seed of the queries' headings.
        resume: whether to continue a stopped run of this comparison: keep its local maps, and run
            only peers that have no answers.
        choose: whether to measure all variants of each peer, from which its settings are chosen.
        progress: wraps the loops.

    Raises:
        ValueError: the environment does not exist, a peer failed, or there is nothing to resume.
    """
    if not python.is_file():
        raise ValueError(
            f"{python} does not exist. Run 'make peers' to build the peers' environment."
        )
    systems = systems_of(peers, choose=choose)
    prepare_folder(
        folder,
        mapped,
        asking,
        most=most,
        seed=seed,
        resume=resume,
        kinds=sorted({system.clouds for system in systems}),
        progress=progress,
    )
    poses, truth = map_poses(mapped), query_poses(asking, most, seed)
    blocks = mapped[0].drive is asking[0].drive
    within = np.full(len(truth), fill_value=True) if blocks else near_map(poses, truth)
    rows = []
    for system in systems:
        names = [system.row, system.row + REFINED] if refine else [system.row]
        if not (resume and has_answered(folder, system.settings, names, len(truth))):
            run_peer(system, folder, python, refine=refine)
        for name in names:
            peer, answers = read_answers(folder / ANSWERS / f"{name}.jsonl", len(truth))
            rows.append(score_peer(peer, answers, truth, within))
    parameters = mapped[0].parameters
    return {
        "rows": rows,
        "map_drive": mapped[0].drive.folder.name,
        "query_drive": asking[0].drive.folder.name,
        "map_frames": len(poses),
        "blocks": blocks,
        "mapped_metres": None if blocks else MAPPED_METERS,
        "protocol": parameters.protocol,
        "every": parameters.frame_step,
        "accumulated_scans": parameters.accumulated_scans,
        "local_map_radius": parameters.local_map_radius,
        "seed": seed,
        "machine": machine(),
    }


def run_peer(system: System, folder: Path, python: Path, *, refine: bool) -> None:
    """Run a peer in the peers' environment.

    Args:
        system: the peer with its settings.
        folder: folder of the local maps and the answers.
        python: Python interpreter of the peers' environment.
        refine: whether to refine the poses too.

    Raises:
        ValueError: the peer failed.
    """
    options = ["--row", system.row, "--settings", json.dumps(system.settings)]
    words = [system.peer, folder, folder / ANSWERS, "--refine" if refine else "--no-refine"]
    command = [str(each) for each in (python, "-m", "benchmarks.peers.runner", *words, *options)]
    # The peer can import our code, but not our installed packages.
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONNOUSERSITE": "1"}
    done = subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, check=False)
    if done.returncode:
        raise ValueError(
            f"Peer {system.row!r} failed with exit status {done.returncode}. Its output is above."
        )
