"""Moved captures: new poses of captures, from which the places of their segments follow.

The rule is exact: service and receivers compute the same centimeters, so the same files.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import centimeters, one_sign
from placecell_client.maps.compact_map import (
    COORDINATE_LIMIT,
    ODOMETRY_WIDTH,
    MapFileError,
    is_ascending,
)


@dataclass(frozen=True, slots=True, eq=False)
class MovedCaptures:
    """New poses of k captures of a map.

    Attributes:
        ids: A segment of each capture in the map before, ascending, uint32 (k,).
        positions: New sensor positions, meters, float64 (k, 3).
        orientations: New orientations, unit quaternions x, y, z, w, float32 (k, 4).
        tracks: Odometry track of each capture, uint32 (k,). None: odometry stays.
        odometry: Odometry of each capture as in `CompactMap.frame_odometry`, float64 (k, 7);
            None if `tracks` is None.
    """

    ids: NDArray[np.uint32]
    positions: NDArray[np.float64]
    orientations: NDArray[np.float32]
    tracks: NDArray[np.uint32] | None = None
    odometry: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        return len(self.ids)

    def take(self, rows: NDArray[np.bool_] | NDArray[np.integer]) -> "MovedCaptures":
        """Select captures."""
        return MovedCaptures(
            self.ids[rows],
            self.positions[rows],
            self.orientations[rows],
            None if self.tracks is None else self.tracks[rows],
            None if self.odometry is None else self.odometry[rows],
        )

    def canonical(self) -> "MovedCaptures":
        """Return the same captures without negative zeros and with one sign of each quaternion."""
        return MovedCaptures(
            self.ids,
            self.positions + 0.0,
            one_sign(self.orientations) + np.float32(0.0),
            self.tracks,
            None if self.odometry is None else self.odometry + 0.0,
        )

    def check(self) -> None:
        """Check types, shapes and values.

        Raises:
            MapFileError: A column is invalid; the message names it.
        """
        k = self.ids.size
        columns: list[tuple[str, NDArray[Any] | None, type, tuple[int, ...]]] = [
            ("moved_ids", self.ids, np.uint32, (k,)),
            ("moved_positions", self.positions, np.float64, (k, 3)),
            ("moved_orientations", self.orientations, np.float32, (k, 4)),
        ]
        if self.tracks is not None or self.odometry is not None:
            columns += [
                ("moved_tracks", self.tracks, np.uint32, (k,)),
                ("moved_odometry", self.odometry, np.float64, (k, ODOMETRY_WIDTH)),
            ]
        for name, column, dtype, shape in columns:
            if column is None:
                raise MapFileError(f"{name}: expected both moved_tracks and moved_odometry")
            if column.dtype != dtype or column.shape != shape:
                raise MapFileError(
                    f"{name}: {column.dtype} {column.shape}, expected {np.dtype(dtype)} {shape}"
                )
            if dtype == np.float64 and not (np.abs(column) <= COORDINATE_LIMIT).all():
                raise MapFileError(f"{name}: a value is not finite or beyond {COORDINATE_LIMIT:g}")
        if not k or not is_ascending(self.ids):
            raise MapFileError("moved_ids: expected ascending ids, at least one")
        norms = np.linalg.norm(self.orientations.astype(np.float64), axis=1)
        if not (np.abs(norms - 1) <= 1e-3).all():
            raise MapFileError("moved_orientations: not unit quaternions")
        if self.odometry is not None and self.odometry[:, 4:].min() < 0:
            raise MapFileError("moved_odometry: a variance is negative")


def moved_centroids(
    centroids: NDArray[np.float64],
    positions: NDArray[np.float64],
    orientations: NDArray[np.float32],
    new_positions: NDArray[np.float64],
    new_orientations: NDArray[np.float32],
) -> NDArray[np.float64]:
    """Return the centroids of segments whose captures move, row by row, whole centimeters.

    The offset from the sensor, whole centimeters, is turned by the rotation between the two
    orientations and rounded. Only sums, products and one division of doubles are used, in the
    stated order, so all machines get the same result.

    Args:
        centroids: Centroids before, meters, (n, 3).
        positions: Position of each segment's capture before, meters, (n, 3).
        orientations: Orientation before, (n, 4).
        new_positions: Position after, meters, (n, 3).
        new_orientations: Orientation after, (n, 4).
    """
    steps = centimeters(centroids) - centimeters(positions)
    a, b, c = steps.T
    ax, ay, az, aw = new_orientations.astype(np.float64).T
    bx, by, bz, bw = orientations.astype(np.float64).T
    # The product of the new quaternion and the conjugate of the old one.
    x = ax * bw - aw * bx - ay * bz + az * by
    y = ay * bw - aw * by - az * bx + ax * bz
    z = az * bw - aw * bz - ax * by + ay * bx
    w = aw * bw + ax * bx + ay * by + az * bz
    s = 2.0 / (x * x + y * y + z * z + w * w)
    turned = np.column_stack(
        [
            (1.0 - s * (y * y + z * z)) * a + s * (x * y - z * w) * b + s * (x * z + y * w) * c,
            s * (x * y + z * w) * a + (1.0 - s * (x * x + z * z)) * b + s * (y * z - x * w) * c,
            s * (x * z - y * w) * a + s * (y * z + x * w) * b + (1.0 - s * (x * x + y * y)) * c,
        ]
    )
    moved = centimeters(new_positions) + np.rint(turned)
    moved /= 100
    moved += 0.0  # makes -0.0 and 0.0 the same
    return np.asarray(moved)
