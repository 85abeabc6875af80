"""What goes to a peer and what comes back, as files; NumPy alone, for both environments read it.

A folder `map` and a folder `queries`, each with `NNNNNN.npy`, a local map each: float32 (n, 3),
metres, about the sensor, level; the map's has `poses.npy` besides. The truth is in neither.
Answers are JSON lines: first the peer, then one a query.
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


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a peer says of a query.

    Attributes:
        pose: from the query's frame to the map's, float64 (4, 4), or none.
        score: the peer's own, the higher, the surer.
        sure: whether the peer's own rule accepts the pose.
    """

    pose: Pose | None
    score: float
    sure: bool


NOTHING = Estimate(None, float("-inf"), sure=False)


@dataclass(frozen=True, slots=True)
class PeerAnswer:
    """An estimate, with the time that it took from the local map's points on."""

    estimate: Estimate
    milliseconds: float


@dataclass(frozen=True, slots=True)
class Peer:
    """Who answers.

    Attributes:
        name: of the peer.
        settings: its parameters.
        versions: of the packages that do the work.
        learning_seconds: what it spent on the map before the first query.
    """

    name: str
    settings: dict[str, Any]
    versions: dict[str, str] = field(default_factory=dict)
    learning_seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class MapFrame:
    """A local map of the map.

    Attributes:
        pose: from its frame to the map's, float64 (4, 4).
        cloud: float32 (n, 3), metres, its own frame.
    """

    pose: Pose
    cloud: Cloud


def cloud_file(folder: Path, index: int) -> Path:
    """Where a local map lies."""
    return folder / f"{index:06d}.npy"


def read_map(folder: Path) -> list[MapFrame]:
    """The map's frames; their clouds stay on the disk until they are looked at."""
    return [
        MapFrame(pose, np.load(cloud_file(folder / MAP, index), mmap_mode="r"))
        for index, pose in enumerate(np.load(folder / MAP / POSES))
    ]


def query_files(folder: Path) -> list[Path]:
    """The queries' local maps, in order."""
    return sorted((folder / QUERIES).glob("*.npy"))


def write_answers(file: Path, peer: Peer, answers: Iterable[PeerAnswer]) -> None:
    """A line for the peer, then one a query."""
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
            }
            lines.write(json.dumps(row) + "\n")


def read_answers(file: Path, queries: int) -> tuple[Peer, list[PeerAnswer]]:
    """What a peer wrote.

    Raises:
        ValueError: it is cut short, or is not such a file.
    """
    try:
        head, *rows = [json.loads(line) for line in file.read_text().splitlines()]
        peer, answers = Peer(**head), [answer_of(row) for row in rows]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{file}: no answers of a peer ({error})") from error
    if len(answers) != queries:
        raise ValueError(f"{file}: {len(answers)} answers to {queries} queries")
    return peer, answers


def answer_of(row: dict[str, Any]) -> PeerAnswer:
    """A line's answer.

    Raises:
        KeyError, TypeError, ValueError: it lacks something, or its pose is no transform.
    """
    milliseconds = float(row["milliseconds"])
    if row["pose"] is None:
        return PeerAnswer(NOTHING, milliseconds)
    pose = np.array(row["pose"], dtype=np.float64)
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise ValueError("a pose is four rows of four finite numbers")
    return PeerAnswer(Estimate(pose, float(row["score"]), bool(row["sure"])), milliseconds)


def nearest_frame(frames: Sequence[MapFrame], pose: Pose) -> MapFrame:
    """The map's frame whose origin lies nearest to a pose's."""
    origins = np.stack([frame.pose[:3, 3] for frame in frames])
    return frames[int(np.linalg.norm(origins - pose[:3, 3], axis=1).argmin())]
