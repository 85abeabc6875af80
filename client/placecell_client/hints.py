"""Hints of a localization: where the robot is, as far as it knows."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = Sequence[float] | NDArray[Any]
LARGEST_VARIANCE = 1e16
"""Largest value of a covariance: no map has a coordinate beyond 1e8 m."""
UNEVEN = 1e-3
"""Share of a covariance's largest value that rounding may add."""


@dataclass(frozen=True, slots=True)
class NearHint:
    """The sensor is near a position.

    Attributes:
        position: Position x, y, z in a map's frame, meters; x, y for any height.
        radius: Largest distance of the sensor from the position, meters.
        map: Name of the map, which the robot is in. None: the position is meant in the frame of
            every searched map.
    """

    position: Numbers
    radius: float
    map: str | None = None

    def __post_init__(self) -> None:
        _check_numbers("position", self.position, (2, 3))
        _check_positive("radius", self.radius)


@dataclass(frozen=True, slots=True)
class YawHint:
    """The sensor has about this heading.

    Attributes:
        radians: Heading of the sensor's x axis in the map's frame, counter-clockwise from the
            map's x axis.
        tolerance: Largest difference of the heading, radians.
    """

    radians: float
    tolerance: float

    def __post_init__(self) -> None:
        _check_numbers("radians", (self.radians,), (1,))
        _check_positive("tolerance", self.tolerance)


@dataclass(frozen=True, slots=True)
class LastPoseHint:
    """The robot was last known at a pose.

    Give either `radius` or `covariance`.

    Attributes:
        map: Name of the map.
        position: Last position of the sensor x, y, z in the map's frame, meters.
        orientation: Last orientation of the sensor as a quaternion x, y, z, w; None: any.
        radius: Largest distance that the robot may have moved since, meters.
        covariance: Covariance of the pose, 3 x 3 (x, y, z), 4 x 4 (and yaw) or 6 x 6 (and rotations
            about x, y, z), square meters and square radians. Three standard deviations are
            searched; with an orientation, this includes the heading.
        yaw_tolerance: Largest difference of the heading from `orientation`, radians; None: that of
            the covariance, or any heading.
    """

    map: str
    position: Numbers
    orientation: Numbers | None = None
    radius: float | None = None
    covariance: Sequence[Sequence[float]] | NDArray[Any] | None = None
    yaw_tolerance: float | None = None

    def __post_init__(self) -> None:
        _check_numbers("position", self.position, (3,))
        if (self.radius is None) == (self.covariance is None):
            raise ValueError("A last pose needs either a radius or a covariance.")
        if self.radius is not None:
            _check_positive("radius", self.radius)
        if self.covariance is not None:
            check_covariance(self.covariance)
            _check_spread(self.covariance)
        if self.orientation is not None:
            _check_quaternion(self.orientation)
        if self.yaw_tolerance is not None:
            _check_positive("yaw_tolerance", self.yaw_tolerance)
            if self.orientation is None:
                raise ValueError("A yaw_tolerance needs an orientation.")
        elif self.orientation is not None and self.covariance is not None:
            _check_heading(self.covariance)


@dataclass(frozen=True, slots=True)
class GeoHint:
    """The sensor is near a position on the Earth; only maps with a WGS 84 anchor use it.

    Attributes:
        lat: Latitude, degrees, north positive.
        lon: Longitude, degrees, east positive.
        accuracy: Standard deviation of the position along an axis, meters. Three of them are
            searched, together with the accuracy of the map's anchor.
    """

    lat: float
    lon: float
    accuracy: float

    def __post_init__(self) -> None:
        _check_numbers("lat, lon", (self.lat, self.lon), (2,))
        if abs(self.lat) > 90 or abs(self.lon) > 180:
            raise ValueError(
                f"Invalid position {self.lat:g}, {self.lon:g}: expected a latitude from -90 to 90 "
                "and a longitude from -180 to 180 degrees."
            )
        _check_positive("accuracy", self.accuracy)


@dataclass(frozen=True, slots=True)
class SensorPose:
    """Pose of the sensor in the frame of the request's segments.

    Attributes:
        position: Position x, y, z, meters.
        yaw: Heading of the sensor's x axis, radians, counter-clockwise.
    """

    position: Numbers
    yaw: float = 0.0

    def __post_init__(self) -> None:
        _check_numbers("position", self.position, (3,))
        _check_numbers("yaw", (self.yaw,), (1,))


@dataclass(frozen=True, slots=True)
class Hints:
    """Hints of a localization. A pose that contradicts one of them is not returned.

    A hint never makes a pose more probable: places outside the hints compete as without hints.

    Attributes:
        near: The sensor is near a position.
        yaw: The sensor has about this heading.
        last_pose: The robot was last known at a pose.
        geo: The sensor is near a position on the Earth.
        maps: The robot is in one of these maps.
        tags: The robot is in a map that has all of these tags.
        sensor: Pose of the sensor in the frame of the segments, which `near`, `yaw`, `last_pose`
            and `geo` are about. Give it if the frame is an odometry frame. Default: the median of
            the sensor positions, or the origin of the frame for a description; heading 0.
    """

    near: NearHint | None = None
    yaw: YawHint | None = None
    last_pose: LastPoseHint | None = None
    geo: GeoHint | None = None
    maps: Sequence[str] | None = None
    tags: Sequence[str] | None = None
    sensor: SensorPose | None = None

    @property
    def needs_sensor(self) -> bool:
        """Whether a hint is about the pose of the sensor."""
        return any(each is not None for each in (self.near, self.yaw, self.last_pose, self.geo))

    def as_dict(self) -> dict[str, Any]:
        """Return the hints as the request's field `hints`; fields without a value are left out."""
        plain: dict[str, Any] = _plain(self)
        return plain


