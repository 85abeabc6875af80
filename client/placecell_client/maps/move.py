"""Transform of a map into another coordinate frame; provenance before a merge."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.maps.compact_map import SOURCE_LIMIT, CompactMap, MapFileError
from placecell_client.maps.union import with_optional


def moved(
    compact_map: CompactMap, rotation: ArrayLike, translation: ArrayLike, frame: str
) -> CompactMap:
    """Transform a map into another coordinate frame: p becomes rotation @ p + translation.

    Centroids and sensor poses are transformed in float64. Centroids are not rounded; `encode`
    rounds them. All other columns are unchanged.

    Args:
        compact_map: A valid map.
        rotation: Rotation matrix (3, 3) from the map's frame to the other frame.
        translation: Origin of the map's frame in the other frame, meters, (3,).
        frame: Name of the other frame, z up.

    Raises:
        ValueError: The matrix is not a rotation, or the translation is not finite.
    """
    turn, shift = np.asarray(rotation, np.float64), np.asarray(translation, np.float64)
    if shift.shape != (3,) or not np.isfinite(shift).all():
        raise ValueError("Invalid translation: expected three finite numbers.")
    turned = _product(_quaternion_of(turn), compact_map.frame_orientations)
    return replace(
        compact_map,
        frame=frame,
        centroids=compact_map.centroids @ turn.T + shift,
        frame_positions=compact_map.frame_positions @ turn.T + shift,
        frame_orientations=turned.astype(np.float32),
    )


def originated(compact_map: CompactMap, source: str) -> CompactMap:
    """Add the provenance of each segment, before the map is merged into another one.

    Segments that were written to this map get its name as source and their present ids. Segments
    that were merged into it keep their source. So the source is always the map that a robot wrote.

    Args:
        compact_map: A valid map.
        source: Name of the map in the service.

    Raises:
        MapFileError: The name is not 1 to 200 printable characters, or there are too many sources.
    """
    filled = with_optional(compact_map, ("source", "source_ids"))
    sources = tuple(dict.fromkeys((*filled.sources, source)))
    if len(sources) > SOURCE_LIMIT:
        raise MapFileError(f"sources: {len(sources)} names; the limit is {SOURCE_LIMIT}")
    named = np.array([sources.index(source) + 1, *range(1, len(sources) + 1)], np.uint16)
    told = replace(filled, source=named[filled.source], sources=sources)
    told.check()
    return told


def _quaternion_of(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert a rotation matrix to a unit quaternion x, y, z, w.

    The quaternion is the eigenvector of the largest eigenvalue, which is exact for all rotations
    (Bar-Itzhack, New method for extracting the quaternion from a rotation matrix, Journal of
    Guidance, Control, and Dynamics, 2000).
    """
    if rotation.shape != (3, 3) or not np.isfinite(rotation).all():
        raise ValueError("Invalid rotation: expected (3, 3) finite numbers.")
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6):
        raise ValueError("Invalid rotation: the matrix is not orthonormal.")
    if np.linalg.det(rotation) < 0:
        raise ValueError("Invalid rotation: the matrix is a reflection.")
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    symmetric = np.array(
        [
            [xx - yy - zz, xy + yx, xz + zx, zy - yz],
            [xy + yx, yy - xx - zz, yz + zy, xz - zx],
            [xz + zx, yz + zy, zz - xx - yy, yx - xy],
            [zy - yz, xz - zx, yx - xy, xx + yy + zz],
        ]
    )
    return np.asarray(np.linalg.eigh(symmetric).eigenvectors[:, -1])


def _product(one: NDArray[np.float64], others: NDArray[np.float32]) -> NDArray[np.float64]:
    """Multiply one unit quaternion by each of others, (f, 4); all are x, y, z, w."""
    units = others.astype(np.float64)
    units /= np.linalg.norm(units, axis=1, keepdims=True)  # undo the rounding of float32
    x, y, z, w = one
    times = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    return np.asarray(units @ times.T)
