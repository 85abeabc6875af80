"""Incremental segmentation of a robot's local map, scan by scan.

Tolerance: the segments equal those of the batch pipeline on the same scans, bit for bit, because
both run the same steps (`placecell.segmentation.pipeline`). There are two exceptions. The local map
begins anew where the odometry jumps by 1 km or more, and the coordinates are computed relative to
the first position if that is 10 km or more from the origin: float32 would be too coarse.

What is updated and what is computed anew: the voxel map is updated by each scan. The ground and the
regions are computed from all of its voxels, because a scan of a turning LiDAR changes nearly all
surfaces around, and finding what did not change takes longer than the computation.
"""

from collections import deque

import numpy as np

from placecell.core.jit import compiled
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.segmentation.incremental.live_segments import LiveSegments
from placecell.segmentation.incremental.motion import Sight, in_sensor_frame
from placecell.segmentation.incremental.tracks import (
    Track,
    label_voxels,
    persistent_ids,
    shared_voxels,
)
from placecell.segmentation.local_map import in_range, transform
from placecell.segmentation.pipeline import ground_and_overhead
from placecell.segmentation.region_growing import Regions, find_regions
from placecell.segmentation.voxel_map import JUMP, VoxelMap

LARGEST_WAITING = 1000
"""Largest number of ended segments whose best views wait for `take_final_views`."""

FAR = 10_000.0
"""Distance of the first position from the origin, meters, from which coordinates are shifted."""


