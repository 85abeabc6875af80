"""Folder of a comparison: local maps and answers, from which a stopped run continues."""

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.peers.exchange import NEAR, read_answers
from benchmarks.peers.frames import Stretch, map_poses, query_poses, write_map, write_queries
from placecell.segmentation.pipeline import Progress, silent

STAMP = "comparison.sha256"
"""File with the hash of the comparison and the kinds of its local maps, written after them."""

ANSWERS = "answers"


def prepare_folder(
    folder: Path,
    mapped: Sequence[Stretch],
    asking: Sequence[Stretch],
    *,
    most: int | None = None,
    seed: int = 0,
    resume: bool = False,
    kinds: Sequence[str] = (NEAR,),
    progress: Progress = silent,
) -> None:
    """Write the local maps of a comparison and delete answers of other comparisons.

    Args:
        folder: folder of the comparison.
        mapped: stretches that make the map.
        asking: stretches that make the queries.
        most: largest number of queries, spread evenly; None: all.
        seed: random seed of the queries' headings.
        resume: whether to keep the local maps and answers in the folder.
        kinds: kinds of the local maps that the peers need.
        progress: wraps the loops.

    Raises:
        ValueError: `resume` is set, and the folder has no complete local maps of this comparison.
    """
    stamp, expected = folder / STAMP, digest(mapped, asking, most, seed)
    if resume:
        written, *has = stamp.read_text().split() if stamp.is_file() else [""]
        if written != expected or not set(kinds) <= set(has):
            raise ValueError(
                f"{folder} has no complete local maps of this comparison. Run without --resume."
            )
        return
    stamp.unlink(missing_ok=True)
    shutil.rmtree(folder / ANSWERS, ignore_errors=True)
    write_map(folder, mapped, progress, kinds)
    write_queries(folder, asking, most, seed, progress, kinds)
    stamp.write_text(" ".join([expected, *kinds]))


def digest(
    mapped: Sequence[Stretch], asking: Sequence[Stretch], most: int | None, seed: int
) -> str:
    """Return the SHA-256 of a comparison: its drives, parameters and poses."""
    whole = hashlib.sha256()
    for stretch in (*mapped, *asking):
        whole.update(f"{stretch.drive.folder.resolve()} {stretch.parameters}".encode())
    for poses in (map_poses(mapped), query_poses(asking, most, seed)):
        whole.update(poses.tobytes())
    return whole.hexdigest()


def has_answered(
    folder: Path, settings: Mapping[str, Any], rows: Sequence[str], queries: int
) -> bool:
    """Return whether the folder has all answers of a peer with its present settings.

    Args:
        folder: folder of the comparison.
        settings: settings of the peer.
        rows: names of the peer's rows in the report.
        queries: number of queries.
    """
    for row in rows:
        try:
            peer, _ = read_answers(folder / ANSWERS / f"{row}.jsonl", queries)
        except (OSError, ValueError):
            return False
        if not settings.items() <= peer.settings.items():
            return False
    return True
