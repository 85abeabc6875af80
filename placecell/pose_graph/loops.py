"""Loops: captures that are localized in other parts of their own map, or in other robots' parts.

Each capture is localized with the segments around it, as a robot would be, but only in stretches of
the map that were not seen on the same way. A stretch is short, so drift hardly bends it, and one
pass through a street does not mix with another pass that drifted away from it.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from placecell.core.cancellation import current
from placecell.core.processors import available_cores
from placecell.core.progress import Progress, silent
from placecell.core.spatial import evenly, within
from placecell.core.types import Bool, Float64, Int64
from placecell.localization import Candidates, Confidence, Localization
from placecell.localization.confidence import shipped
from placecell.localization.correspondences import number_places
from placecell.localization.covariance import at_point
from placecell.localization.guided_matching import match_guided
from placecell.localization.localize import find_places, judge
from placecell.map_alignment import MatchProbabilities
from placecell.pose_graph.frames import NO_TRACK, GraphFrames, Links, relative, rotated
from placecell.pose_graph.parameters import PoseGraphParameters


class SegmentSearch(MatchProbabilities, Protocol):
    """Search for similar segments within one map, and their match probabilities."""

    def nearest(self, rows: Int64, excluded: Bool, k: int) -> tuple[Int64, Float64]:
        """Return the k most similar rows of each row, apart from excluded ones.

        Args:
            rows: int64 (m,), rows of the map.
            excluded: bool (n,), rows that are not searched.
            k: number of rows; fewer if the others are fewer.

        Returns:
            Rows, int64 (m, k), and their match probabilities, float64 (m, k).
        """


@dataclass(frozen=True, eq=False)
class GraphMap:
    """Segments of a map and the captures that they were seen from.

    Attributes:
        frames: the captures.
        centroids: float64 (n, 3), meters, in the map.
        captures: int64 (n,), capture of each segment.
        sides: float64 (n, 2), meters, horizontal sides of each segment's box along the axes of the
            odometry frame, 0 if not known; None if none is known.
    """

    frames: GraphFrames
    centroids: Float64
    captures: Int64
    sides: Float64 | None = None

    def as_driven(self) -> "GraphMap":
        """Return the map with the captures of each track at the poses of their odometry."""
        odometry = self.frames.odometry
        has_track = odometry.tracks != NO_TRACK
        return self.moved(
            np.where(has_track[:, None], odometry.positions, self.frames.positions),
            np.where(has_track, odometry.yaws, self.frames.yaws),
        )

    def moved(self, positions: Float64, yaws: Float64) -> "GraphMap":
        """Return the map with its captures at other poses; each segment moves with its capture."""
        before = self.frames
        offsets = self.centroids - before.positions[self.captures]
        turned = rotated(offsets, (yaws - before.yaws)[self.captures])
        return replace(
            self,
            frames=before.moved(positions, yaws),
            centroids=positions[self.captures] + turned,
        )


@dataclass(frozen=True, slots=True, eq=False)
class FoundLoop:
    """Loop: a capture that was localized at another one.

    Attributes:
        one: capture near which it was localized.
        other: the localized capture.
        position: float64 (3,), meters, position of `other` in the level frame of `one`.
        yaw: heading of `other` in that frame, radians.
        covariance: float64 (4, 4), of position and heading.
        probability: probability that the pose is right.
        inliers: number of segments that agree.
    """

    one: int
    other: int
    position: Float64
    yaw: float
    covariance: Float64
    probability: float
    inliers: int


def links_of(loops: Sequence[FoundLoop], parameters: PoseGraphParameters) -> Links:
    """Return loops as links of the graph, with the smallest deviations of a loop."""
    variances = np.array(
        [
            (
                np.linalg.eigvalsh(each.covariance[:2, :2])[-1],
                each.covariance[2, 2],
                each.covariance[3, 3],
            )
            for each in loops
        ]
    ).reshape(-1, 3)
    least = np.array(
        [
            parameters.least_deviation,
            parameters.least_deviation,
            np.radians(parameters.least_yaw),
        ]
    )
    return Links(
        np.array([each.one for each in loops], dtype=np.int64),
        np.array([each.other for each in loops], dtype=np.int64),
        np.array([each.position for each in loops], dtype=np.float64).reshape(-1, 3),
        np.array([each.yaw for each in loops], dtype=np.float64),
        np.sqrt(variances + least**2),
    )


def chosen_captures(graph: GraphMap, parameters: PoseGraphParameters) -> Int64:
    """Return the captures to localize: one for each step of way in each track, int64 (m,)."""
    frames = graph.frames
    has_segments = np.bincount(graph.captures, minlength=len(frames)) > 0
    steps = np.floor(frames.ways / parameters.every).astype(np.int64)
    order = frames.order[has_segments[frames.order]]
    keys = np.column_stack([frames.odometry.tracks[order], steps[order]])
    # A capture without odometry stands alone.
    alone = np.where(keys[:, 0] == 0, order + 1, 0)
    keys = np.column_stack([keys, alone])
    new = np.ones(len(order), dtype=bool)
    new[1:] = (keys[1:] != keys[:-1]).any(axis=1)
    return order[new]


def find_loops(
    graph: GraphMap,
    search: SegmentSearch,
    parameters: PoseGraphParameters,
    confidence: Confidence | None = None,
    chosen: Int64 | None = None,
    progress: Progress = silent,
) -> list[FoundLoop]:
    """Localize captures in all parts of the map that they did not see on the same way.

    Args:
        graph: the map.
        search: search for similar segments.
        parameters: constants of the pose graph.
        confidence: model of the probability; None for that of the default model.
        chosen: captures to localize; None: one for each step of way.
        progress: function that shows the progress.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    chosen = chosen_captures(graph, parameters) if chosen is None else chosen
    finder = _LoopFinder(graph, search, parameters, confidence or shipped())
    context = copy_context()  # the threads find the token of the request in it
    loops: list[FoundLoop] = []
    with ThreadPoolExecutor(available_cores(), thread_name_prefix="loops") as threads:
        tasks = [
            threads.submit(context.copy().run, finder.loops_of, capture)
            for capture in chosen.tolist()
        ]
        for number in progress(range(len(tasks)), len(tasks), "localizing captures"):
            loops += tasks[number].result()
    return loops


