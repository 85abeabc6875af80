"""Incremental segmentation of a robot's local map, scan by scan.

The segments are those of the batch pipeline (`placecell.segmentation.pipeline`) on the same scans.
"""

from collections import deque

import numpy as np

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.segmentation.incremental.live_segments import LiveSegments
from placecell.segmentation.incremental.tracks import Track, persistent_ids
from placecell.segmentation.local_map import in_range, transform, voxel_means
from placecell.segmentation.pipeline import segment_map

LARGEST_WAITING = 1000
"""Largest number of ended segments whose best views wait for `take_final_views`."""


class IncrementalSegmentation:
    """Segments of a local map that is updated scan by scan.

    The local map holds the points of the last `accumulated_scans` scans within `local_map_radius`
    of the sensor.
    """

    def __init__(self, parameters: Parameters = PROTOCOL_V1) -> None:
        self.parameters = parameters
        self._next_id = 0
        self._scan = -1
        self.reset()

    def reset(self) -> None:
        """Forget all scans and segments, for example after a jump of the odometry.

        Ids and scan numbers continue, so an id stays unique.
        """
        self._moved: deque[Float32] = deque(maxlen=self.parameters.accumulated_scans)
        self._sensor = np.zeros(3)
        self._tracks: dict[int, Track] = {}
        self._keys = np.zeros(0, dtype=np.int64)
        self._owners = np.zeros(0, dtype=np.int64)
        self._final = deque[tuple[int, Track]](maxlen=LARGEST_WAITING)

    def add(self, points: Float32, pose: Float64) -> None:
        """Add the next scan to the local map.

        Args:
            points: float32 (n, 3), meters, finite, sensor frame, deskewed.
            pose: float64 (4, 4), sensor to odometry frame (z up).
        """
        self._scan += 1
        self._moved.append(transform(pose, in_range(points, self.parameters)))
        self._sensor = np.asarray(pose[:3, 3], dtype=np.float64)

    def segments(self) -> LiveSegments:
        """Return the segments of the local map at the last scan."""
        local_map = self._local_map()
        clouds = segment_map(local_map, self.parameters)
        segments = Segments.of(clouds, np.tile(self._sensor, (len(clouds), 1)))
        ids = self._track(segments)
        clear = self._is_clear(segments)
        self._keep_best(segments, ids, clear)
        settled = np.array([self._is_settled(self._tracks[each]) for each in ids.tolist()], bool)
        scans = np.full(len(ids), self._scan, dtype=np.int64)
        return LiveSegments(segments, ids, clear & settled, scans)

    def _local_map(self) -> Float32:
        if not self._moved:
            return np.zeros((0, 3), dtype=np.float32)
        points = np.concatenate(list(self._moved))
        offset = points[:, :2] - self._sensor[:2].astype(np.float32)
        near = np.einsum("ij,ij->i", offset, offset) <= self.parameters.local_map_radius**2
        return voxel_means(points[near], self.parameters.map_voxel)

    def _track(self, segments: Segments) -> Int64:
        cells = np.floor(segments.points / self.parameters.map_voxel).astype(np.int64)
        keys = ((cells[:, 0] << 42) ^ (cells[:, 1] << 21)) ^ (cells[:, 2] & ((1 << 21) - 1))
        place = np.searchsorted(self._keys, keys)
        known = place < len(self._keys)
        known[known] = self._keys[place[known]] == keys[known]
        pairs = np.stack([segments.owners[known], self._owners[place[known]]], axis=1)
        distinct, shared = np.unique(pairs.reshape(-1, 2), axis=0, return_counts=True)
        ids, self._next_id = persistent_ids(
            shared, distinct[:, 0], distinct[:, 1], len(segments), self._next_id
        )
        order = np.argsort(keys, kind="stable")
        self._keys, self._owners = keys[order], ids[segments.owners][order]
        return ids

    def _is_clear(self, segments: Segments) -> Bool:
        """Return whether each segment is clear of the local map's border, bool (segments,)."""
        if not len(segments):
            return np.zeros(0, dtype=bool)
        offset = segments.points[:, :2] - self._sensor[:2].astype(np.float32)
        farthest = np.maximum.reduceat(np.hypot(offset[:, 0], offset[:, 1]), segments.starts)
        margin = self.parameters.growing_radius + self.parameters.map_voxel
        return np.asarray(farthest < self.parameters.local_map_radius - margin)

    def _keep_best(self, segments: Segments, ids: Int64, clear: Bool) -> None:
        kept = {}
        for index, (identity, is_clear) in enumerate(
            zip(ids.tolist(), clear.tolist(), strict=True)
        ):
            track = self._tracks.get(identity)
            voxels = int(segments.counts[index])
            if track is None or track.is_improved_by(voxels, is_clear):
                track = Track(
                    voxels,
                    is_clear,
                    self._scan,
                    self._sensor.astype(np.float32),
                    segments.cloud(index).copy(),
                )
            kept[identity] = track
        for identity, track in self._tracks.items():
            if identity not in kept and not track.reported:
                self._final.append((identity, track))
        self._tracks = kept

    def _is_settled(self, track: Track) -> bool:
        return self._scan - track.scan >= self.parameters.accumulated_scans

    def take_final_views(self) -> LiveSegments:
        """Return each best view that became final since the last call.

        The best view of a segment is the one with the most voxels, among those that are clear of
        the local map's border if there are any. It is final when it was not replaced for
        `accumulated_scans` scans (then it is complete if it is clear of the border), or when its
        segment was not found again. If a segment grows later, its next best view is returned under
        the same id, in place of the former one.
        """
        final = list(self._final)
        self._final.clear()
        for identity, track in self._tracks.items():
            if not track.reported and track.clear and self._is_settled(track):
                track.reported = True
                final.append((identity, track))
        return LiveSegments(
            Segments.of(
                [track.points for _, track in final],
                np.array([track.sensor for _, track in final]),
            ),
            np.array([identity for identity, _ in final], dtype=np.int64),
            np.array([track.clear and self._is_settled(track) for _, track in final], dtype=bool),
            np.array([track.scan for _, track in final], dtype=np.int64),
        )