class IncrementalSegmentation:
    """Segments of a local map that is updated scan by scan.

    The local map holds the points of the last `accumulated_scans` scans within `local_map_radius`
    of the sensor. The memory depends on these scans only, not on the length of the drive.
    """

    def __init__(self, parameters: Parameters = PROTOCOL_V1) -> None:
        self.parameters = parameters
        self._map = VoxelMap(
            parameters.map_voxel, parameters.local_map_radius, parameters.accumulated_scans
        )
        self._next_id = 0
        self._scan = -1
        self._final = deque[tuple[int, Track, bool]](maxlen=LARGEST_WAITING)
        self.reset()

    def reset(self) -> None:
        """Forget all scans and segments, for example after a jump of the odometry.

        Ids and scan numbers continue, so an id stays unique.
        """
        self._map.clear()
        self._shift: Float64 | None = None
        self._sensor = np.zeros(3)
        self._newest: tuple[Float32, Float64] | None = None  # points, and pose in the local map
        self._tracks: dict[int, Track] = {}
        self._moved: set[int] = set()
        self._ids = np.zeros(0, dtype=np.int64)  # of the voxels' labels
        self._final.clear()

    @property
    def nbytes(self) -> int:
        """Memory of the local map, bytes."""
        return self._map.nbytes

    def add(self, points: Float32, pose: Float64) -> None:
        """Add the next scan to the local map.

        Args:
            points: float32 (n, 3), meters, finite, sensor frame, deskewed.
            pose: float64 (4, 4), sensor to odometry frame (z up).

        Raises:
            ValueError: The pose is not a finite matrix of 4 by 4.
        """
        if np.shape(pose) != (4, 4) or not np.isfinite(pose).all():
            raise ValueError(
                f"Invalid pose of shape {np.shape(pose)}: expected a finite 4 x 4 matrix. "
                "Skip the scan, or repeat the last pose"
            )
        sensor = np.asarray(pose[:3, 3], dtype=np.float64)
        if self._shift is None or np.abs(sensor - self._sensor).max() > JUMP:
            self._shift = np.round(sensor) if np.abs(sensor).max() > FAR else np.zeros(3)
            self._map.clear()
        self._scan += 1
        self._sensor = sensor
        near = np.array(pose, dtype=np.float64)
        near[:3, 3] -= self._shift
        self._newest = points, near
        self._map.add(transform(near, in_range(points, self.parameters)), near[:3, 3])

    def segments(self) -> LiveSegments:
        """Return the segments of the local map at the last scan."""
        rows = self.objects()
        return self.follow(rows, self.regions(rows))

    def objects(self) -> Int64:
        """Return the voxels of the local map that are neither ground nor overhead, int64 (n,)."""
        ground, overhead = ground_and_overhead(self._map.means, self.parameters)
        return np.flatnonzero(~(ground | overhead))

    def regions(self, objects: Int64) -> Regions:
        """Return the regions of these voxels of the local map."""
        return find_regions(self._map.means[objects], self.parameters.growing_radius)

    def follow(self, objects: Int64, regions: Regions) -> LiveSegments:
        """Assign ids to regions and return those within the size limits.

        Args:
            objects: int64 (n,), voxels of the local map (see `objects`).
            regions: regions of these voxels.
        """
        # Smaller regions have ids too: a segment keeps its id while it is too small for a moment.
        followed = np.flatnonzero(regions.counts >= max(1, self.parameters.min_points // 2))
        voxels = regions.take(followed)
        rows, counts = objects[voxels], regions.counts[followed]
        ends = np.cumsum(counts)
        ids, self._next_id = persistent_ids(
            *shared_voxels(self._map.labels[rows], ends, len(self._ids)),
            self._ids,
            len(followed),
            self._next_id,
        )
        label_voxels(self._map.labels, rows, ends)
        self._ids = ids
        wanted = counts <= self.parameters.max_points
        wanted &= counts >= self.parameters.min_points
        chosen = np.flatnonzero(wanted)
        points = self._map.means[rows[np.repeat(wanted, counts)]]
        clear = self._is_clear(points, counts[chosen])
        moved = self._are_moved(points, counts[chosen], ids[chosen])
        if self._shift is not None and self._shift.any():
            points = (points + self._shift).astype(np.float32)
        segments = Segments(
            points,
            np.cumsum(counts[chosen], dtype=np.int64),
            np.tile(self._sensor.astype(np.float32), (len(chosen), 1)),
        )
        self._keep_best(segments, ids[chosen], clear, moved)
        return LiveSegments(
            segments,
            ids[chosen],
            clear & self._are_complete(ids[chosen]),
            np.full(len(chosen), self._scan, dtype=np.int64),
            moved,
        )

    def take_final_views(self, at_end: bool = False) -> LiveSegments:
        """Return each best view that became final since the last call.

        The best view of a segment is the one with the most voxels, among those that are clear of
        the local map's border if there are any. It is final when it was not replaced for
        `accumulated_scans` scans and is clear of the border (then it is complete), or when its
        segment was not found again. If a segment grows later, its next best view is returned under
        the same id, in place of the former one. At most the last 1,000 views wait for the call.

        Args:
            at_end: whether no further scan comes, so that every best view is final.
        """
        final = list(self._final)
        self._final.clear()
        for identity, track in self._tracks.items():
            complete = self._is_complete(track)
            if not track.reported and (complete or at_end):
                track.reported = True
                final.append((identity, track, complete))
        return LiveSegments(
            Segments.of(
                [track.points for _, track, _ in final],
                np.array([track.sensor for _, track, _ in final]),
            ),
            np.array([identity for identity, _, _ in final], dtype=np.int64),
            np.array([complete for _, _, complete in final], dtype=bool),
            np.array([track.scan for _, track, _ in final], dtype=np.int64),
            np.array([track.moved for _, track, _ in final], dtype=bool),
        )

    def _is_clear(self, points: Float32, counts: Int64) -> Bool:
        """Return whether each segment is clear of the local map's border, bool (segments,)."""
        shift = np.zeros(3) if self._shift is None else self._shift
        center = (self._sensor - shift)[:2].astype(np.float32)
        farthest = np.empty(len(counts), dtype=np.float32)
        _farthest(points, np.cumsum(counts), center, farthest)
        margin = self.parameters.growing_radius + self.parameters.map_voxel
        return np.asarray(farthest < (self.parameters.local_map_radius - margin) ** 2)

    def _are_moved(self, points: Float32, counts: Int64, ids: Int64) -> Bool:
        """Return whether each segment has moved, now or earlier, bool (segments,)."""
        if self._newest is None:
            return np.zeros(len(ids), dtype=bool)
        scan, pose = self._newest
        now = Sight.of(scan).moved(in_sensor_frame(points, pose), np.cumsum(counts))
        self._moved.intersection_update(self._ids.tolist())
        self._moved.update(ids[now].tolist())
        return np.array([each in self._moved for each in ids.tolist()], dtype=bool)

    def _keep_best(self, segments: Segments, ids: Int64, clear: Bool, moved: Bool) -> None:
        """Replace the best views by better ones, and end the tracks whose ids ended."""
        sensor = self._sensor.astype(np.float32)
        for index, (identity, voxels, is_clear, has_moved) in enumerate(
            zip(ids.tolist(), segments.counts.tolist(), clear.tolist(), moved.tolist(), strict=True)
        ):
            track = self._tracks.get(identity)
            if track is None or track.is_improved_by(voxels, is_clear):
                self._tracks[identity] = Track(
                    voxels, is_clear, self._scan, sensor, segments.cloud(index).copy()
                )
            self._tracks[identity].moved = has_moved
        alive = set(self._ids.tolist())
        for identity in [each for each in self._tracks if each not in alive]:
            track = self._tracks.pop(identity)
            if not track.reported:
                self._final.append((identity, track, self._is_complete(track)))

    def _are_complete(self, ids: Int64) -> Bool:
        return np.array([self._is_complete(self._tracks[each]) for each in ids.tolist()], bool)

    def _is_complete(self, track: Track) -> bool:
        """Return whether a best view is final: clear of the border, and not replaced for long."""
        return track.clear and self._scan - track.scan >= self.parameters.accumulated_scans


@compiled
def _farthest(points: Float32, ends: Int64, center: Float32, farthest: Float32) -> None:
    """Fill the largest squared horizontal distance of each segment's points, (segments,), m^2."""
    start = 0
    for segment in range(len(ends)):
        largest = np.float32(0)
        for point in range(start, ends[segment]):
            x, y = points[point, 0] - center[0], points[point, 1] - center[1]
            largest = max(largest, x * x + y * y)
        farthest[segment] = largest
        start = ends[segment]
