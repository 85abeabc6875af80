"""Requests and answers in their two encodings; MSGPACK.md describes the second."""

import json
from collections.abc import Sequence
from typing import Any, Literal

import msgpack  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, NDArray

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
) -> dict[str, Any]:
    """The part of a body that holds segments.

    Nothing is rounded that need not be: float32 arrays travel as they are. Others, as msgpack,
    travel as float32 relative to the median sensor, where that resolves micrometres.

    Args:
        segments: points of each, (points, 3), metres, all in one z-up frame.
        sensors: where the sensor was at capture, (segments, 3) or (3,) for all, same frame.
        encoding: of the body.

    Raises:
        ValueError: the arrays do not fit each other or hold a value that is not finite.
    """
    positions = np.asarray(sensors, dtype=np.float64)
    if positions.shape not in {(3,), (len(segments), 3)}:
        raise ValueError(f"sensors: shape {positions.shape}, not (3,) or ({len(segments)}, 3)")
    positions = np.broadcast_to(positions, (len(segments), 3))
    clouds = [_cloud(points) for points in segments]
    for index, (cloud, position) in enumerate(zip(clouds, positions, strict=True)):
        if not (np.isfinite(cloud).all() and np.isfinite(position).all()):
            raise ValueError(f"segment {index}: a value is not finite")
    if encoding == "json":
        return {
            "segments": [
                {"points": cloud.astype(np.float64).tolist(), "sensor": position.tolist()}
                for cloud, position in zip(clouds, positions, strict=True)
            ]
        }
    origin = _origin(clouds, positions)
    shift = np.zeros(3) if origin is None else origin
    body: dict[str, Any] = {
        "segments": [
            {"points": _blob(cloud, origin), "sensor": (position - shift).tolist()}
            for cloud, position in zip(clouds, positions, strict=True)
        ]
    }
    return body if origin is None else body | {"origin": origin.tolist()}


def codes_of(codes: NDArray[np.int8], encoding: Encoding) -> list[list[int]] | bytes:
    """Codes (q, d) as they stand in a body."""
    if encoding == "msgpack":
        return np.ascontiguousarray(codes, dtype=np.int8).tobytes()
    rows: list[list[int]] = codes.tolist()
    return rows


def centroids_of(centroids: NDArray[np.float64], encoding: Encoding) -> list[list[float]] | bytes:
    """Centroids (q, 3) as they stand in a body.

    Raises:
        ValueError: one is not finite.
    """
    if not np.isfinite(centroids).all():
        raise ValueError("a centroid is not finite")
    if encoding == "msgpack":
        return np.ascontiguousarray(centroids, dtype="<f8").tobytes()
    rows: list[list[float]] = centroids.tolist()
    return rows


def row_of(values: list[float] | bytes, dtype: str) -> NDArray[Any]:
    """An array of an answer, of a list or of a blob with elements of this type."""
    if isinstance(values, bytes):
        return np.frombuffer(values, dtype)
    return np.array(values, dtype)


def _cloud(points: ArrayLike) -> NDArray[Any]:
    """As (n, 3), float32 if it is already, otherwise float64."""
    array = np.asarray(points)
    if array.dtype != np.float32:
        array = array.astype(np.float64)
    return array.reshape(-1, 3)


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


def _blob(cloud: NDArray[Any], origin: NDArray[np.float64] | None) -> bytes:
    if origin is None:
        return cloud.astype("<f4", copy=False).tobytes()
    # What float32 cannot hold becomes infinite, and the service says where it stands.
    with np.errstate(over="ignore"):
        return (cloud - origin).astype("<f4").tobytes()
