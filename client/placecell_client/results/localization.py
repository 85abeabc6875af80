"""Results of localizing a robot."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.hints import UsedHints
from placecell_client.results.core import ItemError, Skipped

Motion = Literal["yaw", "se3"]
"""Degrees of freedom of a pose: `yaw` (x, y, z, yaw; gravity is known) or `se3` (all six)."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Rigid transform into a map's frame, from the robot's frame or from another map's frame.

    Attributes:
        translation: Translation x, y, z in meters, float64 (3,).
        rotation: Unit quaternion x, y, z, w, float64 (4,).
        yaw: Heading of the x axis about z, radians, -pi to pi.
    """

    translation: NDArray[np.float64]
    rotation: NDArray[np.float64]
    yaw: float

    @property
    def matrix(self) -> NDArray[np.float64]:
        """Homogeneous matrix of the transform, float64 (4, 4)."""
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
        """Transform points (n, 3), or one point (3,), into the map's frame; meters."""
        matrix = self.matrix
        return np.asarray(np.asarray(points) @ matrix[:3, :3].T + matrix[:3, 3])


@dataclass(frozen=True, slots=True, eq=False)
class Inliers:
    """Inliers of a pose: n pairs of query and map segments that agree with it.

    Attributes:
        queries: Indices of the query segments, int64 (n,).
        ids: Ids of the map's segments, int64 (n,).
        residuals: Distances within the pairs after the transform, meters, float64 (n,).
    """

    queries: NDArray[np.int64]
    ids: NDArray[np.int64]
    residuals: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.queries)


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """Pose hypothesis.

    Attributes:
        pose: Pose of the robot's frame in the map's frame.
        score: Evidence for the pose, comparable within one request.
        inliers: Number of segments that agree with the pose.
    """

    pose: Pose
    score: float
    inliers: int


@dataclass(frozen=True, slots=True, eq=False)
class Rival(Hypothesis):
    """Best pose hypothesis in another map that is not known to show the same place.

    Attributes:
        map: Name of the other map.
        frame: Name of its frame; the pose is in this frame.
    """

    map: str
    frame: str


@dataclass(frozen=True, slots=True, eq=False)
class PossiblePlace:
    """Place that the request's segments fit.

    Attributes:
        map: Name of the map.
        frame: Name of its frame; position and yaw are in this frame.
        position: Mean position of the segments that agree, meters, float64 (3,).
        yaw: Heading of the robot's x axis, radians.
        score: Evidence for the place, comparable within one request.
    """

    map: str
    frame: str
    position: NDArray[np.float64]
    yaw: float
    score: float


