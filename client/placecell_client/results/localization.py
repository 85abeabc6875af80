"""Where a robot is, as the service answers it."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.results.core import ItemError, Skipped

Motion = Literal["yaw", "se3"]
"""What of the pose is sought: yaw and translation, for gravity is known; or all six degrees."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A rigid transform to a map's frame: from the robot's, that of the request, or another map's.

    Attributes:
        translation: float64 (3,), metres.
        rotation: float64 (4,), unit quaternion x, y, z, w.
        yaw: radians, -pi to pi: where the x axis points, seen from above.
    """

    translation: NDArray[np.float64]
    rotation: NDArray[np.float64]
    yaw: float

    @property
    def matrix(self) -> NDArray[np.float64]:
        """As a transform (4, 4)."""
        x, y, z, w = self.rotation
        matrix = np.eye(4)
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        matrix[:3, 3] = self.translation
        return matrix

    def apply(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (n, 3) of the robot's or the other map's frame, or one (3,), in the map's."""
        matrix = self.matrix
        return np.asarray(np.asarray(points) @ matrix[:3, :3].T + matrix[:3, 3])


@dataclass(frozen=True, slots=True, eq=False)
class Inliers:
    """The segments that agree with a pose, n of them.

    Attributes:
        queries: int64 (n,), indices of the segments that were asked about.
        ids: int64 (n,), of the map's segments that they were found as.
        residuals: float64 (n,), metres between the two, by the pose.
    """

    queries: NDArray[np.int64]
    ids: NDArray[np.int64]
    residuals: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.queries)


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """Another place where the robot may be.

    Attributes:
        pose: it would have there.
        score: evidence for it, to be compared with others of the same request.
        inliers: how many segments agree with it.
    """

    pose: Pose
    score: float
    inliers: int


@dataclass(frozen=True, slots=True, eq=False)
class Rival(Hypothesis):
    """Best pose in another map that is not known to show the same place.

    Attributes:
        map: the other map's name.
        frame: name of its frame, to which the pose leads.
    """

    map: str
    frame: str


@dataclass(frozen=True, slots=True, eq=False)
class Localization:
    """Localization in one map: the robot's pose, or the reason why there is none.

    Attributes:
        map: the map's name.
        frame: name of its frame.
        pose: of the robot's frame in the map's; None if the robot is not localised.
        reason: why it is not: `too-few-segments`, `inconsistent` or `ambiguous`; None if it is.
        detail: the reason in words.
        probability: that the best hypothesis is right, within 1 m and 3 degrees.
        covariance: of the pose, float64 (4, 4): x, y, z, yaw, or (6, 6): x, y, z and about x, y, z;
            along the map's axes, of the frame's origin. None without a pose.
        score: evidence for the pose.
        inliers: the segments that agree with it.
        others: the second-best hypothesis; without a pose, the best one first.
        rival: the best place in another map of the request; None: there is none, or the service is
            older than this field.
    """

    map: str
    frame: str
    pose: Pose | None
    reason: str | None
    detail: str
    probability: float
    covariance: NDArray[np.float64] | None
    score: float
    inliers: Inliers
    others: tuple[Hypothesis, ...]
    rival: Rival | None = None

    def covariance_at(self, point: ArrayLike) -> NDArray[np.float64]:
        """Covariance (3, 3) of where the pose takes a point (3,), such as the sensor: metres^2.

        Raises:
            ValueError: the robot is not localised.
        """
        if self.pose is None or self.covariance is None:
            raise ValueError(f"not localised in {self.map!r}: {self.reason}")
        x, y, z = self.pose.matrix[:3, :3] @ np.asarray(point, dtype=np.float64)
        turned = np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])
        moved = np.column_stack([np.eye(3), turned[:, 3 - (len(self.covariance) - 3) :]])
        return np.asarray(moved @ self.covariance @ moved.T)


@dataclass(frozen=True, slots=True, eq=False)
class Localizations:
    """Localizations in several maps, the most probable first.

    Attributes:
        model_id: of the model whose codes were compared.
        maps: one each.
        errors: by index, the segments that could not be used.
        skipped: maps of other models.
        dropped_points: points that were not finite and were left out.
    """

    model_id: str
    maps: tuple[Localization, ...]
    errors: dict[int, ItemError]
    skipped: tuple[Skipped, ...]
    dropped_points: int = 0

    @property
    def best(self) -> Localization | None:
        """Return the most probable localization, equal ones by score; None if no map has a pose.

        None also if two maps fit about equally well: see `rival`.
        """
        told = (each for each in self.maps if each.pose is not None)
        return max(told, key=lambda each: (each.probability, each.score), default=None)

    @property
    def rival(self) -> Rival | None:
        """Return the map and pose that fit as well as the first map's; None if that is no reason.

        The first map's own pose is the first of its `others`. Name one of the two in `maps`, or
        merge them if they show one place.
        """
        first = self.maps[0] if self.maps else None
        is_ambiguous = first is not None and first.reason == "ambiguous"
        return first.rival if first is not None and is_ambiguous else None


def localization_of(item: dict[str, Any]) -> Localization:
    """From one of the service's answer."""
    inliers = item["inliers"]
    covariance = item["covariance"]
    return Localization(
        map=item["map"],
        frame=item["frame"],
        pose=None if item["pose"] is None else pose_of(item["pose"]),
        reason=item["reason"],
        detail=item["detail"],
        probability=item["probability"],
        covariance=None if covariance is None else np.array(covariance, dtype=np.float64),
        score=item["score"],
        inliers=Inliers(
            np.array([each["query"] for each in inliers], dtype=np.int64),
            np.array([each["id"] for each in inliers], dtype=np.int64),
            np.array([each["residual"] for each in inliers], dtype=np.float64),
        ),
        others=tuple(
            Hypothesis(pose_of(each["pose"]), each["score"], each["inliers"])
            for each in item["others"]
        ),
        rival=_rival_of(item.get("rival")),  # an earlier service tells none
    )


def _rival_of(item: dict[str, Any] | None) -> Rival | None:
    if item is None:
        return None
    pose = pose_of(item["pose"])
    return Rival(pose, item["score"], item["inliers"], item["map"], item["frame"])


def pose_of(item: dict[str, Any]) -> Pose:
    """From a pose of the service's answer."""
    return Pose(
        np.array(item["translation"], dtype=np.float64).reshape(3),
        np.array(item["rotation"], dtype=np.float64).reshape(4),
        item["yaw"],
    )
