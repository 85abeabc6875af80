"""Encoding of requests and responses: JSON, or msgpack as in docs/reference/msgpack.md."""

import json
from collections.abc import Sequence
from typing import Any, Literal

import msgpack  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.classes import class_names, class_probabilities
from placecell_client.http.point_clouds import Clouds, rows_of

Encoding = Literal["msgpack", "json"]
MEDIA_TYPES: dict[Encoding, str] = {"msgpack": "application/msgpack", "json": "application/json"}


def dumps(body: dict[str, Any], encoding: Encoding) -> bytes:
    """Encode the body of a request."""
    if encoding == "msgpack":
        return bytes(msgpack.packb(body))
    return json.dumps(body, separators=(",", ":"), allow_nan=False).encode()


def loads(media_type: str, content: bytes) -> dict[str, Any]:
    """Decode the body of a response.

    Raises:
        ValueError: The media type is unknown, or the body is not a valid object.
    """
    if media_type == MEDIA_TYPES["msgpack"]:
        body = msgpack.unpackb(content)
    elif media_type == MEDIA_TYPES["json"]:
        body = json.loads(content)
    else:
        raise ValueError(f"The answer's type is not one of {', '.join(MEDIA_TYPES.values())}")
    if not isinstance(body, dict):
        raise ValueError("The answer is not an object")
    return body


def segments_of(
    segments: Sequence[ArrayLike], sensors: ArrayLike, encoding: Encoding
) -> tuple[dict[str, Any], Clouds]:
    """Return the part of a body that holds segments, and the clouds that it holds.

    float32 arrays are sent unchanged. In msgpack, other arrays are sent as float32 relative to the
    median sensor position, with a resolution of micrometers.

    Args:
        segments: Points of each segment, (points, 3) or structured with fields x, y and z; meters,
            all in one frame with z up.
        sensors: Sensor position at capture, (segments, 3) or (3,) for all, in the same frame.
        encoding: Encoding of the body.

    Raises:
        ValueError: An array has a wrong shape or type, or a sensor position is not finite.
    """
    clouds = Clouds.of(segments, sensors)
    if encoding == "json":
        return {
            "segments": [
                {"points": cloud.astype(np.float64).tolist(), "sensor": position.tolist()}
                for cloud, position in zip(clouds.points, clouds.sensors, strict=True)
            ]
        }, clouds
    origin = _origin(clouds.points, clouds.sensors)
    shift = np.zeros(3) if origin is None else origin
    body: dict[str, Any] = {
        "segments": [
            {"points": _blob(cloud, origin, index), "sensor": (position - shift).tolist()}
            for index, (cloud, position) in enumerate(
                zip(clouds.points, clouds.sensors, strict=True)
            )
        ]
    }
    return (body if origin is None else body | {"origin": origin.tolist()}), clouds


def codes_of(codes: ArrayLike, encoding: Encoding) -> list[list[int]] | bytes:
    """Encode codes (q, d) for a body.

    Raises:
        ValueError: The array has a wrong shape, or values beyond int8.
    """
    array = rows_of(codes, "codes", None, integers=True)
    if array.size and (array.min() < -128 or array.max() > 127):
        raise ValueError("codes has values outside -128 to 127")
    if encoding == "msgpack":
        return np.ascontiguousarray(array, dtype=np.int8).tobytes()
    rows: list[list[int]] = array.tolist()
    return rows


def classes_of(classes: NDArray[np.uint8], encoding: Encoding) -> Any:
    """Return classes for a body: bytes, or names with probabilities; None for unknown."""
    if encoding == "msgpack":
        return classes.tobytes()
    return [
        None if name is None else {"name": name, "probability": probability}
        for name, probability in zip(
            class_names(classes), class_probabilities(classes).tolist(), strict=True
        )
    ]


def centroids_of(centroids: ArrayLike, encoding: Encoding) -> list[list[float]] | bytes:
    """Encode centroids (q, 3) for a body.

    Raises:
        ValueError: The array has a wrong shape, or a value that is not finite.
    """
    array = rows_of(centroids, "centroids", 3, integers=False)
    wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(wrong):
        raise ValueError(f"centroid {wrong[0]} is not finite")
    if encoding == "msgpack":
        return np.ascontiguousarray(array, dtype="<f8").tobytes()
    rows: list[list[float]] = array.tolist()
    return rows


def row_of(values: list[float] | bytes, dtype: str) -> NDArray[Any]:
    """Return an array of a response, from a list or from bytes with elements of this type."""
    if isinstance(values, bytes):
        return np.frombuffer(values, dtype)
    return np.array(values, dtype)


def _origin(
    clouds: Sequence[NDArray[Any]], positions: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Return the origin for float32 coordinates, float64 (3,); None if all clouds are float32.

    The service computes relative to the same sensor position, so it does not round again.
    """
    if not clouds or all(cloud.dtype == np.float32 for cloud in clouds):
        return None
    origin: NDArray[np.float64] = np.quantile(positions, 0.5, axis=0, method="lower")
    return origin


def _blob(cloud: NDArray[Any], origin: NDArray[np.float64] | None, index: int) -> bytes:
    if origin is None:
        return cloud.astype("<f4", copy=False).tobytes()
    with np.errstate(over="ignore"):
        near = (cloud - origin).astype("<f4")
    # The service would treat it as a point that the sensor did not measure.
    wrong = np.flatnonzero(~np.isfinite(near).all(axis=1))
    if len(wrong):
        row = cloud[wrong[0]].tolist()
        raise ValueError(f"segment {index}: point {wrong[0]} is too far for float32: {row}")
    return near.tobytes()
