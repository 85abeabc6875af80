"""How maps lie to each other, and what became of them in a merge, as the service answers it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.results.localization import Pose, pose_of


@dataclass(frozen=True, slots=True)
class Overlap:
    """How much of two maps is of the same places.

    Attributes:
        of_map: of where the first map's robots were, the share where the other's were too.
        of_other: the same, of the other map.
    """

    of_map: float
    of_other: float


@dataclass(frozen=True, slots=True, eq=False)
class MapPairs:
    """The segments of two maps that agree, n pairs of them.

    Attributes:
        ids: int64 (n,), of the first map's segments.
        other_ids: int64 (n,), of the other map's.
        residuals: float64 (n,), metres between the two, by the pose.
    """

    ids: NDArray[np.int64]
    other_ids: NDArray[np.int64]
    residuals: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.ids)


@dataclass(frozen=True, slots=True, eq=False)
class MapHypothesis:
    """A way to lay a map on another.

    Attributes:
        pose: of the other map's frame in the first's.
        score: what the pairs that agree are worth together.
        agreement: of what should agree where both robots were, how much does, 0 to 1.
        pairs: how many agree.
    """

    pose: Pose
    score: float
    agreement: float
    pairs: int


@dataclass(frozen=True, slots=True, eq=False)
class MapAlignment:
    """How another map lies to a map.

    Attributes:
        map: its name.
        etag: of its version that was looked at.
        frame: name of its frame.
        other: the other map's name.
        other_etag: of its version.
        other_frame: name of its frame.
        pose: of the other's frame in the first's; None if the maps are not aligned.
        reason: why they are not: `too-few-segments`, `inconsistent` or `ambiguous`; None if they
            are.
        detail: the reason in words.
        covariance: of the pose, float64 (4, 4): x, y, z, yaw, or (6, 6): x, y, z and about x, y, z;
            along the first map's axes, of the other frame's origin. None without a pose.
        overlap: what both have seen; None without a pose.
        score: of the best way to lay them, aligned or not.
        agreement: of that.
        pairs: how many agree with the pose; 0 without one.
        inliers: these, if they were asked for.
        others: the second-best way; without a pose, the best one first.
    """

    map: str
    etag: str
    frame: str
    other: str
    other_etag: str
    other_frame: str
    pose: Pose | None
    reason: str | None
    detail: str
    covariance: NDArray[np.float64] | None
    overlap: Overlap | None
    score: float
    agreement: float
    pairs: int
    inliers: MapPairs
    others: tuple[MapHypothesis, ...]


def alignment_of(content: dict[str, Any]) -> MapAlignment:
    """From the service's answer."""
    inliers, covariance = content["inliers"], content["covariance"]
    return MapAlignment(
        map=content["map"],
        etag=content["etag"],
        frame=content["frame"],
        other=content["other"],
        other_etag=content["other_etag"],
        other_frame=content["other_frame"],
        pose=pose_if_any(content["pose"]),
        reason=content["reason"],
        detail=content["detail"],
        covariance=None if covariance is None else np.array(covariance, dtype=np.float64),
        overlap=overlap_of(content["overlap"]),
        score=content["score"],
        agreement=content["agreement"],
        pairs=content["pairs"],
        inliers=MapPairs(
            np.array([each["id"] for each in inliers], dtype=np.int64),
            np.array([each["other_id"] for each in inliers], dtype=np.int64),
            np.array([each["residual"] for each in inliers], dtype=np.float64),
        ),
        others=tuple(
            MapHypothesis(pose_of(each["pose"]), each["score"], each["agreement"], each["pairs"])
            for each in content["others"]
        ),
    )


def pose_if_any(item: dict[str, Any] | None) -> Pose | None:
    """From a pose of the service's answer, or none."""
    return None if item is None else pose_of(item)


def overlap_of(item: dict[str, Any] | None) -> Overlap | None:
    """From an overlap of the service's answer, or none."""
    return None if item is None else Overlap(item["of_map"], item["of_other"])
