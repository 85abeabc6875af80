"""Results of aligning two maps."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.results.localization import Pose, pose_of


@dataclass(frozen=True, slots=True)
class Overlap:
    """Overlap of two maps as shares of their sensor positions, 0 to 1.

    Attributes:
        of_map: Share of the first map's sensor positions that lie in the other map's area.
        of_other: Share of the other map's sensor positions that lie in the first map's area.
    """

    of_map: float
    of_other: float


@dataclass(frozen=True, slots=True, eq=False)
class MapPairs:
    """Inliers of an alignment: n pairs of segments that agree with the pose.

    Attributes:
        ids: Ids of the first map's segments, int64 (n,).
        other_ids: Ids of the other map's segments, int64 (n,).
        residuals: Distances within the pairs after alignment, meters, float64 (n,).
    """

    ids: NDArray[np.int64]
    other_ids: NDArray[np.int64]
    residuals: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.ids)


@dataclass(frozen=True, slots=True, eq=False)
class MapHypothesis:
    """Pose hypothesis of an alignment.

    Attributes:
        pose: Pose of the other map's frame in the first map's frame.
        score: Total weight of the pairs that agree with the pose.
        agreement: Share of the segments in the overlap that agree, 0 to 1.
        pairs: Number of pairs that agree.
    """

    pose: Pose
    score: float
    agreement: float
    pairs: int


@dataclass(frozen=True, slots=True, eq=False)
class MapAlignment:
    """Alignment of two maps: the pose of the other map's frame in the first map's frame.

    Attributes:
        map: Name of the first map.
        etag: ETag of its version.
        frame: Name of its coordinate frame.
        other: Name of the other map.
        other_etag: ETag of its version.
        other_frame: Name of its coordinate frame.
        pose: Pose of the other map's frame in the first map's frame; None if the maps are not
            aligned.
        reason: Reason why the maps are not aligned: `too-few-segments`, `inconsistent` or
            `ambiguous`; None if they are.
        detail: The reason in words.
        covariance: Covariance of the pose, float64: (4, 4) for x, y, z, yaw, or (6, 6) for x, y, z
            and the rotations about x, y, z. Units: meters and radians, along the first map's axes,
            at the origin of the other frame. None without a pose.
        overlap: Overlap of the maps; None without a pose.
        score: Score of the best hypothesis, whether accepted or not.
        agreement: Agreement of the best hypothesis, 0 to 1.
        pairs: Number of pairs that agree with the pose; 0 without one.
        inliers: The pairs that agree, if the request asked for them.
        others: Other hypotheses: the second-best one; without a pose, the best one first.
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
    """Build an alignment from the service's response."""
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
    """Build a pose from the service's response, or return None."""
    return None if item is None else pose_of(item)


def overlap_of(item: dict[str, Any] | None) -> Overlap | None:
    """Build an overlap from the service's response, or return None."""
    return None if item is None else Overlap(item["of_map"], item["of_other"])