@dataclass(frozen=True, slots=True, eq=False)
class _Query:
    """Capture to localize, with the landmarks around it.

    Attributes:
        capture: the capture.
        candidates: candidates of its landmarks; centroids are in its level frame.
        asked: int64 (landmarks, views), rows of the views of each landmark.
    """

    capture: int
    candidates: Candidates
    asked: Int64


class _LoopFinder:
    """Localizes captures of one map."""

    def __init__(
        self,
        graph: GraphMap,
        search: SegmentSearch,
        parameters: PoseGraphParameters,
        confidence: Confidence,
    ) -> None:
        self._graph = graph
        self._search = search
        self._parameters = parameters
        self._confidence = confidence
        self._tracks = graph.frames.odometry.tracks[graph.captures]
        self._ways = graph.frames.ways[graph.captures]

    def loops_of(self, capture: int) -> list[FoundLoop]:
        """Return the loops of a capture: one for each stretch in which it is localized."""
        current().check()
        query = self._query(capture)
        if query is None:
            return []
        return [
            loop
            for rows in self._stretches(query)
            if (loop := self._localized(query, rows)) is not None
        ]

    def _query(self, capture: int) -> _Query | None:
        """Search the candidates of the landmarks around a capture; None if there are too few."""
        parameters, frames = self._parameters, self._graph.frames
        rows = self._rows_about(capture, parameters.reach)
        if len(rows) < parameters.local.least_segments:
            return None
        numbers = number_places(rows, self._graph.centroids[rows], parameters.local.same_place)
        order = np.lexsort((np.abs(self._ways[rows] - frames.ways[capture]), numbers))
        _, starts, counts = np.unique(numbers[order], return_index=True, return_counts=True)
        asking = evenly(np.arange(len(starts)), parameters.landmarks)
        starts, counts = starts[asking], counts[asking]
        # The views from nearest to the capture; a landmark with fewer views repeats one.
        views = np.minimum(np.arange(parameters.views), counts[:, None] - 1)
        asked = rows[order][starts[:, None] + views]
        excluded = np.zeros(len(self._graph.captures), dtype=bool)
        excluded[self._rows_about(capture, parameters.away)] = True
        if excluded.all():
            return None
        found, probabilities = self._search.nearest(asked.ravel(), excluded, parameters.candidates)
        repeated = np.zeros(asked.shape, dtype=bool)
        repeated[:, 1:] = asked[:, 1:] == asked[:, :-1]
        probabilities = np.where(repeated.ravel()[:, None], 0.0, probabilities)
        k = found.shape[1] * parameters.views
        found = found.reshape(len(asked), k)
        centroids = rotated(
            self._graph.centroids[asked[:, 0]] - frames.positions[capture],
            np.full(len(asked), -frames.yaws[capture]),
        )
        candidates = Candidates(
            centroids, found, self._graph.centroids[found], probabilities.reshape(len(asked), k)
        )
        return _Query(capture, candidates, asked)

    def _rows_about(self, capture: int, way: float) -> Int64:
        """Return the segments seen within a way of a capture, in its track."""
        frames = self._graph.frames
        track = frames.odometry.tracks[capture]
        if track == 0:
            return np.flatnonzero(self._graph.captures == capture)
        near = np.abs(self._ways - frames.ways[capture]) <= way
        return np.flatnonzero(near & (self._tracks == track))

    def _stretches(self, query: _Query) -> list[Int64]:
        """Return the rows of the stretches that most candidates are in, the best ones first."""
        parameters = self._parameters
        beliefs = query.candidates.beliefs
        total = beliefs.sum(axis=1, keepdims=True)
        shares = np.divide(beliefs, total, out=np.zeros_like(beliefs), where=total > 0).ravel()
        rows = query.candidates.rows.ravel()
        chosen: list[Int64] = []
        left = shares > 0
        while left.any() and len(chosen) < parameters.stretches:
            tracks, steps = self._tracks[rows[left]], self._ways[rows[left]] / parameters.stretch
            keys = np.column_stack([tracks, np.floor(steps).astype(np.int64)])
            cells, inverse = np.unique(keys, axis=0, return_inverse=True)
            weights = np.bincount(inverse.ravel(), shares[left], len(cells))
            best = cells[int(weights.argmax())]
            in_cell = left.copy()
            in_cell[left] = inverse.ravel() == weights.argmax()
            middle = np.average(self._ways[rows[in_cell]], weights=shares[in_cell])
            inside = (self._tracks == best[0]) & (np.abs(self._ways - middle) <= parameters.stretch)
            inside[self._rows_about(query.capture, parameters.away)] = False
            chosen.append(np.flatnonzero(inside))
            left &= ~inside[rows]
            left[in_cell] = False
        return chosen

    def _localized(self, query: _Query, rows: Int64) -> FoundLoop | None:
        """Localize a capture in a stretch; None if it is not localized."""
        parameters = self._parameters
        local = parameters.local
        inside = np.isin(query.candidates.rows, rows)
        candidates = replace(
            query.candidates, probabilities=np.where(inside, query.candidates.probabilities, 0.0)
        )
        there = _Stretch(self._graph, self._search, query.asked, rows)
        places = find_places(candidates, local)
        if not places.hypotheses:
            return None
        beliefs = query.candidates.beliefs.sum(axis=1)
        hypotheses = [
            match_guided(each, candidates, there, local, beliefs) for each in places.hypotheses
        ]
        told = judge(hypotheses, candidates, there, places.usable, local, self._confidence)
        return self._loop(query, told) if told.pose is not None else None

    def _loop(self, query: _Query, told: Localization) -> FoundLoop | None:
        """Return the loop of a localization, by the segments that one pass of a robot saw."""
        frames = self._graph.frames
        best = told.best
        assert best is not None  # the capture is localized
        captures = self._graph.captures[best.rows]
        distances = np.linalg.norm(frames.positions[captures] - best.pose.translation, axis=1)
        one = int(captures[np.lexsort((captures, distances))[0]])
        pose = best.pose
        covariance = at_point(best.covariance, pose, np.zeros(3))
        if not np.isfinite(covariance).all():
            return None
        position, yaw = relative(
            frames.positions[[one]],
            frames.yaws[[one]],
            pose.translation[None],
            np.array([pose.yaw]),
        )
        return FoundLoop(
            one,
            query.capture,
            position[0],
            float(yaw[0]),
            covariance,
            told.probability,
            len(best),
        )


class _Stretch:
    """Segments of a stretch of the map, compared with the landmarks of a query (`MapSegments`)."""

    def __init__(self, graph: GraphMap, search: SegmentSearch, asked: Int64, rows: Int64) -> None:
        self._rows = rows
        self._centroids = graph.centroids[rows]
        self._search = search
        self._asked = asked

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Return the rows of the stretch near some places, and their centroids."""
        inside = within(self._centroids, places, meters)
        return self._rows[inside], self._centroids[inside]

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """Return the match probability of each pair, by the landmark's most similar view."""
        best = np.zeros(len(rows))
        for view in range(self._asked.shape[1]):
            found = self._search.match_probabilities(rows, self._asked[queries, view])
            best = np.maximum(best, found)
        return best