@dataclass(frozen=True, slots=True)
class UnusedHint:
    """Hint that could not narrow a map.

    Attributes:
        hint: Name of the hint, such as `geo`.
        map: Name of the map.
        reason: Reason in words.
    """

    hint: str
    map: str
    reason: str


@dataclass(frozen=True, slots=True)
class OutsidePlace:
    """Place outside the hints that fits better than every place within them.

    Attributes:
        map: Name of the map.
        frame: Name of its frame.
        position: Position of the sensor x, y, z in the map's frame, meters.
        yaw: Heading of the sensor, radians.
        probability: Probability that this place is right.
    """

    map: str
    frame: str
    position: tuple[float, float, float]
    yaw: float
    probability: float


@dataclass(frozen=True, slots=True)
class UsedHints:
    """Effect of a request's hints.

    Attributes:
        used: Names of the hints that narrowed a map or the choice of maps.
        unused: Hints that could not narrow a map, with the reason.
        maps: Names of the searched maps that the hints allow.
        outside: Place outside the hints that fits better; None if there is none.
    """

    used: tuple[str, ...]
    unused: tuple[UnusedHint, ...]
    maps: tuple[str, ...]
    outside: OutsidePlace | None

    @classmethod
    def of(cls, content: dict[str, Any]) -> "UsedHints":
        """Build from the service's JSON."""
        outside = content["outside"]
        return cls(
            used=tuple(content["used"]),
            unused=tuple(
                UnusedHint(each["hint"], each["map"], each["reason"]) for each in content["unused"]
            ),
            maps=tuple(content["maps"]),
            outside=None
            if outside is None
            else OutsidePlace(
                outside["map"],
                outside["frame"],
                _three(outside["position"]),
                outside["yaw"],
                outside["probability"],
            ),
        )


def _plain(value: Any) -> Any:
    """Return a value as JSON: dataclasses as objects without empty fields, numbers as floats."""
    if hasattr(value, "__dataclass_fields__"):
        items = ((name, getattr(value, name)) for name in value.__dataclass_fields__)
        return {name: _plain(each) for name, each in items if each is not None}
    if isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    if hasattr(value, "__iter__"):
        return [_plain(each) for each in value]
    return float(value)


def _three(values: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z


def _check_numbers(name: str, values: Numbers, lengths: tuple[int, ...]) -> None:
    numbers = [float(each) for each in values]
    if len(numbers) not in lengths or not all(map(math.isfinite, numbers)):
        wanted = " or ".join(map(str, lengths))
        raise ValueError(f"Invalid {name} {numbers}: expected {wanted} finite numbers.")


def _check_positive(name: str, value: float) -> None:
    if not 0 < float(value) < math.inf:
        raise ValueError(f"Invalid {name} {value!r}: expected a positive number.")


def _check_quaternion(values: Numbers) -> None:
    _check_numbers("orientation", values, (4,))
    norm = math.hypot(*map(float, values))
    if not 0.9 < norm < 1.1:
        raise ValueError(
            f"Invalid orientation with length {norm:.3g}: expected a unit quaternion x, y, z, w."
        )


def _check_heading(rows: Sequence[Sequence[float]] | NDArray[Any]) -> None:
    if len(rows) > 3 and not float(rows[-1][-1]) > 0:
        raise ValueError(
            "Invalid covariance: the variance of the heading is 0, so that no pose is within the "
            "hint. Give the real variance, a yaw_tolerance, or no orientation."
        )


def _check_spread(rows: Sequence[Sequence[float]] | NDArray[Any]) -> None:
    if not np.asarray(rows, np.float64).diagonal()[:3].any():
        raise ValueError(
            "Invalid covariance: all variances of the position are 0, so that no pose is within "
            "the hint. Give the real covariance, or a radius."
        )


def check_covariance(rows: Sequence[Sequence[float]] | NDArray[Any]) -> None:
    """Check the covariance of a pose: 3, 4 or 6 rows, symmetric, without negative eigenvalues.

    Raises:
        ValueError: It is none; the message says why.
    """
    size = len(rows)
    if size not in (3, 4, 6):
        raise ValueError(f"Invalid covariance with {size} rows: expected 3, 4 or 6.")
    for index, row in enumerate(rows):
        _check_numbers(f"covariance row {index}", row, (size,))
        if not float(row[index]) >= 0:
            raise ValueError(
                f"Invalid covariance: the variance {float(row[index]):g} in row {index} is below 0."
            )
    matrix = np.asarray(rows, np.float64)
    largest = float(np.abs(matrix).max())
    if largest > LARGEST_VARIANCE:
        raise ValueError(
            f"Invalid covariance: the value {largest:g} is above {LARGEST_VARIANCE:g}. Leave it "
            "out if the position is not known."
        )
    apart = np.argwhere(np.abs(matrix - matrix.T) > UNEVEN * largest)
    if len(apart):
        row, column = apart[0].tolist()
        raise ValueError(
            f"Invalid covariance: {matrix[row, column]:g} in row {row}, column {column} differs "
            f"from {matrix[column, row]:g} in row {column}, column {row}. Expected a symmetric "
            "matrix."
        )
    smallest = float(np.linalg.eigvalsh(matrix)[0])
    if smallest < -UNEVEN * largest:
        raise ValueError(
            f"Invalid covariance: its smallest eigenvalue is {smallest:g}. Expected none below 0."
        )
