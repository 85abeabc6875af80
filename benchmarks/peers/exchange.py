"""Files that go to a peer and come back. Both environments load this module; it needs only NumPy.

The folders `map` and `queries` hold one file `NNNNNN.npy` per local map: float32 (n, 3), meters, in
a level frame with its origin at the sensor. The folder `map` also holds `poses.npy`. Peers that are
made for larger local maps read `map-KIND` and `queries-KIND` instead (`wide_maps.py`). No file
holds the true poses of the queries. Answers are JSON lines: first the peer, then one line per
query.
"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Cloud = NDArray[np.float32]
Pose = NDArray[np.float64]

MAP, QUERIES, POSES = "map", "queries", "poses.npy"

NEAR = "near"
"""Kind of the local maps that our segmentation gets."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """Pose of a query by a peer.

    Attributes:
        pose: transform (4, 4) from the query's frame to the map's, float64; None: no pose.
        score: the peer's own score; a higher score is more certain.
        sure: whether the peer's own rule accepts the pose.
        evidence: figures on which the rule decides, by name.
    """

    pose: Pose | None
    score: float
    sure: bool
    evidence: dict[str, float] = field(default_factory=dict)


NOTHING = Estimate(None, float("-inf"), sure=False)


@dataclass(frozen=True, slots=True)
class PeerAnswer:
    """Estimate of a peer, and the time from the points of the local map to the pose."""

    estimate: Estimate
    milliseconds: float


@dataclass(frozen=True, slots=True)
class Peer:
    """Name and settings of a peer.

    Attributes:
        name: name of the peer.
        settings: parameters of the peer.
        versions: versions of the installed packages.
        learning_seconds: time to take in the map before the first query, seconds.
    """

    name: str
    settings: dict[str, Any]
    versions: dict[str, str] = field(default_factory=dict)
    learning_seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class MapFrame:
    """One local map of the map.

    Attributes:
        pose: transform (4, 4) from its frame to the map's, float64.
        cloud: float32 (n, 3), points in its own frame, meters.
    """

    pose: Pose
    cloud: Cloud


def cloud_file(folder: Path, index: int) -> Path:
    """Return the file of a local map."""
    return folder / f"{index:06d}.npy"


def folder_of(folder: Path, part: str, kind: str = NEAR) -> Path:
    """Return the folder of the map's or the queries' local maps of a kind."""
    return folder / (part if kind == NEAR else f"{part}-{kind}")


def read_map(folder: Path, kind: str = NEAR) -> list[MapFrame]:
    """Read the local maps of the map; their points are loaded on first use."""
    clouds = folder_of(folder, MAP, kind)
    return [
        MapFrame(pose, np.load(cloud_file(clouds, index), mmap_mode="r"))
        for index, pose in enumerate(np.load(clouds / POSES))
    ]


def query_files(folder: Path, kind: str = NEAR) -> list[Path]:
    """Return the files of the queries' local maps, in order."""
    return sorted(folder_of(folder, QUERIES, kind).glob("*.npy"))


def write_answers(file: Path, peer: Peer, answers: Iterable[PeerAnswer]) -> None:
    """Write the peer and its answers as JSON lines."""
    with file.open("w") as lines:
        lines.write(json.dumps(asdict(peer)) + "\n")
        for answer in answers:
            estimate = answer.estimate
            pose = None if estimate.pose is None else np.asarray(estimate.pose).tolist()
            row = {
                "pose": pose,
                "score": estimate.score if pose else None,
                "sure": estimate.sure,
                "milliseconds": answer.milliseconds,
                "evidence": estimate.evidence,
            }
            lines.write(json.dumps(row) + "\n")


def read_answers(file: Path, queries: int) -> tuple[Peer, list[PeerAnswer]]:
    """Read the peer and its answers.

    Args:
        file: file of the answers.
        queries: expected number of answers.

    Raises:
        ValueError: the file is incomplete or is no file of answers.
    """
    try:
        head, *rows = [json.loads(line) for line in file.read_text().splitlines()]
        peer, answers = Peer(**head), [answer_of(row) for row in rows]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{file} is not a file of a peer's answers ({error}).") from error
    if len(answers) != queries:
        raise ValueError(f"{file} has {len(answers)} answers; {queries} were expected.")
    return peer, answers


def answer_of(row: dict[str, Any]) -> PeerAnswer:
    """Parse the answer of one line.

    Raises:
        KeyError, TypeError, ValueError: a field is missing, or the pose is not a transform.
    """
    milliseconds = float(row["milliseconds"])
    if row["pose"] is None:
        return PeerAnswer(NOTHING, milliseconds)
    pose = np.array(row["pose"], dtype=np.float64)
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise ValueError("The pose must have four rows of four finite numbers.")
    evidence = {str(name): float(figure) for name, figure in row.get("evidence", {}).items()}
    estimate = Estimate(pose, float(row["score"]), bool(row["sure"]), evidence)
    return PeerAnswer(estimate, milliseconds)


def nearest_frame(frames: Sequence[MapFrame], pose: Pose) -> MapFrame:
    """Return the local map of the map whose origin is nearest to a pose."""
    origins = np.stack([frame.pose[:3, 3] for frame in frames])
    return frames[int(np.linalg.norm(origins - pose[:3, 3], axis=1).argmin())]
