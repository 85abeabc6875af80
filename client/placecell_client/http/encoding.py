"""Requests and answers in their two encodings; docs/reference/msgpack.md describes the second."""

import json
from collections.abc import Sequence
from typing import Any, Literal

import msgpack  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.http.point_clouds import Clouds, rows_of

Encoding = Literal["msgpack", "json"]
MEDIA_TYPES: dict[Encoding, str] = {"msgpack": "application/msgpack", "json": "application/json"}


def dumps(body: dict[str, Any], encoding: Encoding) -> bytes:
    """A request's body."""
    if encoding == "msgpack":
        return bytes(msgpack.packb(body))
    return json.dumps(body, separators=(",", ":"), allow_nan=False).encode()


def loads(media_type: str, content: bytes) -> dict[str, Any]:
    """An answer's body, in the encoding that it names.

    Raises:
        ValueError: it is in neither encoding, or cut short, or no map.
    """
    if media_type == MEDIA_TYPES["msgpack"]:
        body = msgpack.unpackb(content)
    elif media_type == MEDIA_TYPES["json"]:
        body = json.loads(content)
    else:
        raise ValueError(f"The answer is neither of {' nor of '.join(MEDIA_TYPES.values())}")
    if not isinstance(body, dict):
        raise ValueError("The answer is no map")
    return body


def segments_of(
    segments: Sequence[ArrayLike], sensors: ArrayLike, encoding: Encoding
) -> tuple[dict[str, Any], int]:
    """Return the part of a body that holds segments, and the number of non-finite points.

    Nothing is rounded that need not be: float32 arrays travel as they are. Others, as msgpack,
    travel as float32 relative to the median sensor, where that resolves micrometres.

    Args:
        segments: points of each, (points, 3), or structured with fields x, y and z; metres, all in
            one z-up frame.
        sensors: where the sensor was at capture, (segments, 3) or (3,) for all, same frame.
        encoding: of the body.

    Raises:
        ValueError: an array has another shape or type, or a sensor is not finite.
    """
    clouds = Clouds.of(segments, sensors)
    if encoding == "json":
        return {
            "segments": [
                {"points": cloud.astype(np.float64).tolist(), "sensor": position.tolist()}
                for cloud, position in zip(clouds.points, clouds.sensors, strict=True)
            ]
        }, clouds.dropped
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
    return (body if origin is None else body | {"origin": origin.tolist()}), clouds.dropped


def codes_of(codes: ArrayLike, encoding: Encoding) -> list[list[int]] | bytes:
    """Encode codes (q, d) for a body.

    Raises:
        ValueError: the array has another shape, or values that are no int8.
    """
    array = rows_of(codes, "codes", None, integers=True)
    if array.size and (array.min() < -128 or array.max() > 127):
        raise ValueError("codes has values beyond -128 to 127")
    if encoding == "msgpack":
        return np.ascontiguousarray(array, dtype=np.int8).tobytes()
    rows: list[list[int]] = array.tolist()
    return rows


def centroids_of(centroids: ArrayLike, encoding: Encoding) -> list[list[float]] | bytes:
    """Encode centroids (q, 3) for a body.

    Raises:
        ValueError: the array has another shape, or a value that is not finite.
    """
    array = rows_of(centroids, "centroids", 3, integers=False)
    wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(wrong):
        raise ValueError(f"a centroid is not finite: row {wrong[0]}")
    if encoding == "msgpack":
        return np.ascontiguousarray(array, dtype="<f8").tobytes()
    rows: list[list[float]] = array.tolist()
    return rows


def row_of(values: list[float] | bytes, dtype: str) -> NDArray[Any]:
    """An array of an answer, of a list or of a blob with elements of this type."""
    if isinstance(values, bytes):
        return np.frombuffer(values, dtype)
    return np.array(values, dtype)


def _origin(
    clouds: Sequence[NDArray[Any]], positions: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Where float32 is fine enough for the clouds, float64 (3,); None if they are float32 already.

    The service computes about this very sensor, so that it does not round a second time.
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
    # The service would take it for a point that the sensor did not measure.
    wrong = np.flatnonzero(~np.isfinite(near).all(axis=1))
    if len(wrong):
        row = cloud[wrong[0]].tolist()
        raise ValueError(f"segment {index}: point {wrong[0]} is too far for float32: {row}")
    return near.tobytes()