@dataclass(frozen=True, slots=True, eq=False)
class Localization:
    """Localization in one map: the robot's pose, or the reason why there is none.

    Attributes:
        map: Name of the map.
        frame: Name of its coordinate frame.
        pose: Pose of the robot's frame in the map's frame; None if the robot is not localized.
        reason: Reason why the robot is not localized: `too-few-segments`, `inconsistent`,
            `ambiguous` or `outside-hints`; None if it is.
        detail: The reason in words.
        probability: Probability that the best hypothesis is right within 1 m and 3 degrees, 0 to 1.
        covariance: Covariance of the pose, float64: (4, 4) for x, y, z, yaw, or (6, 6) for x, y, z
            and the rotations about x, y, z. Units: meters and radians, along the map's axes, at the
            origin of the robot's frame. None without a pose.
        score: Evidence for the pose, comparable within one request.
        inliers: Segments that agree with the pose.
        others: Other hypotheses: the second-best one; without a pose, the best one first.
        rival: Best hypothesis in another map of the request; None if there is none, or if the
            service is older than this field.
        threshold: Probability that a pose must exceed; None if the service is older.
        max_false_acceptance: Largest expected share of requests that get a false pose at this
            threshold; None if the model has no calibration, or if the service is older.
        advice: What helps a robot that is not localized, in words; else empty.
        meters_to_drive: Distance after which the robot sees enough segments, meters; None if it
            sees enough.
        places: The two places that look alike, if the reason is `ambiguous`; else empty.
        places_apart: Distance between the two places, meters; None if they are in two maps.
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
    threshold: float | None = None
    max_false_acceptance: float | None = None
    advice: str = ""
    meters_to_drive: float | None = None
    places: tuple[PossiblePlace, ...] = ()
    places_apart: float | None = None

    def covariance_at(self, point: ArrayLike) -> NDArray[np.float64]:
        """Return the covariance of a transformed point, such as the sensor position.

        Args:
            point: Point in the robot's frame, meters, (3,).

        Returns:
            Covariance along the map's axes, square meters, float64 (3, 3).

        Raises:
            ValueError: The robot is not localized.
        """
        if self.pose is None or self.covariance is None:
            raise ValueError(f"The robot is not localized in map {self.map!r}: {self.reason}.")
        x, y, z = self.pose.matrix[:3, :3] @ np.asarray(point, dtype=np.float64)
        turned = np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])
        moved = np.column_stack([np.eye(3), turned[:, 3 - (len(self.covariance) - 3) :]])
        return np.asarray(moved @ self.covariance @ moved.T)


@dataclass(frozen=True, slots=True, eq=False)
class Localizations:
    """Localizations in several maps, the most probable first.

    Attributes:
        model_id: Id of the model whose codes were compared.
        maps: Localization in each map, most probable first.
        errors: Segments that could not be used, by index.
        skipped: Maps that were not searched, because of their model.
        dropped_points: Number of points that were not finite and were left out.
        hints: Effect of the hints; None if the request had none.
    """

    model_id: str
    maps: tuple[Localization, ...]
    errors: dict[int, ItemError]
    skipped: tuple[Skipped, ...]
    dropped_points: int = 0
    hints: UsedHints | None = None

    @property
    def best(self) -> Localization | None:
        """Most probable localization, equal ones by score; None if no map has a pose.

        No map has a pose if two maps fit about equally well: see `rival`.
        """
        told = (each for each in self.maps if each.pose is not None)
        return max(told, key=lambda each: (each.probability, each.score), default=None)

    @property
    def rival(self) -> Rival | None:
        """Hypothesis in another map that makes the first map ambiguous; None if there is none.

        The first map's own hypothesis is `maps[0].others[0]`. To get a pose, pass only one of the
        two maps to `localize`, or merge the maps if they show the same place.
        """
        first = self.maps[0] if self.maps else None
        is_ambiguous = first is not None and first.reason == "ambiguous"
        return first.rival if first is not None and is_ambiguous else None


def localization_of(item: dict[str, Any]) -> Localization:
    """Build a localization from the service's response."""
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
        # Older services have no such fields.
        rival=_rival_of(item.get("rival")),
        threshold=item.get("threshold"),
        max_false_acceptance=item.get("max_false_acceptance"),
        advice=item.get("advice", ""),
        meters_to_drive=item.get("meters_to_drive"),
        places=tuple(_place_of(each) for each in item.get("places", ())),
        places_apart=item.get("places_apart"),
    )


def _place_of(item: dict[str, Any]) -> PossiblePlace:
    position = np.array(item["position"], dtype=np.float64).reshape(3)
    return PossiblePlace(item["map"], item["frame"], position, item["yaw"], item["score"])


def _rival_of(item: dict[str, Any] | None) -> Rival | None:
    if item is None:
        return None
    pose = pose_of(item["pose"])
    return Rival(pose, item["score"], item["inliers"], item["map"], item["frame"])


def pose_of(item: dict[str, Any]) -> Pose:
    """Build a pose from the service's response."""
    return Pose(
        np.array(item["translation"], dtype=np.float64).reshape(3),
        np.array(item["rotation"], dtype=np.float64).reshape(4),
        item["yaw"],
    )
