"""A map that goes elsewhere: into another coordinate frame, and into another map."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.maps.compact_map import SOURCE_LIMIT, CompactMap, MapFileError
from placecell_client.maps.union import with_optional


def moved(
    compact_map: CompactMap, rotation: ArrayLike, translation: ArrayLike, frame: str
) -> CompactMap:
    """A map in another coordinate frame: what was at p is at rotation p + translation.

    Centroids, and the sensors' positions and orientations, are moved, in float64; centroids are not
    rounded (a file does that). Nothing else changes.

    Args:
        compact_map: a valid map.
        rotation: (3, 3), from the map's frame to the other.
        translation: (3,), metres, of the map's origin in the other frame.
        frame: name of the other frame; z up as in all.

    Raises:
        ValueError: not a rotation, or not a finite translation.
    """
    turn, shift = np.asarray(rotation, np.float64), np.asarray(translation, np.float64)
    if shift.shape != (3,) or not np.isfinite(shift).all():
        raise ValueError("translation: not three finite numbers")
    turned = _product(_quaternion_of(turn), compact_map.frame_orientations)
    return replace(
        compact_map,
        frame=frame,
        centroids=compact_map.centroids @ turn.T + shift,
        frame_positions=compact_map.frame_positions @ turn.T + shift,
        frame_orientations=turned.astype(np.float32),
    )


def originated(compact_map: CompactMap, source: str) -> CompactMap:
    """A map that tells, of each segment, where it comes from; for before it is merged elsewhere.

    Segments that were written to this very map get its name, and their ids as they are now. Those
    that were merged into it keep their source, so it is always the map that a robot wrote to.

    Args:
        compact_map: a valid map.
        source: the name under which it is stored.

    Raises:
        MapFileError: the name is not 1 to 200 printable characters, or there are too many.
    """
    filled = with_optional(compact_map, ("source", "source_ids"))
    sources = tuple(dict.fromkeys((*filled.sources, source)))
    if len(sources) > SOURCE_LIMIT:
        raise MapFileError(f"sources: {len(sources)} names; at most {SOURCE_LIMIT}")
    named = np.array([sources.index(source) + 1, *range(1, len(sources) + 1)], np.uint16)
    told = replace(filled, source=named[filled.source], sources=sources)
    told.check()
    return told


def _quaternion_of(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """The unit quaternion x, y, z, w of a rotation matrix.

    The eigenvector of the largest eigenvalue (Bar-Itzhack, New method for extracting the quaternion
    from a rotation matrix, Journal of Guidance, Control, and Dynamics, 2000), for it has no case in
    which it is inexact.
    """
    if rotation.shape != (3, 3) or not np.isfinite(rotation).all():
        raise ValueError("rotation: not (3, 3) finite numbers")
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6):
        raise ValueError("rotation: not orthonormal")
    if np.linalg.det(rotation) < 0:
        raise ValueError("rotation: a reflection")
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
    """One unit quaternion times each of others, (f, 4); all x, y, z, w."""
    units = others.astype(np.float64)
    units /= np.linalg.norm(units, axis=1, keepdims=True)  # float32 has rounded them
    x, y, z, w = one
    times = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    return np.asarray(units @ times.T)
