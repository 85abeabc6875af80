"""A comparison's folder: local maps and answers, kept so that a run that was stopped can go on."""

import hashlib
import shutil
from collections.abc import Sequence
from pathlib import Path

from benchmarks.peers.exchange import read_answers
from benchmarks.peers.frames import Stretch, map_poses, query_poses, write_map, write_queries
from benchmarks.peers.runner import PEERS
from placecell.segmentation.pipeline import Progress, silent

STAMP = "comparison.sha256"
"""Written when all local maps are: of which comparison they are."""

ANSWERS = "answers"


def prepare_folder(
    folder: Path,
    mapped: Sequence[Stretch],
    asking: Sequence[Stretch],
    *,
    most: int | None = None,
    seed: int = 0,
    resume: bool = False,
    progress: Progress = silent,
) -> None:
    """Write the local maps that peers read; answers to others go.

    Args:
        resume: take what lies there.

    Raises:
        ValueError: it is to be resumed, and what lies there is of another comparison, or in part.
    """
    stamp, expected = folder / STAMP, digest(mapped, asking, most, seed)
    if resume:
        if not stamp.is_file() or stamp.read_text() != expected:
            raise ValueError(
                f"{folder}: holds no finished local maps of this comparison; leave out --resume"
            )
        return
    stamp.unlink(missing_ok=True)
    shutil.rmtree(folder / ANSWERS, ignore_errors=True)
    write_map(folder, mapped, progress)
    write_queries(folder, asking, most, seed, progress)
    stamp.write_text(expected)


def digest(
    mapped: Sequence[Stretch], asking: Sequence[Stretch], most: int | None, seed: int
) -> str:
    """SHA-256 of which frames of which drives are the map and the queries, and how made."""
    whole = hashlib.sha256()
    for stretch in (*mapped, *asking):
        whole.update(f"{stretch.drive.folder.resolve()} {stretch.parameters}".encode())
    for poses in (map_poses(mapped), query_poses(asking, most, seed)):
        whole.update(poses.tobytes())
    return whole.hexdigest()


def has_answered(folder: Path, name: str, rows: Sequence[str], queries: int) -> bool:
    """Whether a peer has answered all, as it is set now."""
    for row in rows:
        try:
            peer, _ = read_answers(folder / ANSWERS / f"{row}.jsonl", queries)
        except (OSError, ValueError):
            return False
        if not PEERS[name].items() <= peer.settings.items():
            return False
    return True
