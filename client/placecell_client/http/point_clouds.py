"""Checks of the caller's point clouds and positions; errors name the array."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

AXES = ("x", "y", "z")
COARSE_METERS = 131_072.0
"""Coordinate from which float32 steps exceed 1 cm, meters (2^17 m: 1.6 cm)."""
FEW_POINTS = 10
"""Number of points below which whole numbers may be chance."""


class PrecisionWarning(UserWarning):
    """Warning: coordinates are too large for float32 and have lost digits."""


@dataclass(frozen=True, slots=True, eq=False)
class Clouds:
    """Segments of a call as checked arrays.

    Attributes:
        points: Points of each segment, (n, 3), finite; float32 if the input is float32, otherwise
            float64.
        sensors: Sensor positions, float64 (segments, 3).
        dropped: Number of points that were not finite or were masked, over all segments.
    """

    points: tuple[NDArray[Any], ...]
    sensors: NDArray[np.float64]
    dropped: int

    @classmethod
    def of(cls, segments: Sequence[ArrayLike], sensors: ArrayLike) -> "Clouds":
        """Check the arrays of a caller.

        Raises:
            ValueError: An array has a wrong shape or type, or a sensor position is not finite.
        """
        given = [points_of(points, f"segment {index}") for index, points in enumerate(segments)]
        clouds, dropped = [], 0
        for points in given:
            finite = np.isfinite(points).all(axis=1)
            clouds.append(points if finite.all() else points[finite])
            dropped += int(len(points) - finite.sum())
        if any(_is_coarse(points) for points in clouds):
            warnings.warn(
                f"float32 coordinates beyond {COARSE_METERS:,.0f} m have steps of more than 1 cm, "
                "so segments lose their shape. Subtract an origin near the robot in float64 "
                "before converting to float32, or pass float64 points.",
                PrecisionWarning,
                stacklevel=5,
            )
        return cls(tuple(clouds), _sensors(sensors, len(clouds)), dropped)

    @property
    def heights(self) -> NDArray[np.float64]:
        """Return the vertical sides of the segments' boxes, meters; NaN without points."""
        return np.array([np.ptp(each[:, 2]) if len(each) else np.nan for each in self.points])


def points_of(points: ArrayLike, name: str) -> NDArray[Any]:
    """Convert points to (n, 3), float32 if they are float32 already, otherwise float64.

    Structured arrays need the fields x, y and z; other fields are ignored. Masked values become
    NaN.

    Raises:
        ValueError: The array has a wrong shape or type.
    """
    array = _array(points, name)
    if array.dtype.names is not None:
        array = _of_fields(array, name)
    if array.shape == (0,):
        array = array.reshape(0, 3)  # an empty list
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, expected (n, 3)")
    return _floats(array, name)


def rows_of(values: ArrayLike, name: str, columns: int | None, integers: bool) -> NDArray[Any]:
    """Convert numbers to (n, columns), or (n, any) if columns is None; integers stay integers.

    Raises:
        ValueError: The array has a wrong shape or type.
    """
    array = _array(values, name)
    wanted = "any" if columns is None else str(columns)
    if array.ndim != 2 or array.shape[1] != (array.shape[1] if columns is None else columns):
        raise ValueError(f"{name} has shape {array.shape}, expected (n, {wanted})")
    if not integers:
        return _floats(array, name).astype(np.float64, copy=False)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} has type {array.dtype}, expected integers")
    return array


def _array(values: ArrayLike, name: str) -> NDArray[Any]:
    try:
        return np.asanyarray(values)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{name} is not an array of numbers: {error}") from error


def _of_fields(array: NDArray[Any], name: str) -> NDArray[Any]:
    """Return the coordinates of a structured array, (n, 3)."""
    names = array.dtype.names or ()
    missing = [axis for axis in AXES if axis not in names]
    if missing:
        raise ValueError(f"{name} has fields {', '.join(names)}, expected x, y and z among them")
    columns = [array[axis].reshape(-1) if array.ndim else array[axis][None] for axis in AXES]
    if any(array.dtype[axis].shape or array.dtype[axis].kind not in "fiu" for axis in AXES):
        kinds = ", ".join(f"{axis} {array.dtype[axis]}" for axis in AXES)
        raise ValueError(f"{name} has fields of type {kinds}, expected numbers")
    stack = np.ma.stack if isinstance(array, np.ma.MaskedArray) else np.stack
    return np.asanyarray(stack(columns, axis=1))


def _floats(array: NDArray[Any], name: str) -> NDArray[Any]:
    """Convert to native float32 or float64, without a mask."""
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name} has type {array.dtype}, expected numbers")
    single = array.dtype.kind == "f" and array.dtype.itemsize == 4
    dtype = np.float32 if single else np.float64
    if isinstance(array, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(array), np.nan, np.ma.getdata(array)).astype(dtype)
    return np.asarray(array, dtype=dtype)


def _is_coarse(points: NDArray[Any]) -> bool:
    """Return whether float32 rounded the points too coarsely."""
    largest = np.abs(points).max(axis=0, initial=0.0)
    large = largest >= COARSE_METERS
    if not large.any():
        return False
    if points.dtype == np.float32:
        return True
    if len(points) < FEW_POINTS:
        return False
    far = points[:, large]
    with np.errstate(over="ignore"):
        # Coordinates in whole or half meters are synthetic; they have lost nothing.
        return bool((far.astype(np.float32) == far).all() and (far * 2 % 1 != 0).any())


def _sensors(sensors: ArrayLike, count: int) -> NDArray[np.float64]:
    array = _array(sensors, "sensors")
    if array.dtype.kind not in "fiu":
        raise ValueError(f"sensors has type {array.dtype}, expected numbers")
    if array.shape not in {(3,), (count, 3)}:
        raise ValueError(f"sensors has shape {array.shape}, expected (3,) or ({count}, 3)")
    positions = np.broadcast_to(_floats(array, "sensors").astype(np.float64), (count, 3))
    wrong = np.flatnonzero(~np.isfinite(positions).all(axis=1))
    if len(wrong):
        raise ValueError(f"sensor {wrong[0]} is not finite: {positions[wrong[0]].tolist()}")
    return positions
