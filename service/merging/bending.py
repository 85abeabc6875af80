"""Bending: optimizes the pose graph of a stored map, and moves its segments with their captures."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from zlib import crc32

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.canonical import canonical
from placecell_client.maps.moved_captures import moved_centroids
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int64
from placecell.pose_graph import (
    BentMap,
    CaptureOdometry,
    GraphFrames,
    GraphMap,
    PoseGraphParameters,
    PoseGraphUnavailableError,
    bend,
)
from placecell.pose_graph.frames import headings
from placecell.pose_graph.known_loops import KnownLoops
from placecell.pose_graph.loops import chosen_captures
from placecell.pose_graph.odometry_correction import with_corrected_odometry
from placecell.pose_graph.optimize import solver
from service.core.cost import Cost, cost_of_search
from service.core.problems import Problem
from service.inference.model_registry import Model
from service.maps.index import index_of
from service.maps.layers import MapLayers
from service.maps.writes.writer import MapWriter, WriteResult
from service.merging.alignment import CancellationCheck
from service.merging.graph_search import StoredSegmentSearch
from service.merging.loop_memory import LoopMemory

APART_SECONDS, APART_METERS = 60.0, 50.0
"""Gap between two captures of a robot from which they are not connected, if the map states no
odometry: the robot may have been carried, or its odometry begun anew."""

DECIMETERS = 10.0
"""Units of the boxes of a map in one meter."""


@dataclass(frozen=True, slots=True, eq=False)
class OptimizedMap:
    """Result of the optimization of a stored map, or of its dry run.

    Attributes:
        bent: captures, loops and optimized poses.
        content: the map after it; None if no capture moves.
        robots: name of the robot of each capture.
        written: result of the write; None after a dry run.
        previous: sequence of the version before.
    """

    bent: BentMap
    content: CompactMap | None
    robots: tuple[str, ...]
    written: WriteResult | None
    previous: int


def check_solver() -> None:
    """Check that poses can be optimized; 501 if not.

    Raises:
        Problem: 501, the package gtsam is missing.
    """
    try:
        solver()
    except PoseGraphUnavailableError as error:
        raise Problem(501, "pose-graph-missing", f"{error}") from error


def graph_of(content: CompactMap) -> GraphMap:
    """Return the captures and segments of a map as a pose graph."""
    yaws = headings(Rotation.from_quat(content.frame_orientations).as_matrix())
    positions = content.frame_positions
    if content.frame_tracks is not None and content.frame_odometry is not None:
        stated = content.frame_odometry
        odometry = CaptureOdometry(
            content.frame_tracks.astype(np.int64), stated[:, :3], stated[:, 3], stated[:, 4:]
        )
    else:
        odometry = CaptureOdometry.from_poses(_tracks_of(content), positions, yaws)
    frames = GraphFrames(content.frame_times, positions, yaws, odometry)
    sides = None if content.extents is None else content.extents[:, :2] / DECIMETERS
    return GraphMap(frames, content.centroids, content.frame_index.astype(np.int64), sides)


def bent_content(
    content: CompactMap, graph: GraphMap, positions: Float64, yaws: Float64
) -> CompactMap:
    """Return the map with its captures at other positions and headings, in canonical form.

    Segments keep their place relative to their capture's sensor, by the rule of delta files
    (`moved_centroids`). The odometry of the captures stays as it was, so that a later optimization
    begins with the same one.
    """
    turns = Rotation.from_euler("z", (yaws - graph.frames.yaws)[:, None])
    turned = (turns * Rotation.from_quat(content.frame_orientations)).as_quat().astype(np.float32)
    still = (positions == content.frame_positions).all(axis=1) & (yaws == graph.frames.yaws)
    turned[still] = content.frame_orientations[still]
    odometry = graph.frames.odometry
    rows = content.frame_index
    after = replace(
        content,
        centroids=moved_centroids(
            content.centroids,
            content.frame_positions[rows],
            content.frame_orientations[rows],
            positions[rows],
            turned[rows],
        ),
        frame_positions=positions,
        frame_orientations=turned,
        frame_tracks=odometry.tracks.astype(np.uint32),
        frame_odometry=np.column_stack([odometry.positions, odometry.yaws, odometry.variances]),
    )
    return canonical(after)


def bend_content(
    content: CompactMap,
    model: Model,
    parameters: PoseGraphParameters,
    known: KnownLoops | None = None,
) -> tuple[BentMap, CompactMap | None]:
    """Optimize the pose graph of a map; return its content if a capture moves.

    Args:
        content: the map.
        model: model of its descriptors.
        parameters: constants of the pose graph.
        known: loops of an earlier optimization of the map.

    Raises:
        Cancelled: The request is late, or its client disconnected.
        PoseGraphUnavailableError: The package gtsam is missing.
    """
    layers = MapLayers.of(content)
    search = StoredSegmentSearch(
        model,
        content.codes,
        index_of(content.codes, model.manifest.quantizer),
        layers.sites.of(layers, model.manifest),
    )
    graph = graph_of(content)
    bent = bend(graph, search, parameters, model.confidence, known=known)
    if _is_settled(bent.moved, parameters):
        return bent, None
    return bent, bent_content(content, graph, bent.positions, bent.yaws)


def _is_settled(moved: Float64, parameters: PoseGraphParameters) -> bool:
    """Return whether an optimization moves captures, meters, by so little that the map stays."""
    if not len(moved):
        return True
    mean = np.sqrt((moved**2).mean())
    return bool(mean <= parameters.settled and moved.max() <= parameters.settled_most)


AS_DRIVEN = 1e-3
"""Distance between a capture and its odometry up to which it was not moved yet, meters."""


def straightened(content: CompactMap) -> CompactMap:
    """Return a robot's map with its odometry corrected by segments that were seen several times.

    A map that drifts less is aligned with others more easily. A map whose captures were moved
    already stays as it is.
    """
    graph = graph_of(content)
    driven = graph.as_driven()
    moved = np.linalg.norm(driven.frames.positions - graph.frames.positions, axis=1)
    if not len(moved) or moved.max() > AS_DRIVEN:
        return content
    frames = with_corrected_odometry(driven, PoseGraphParameters()).frames
    if frames is driven.frames:
        return content
    return bent_content(content, graph, frames.positions, frames.yaws)


@dataclass(frozen=True, slots=True)
class Optimizer:
    """Optimizes a stored map for one request.

    Attributes:
        writer: writes the map.
        parameters: constants of the pose graph.
        dry_run: write nothing; only return what would change.
        check: raises `Cancelled` if the deadline passed or the client disconnected.
        memory: loops of earlier optimizations: only new captures are localized.
    """

    writer: MapWriter
    parameters: PoseGraphParameters
    dry_run: bool
    check: CancellationCheck
    memory: LoopMemory = field(default_factory=LoopMemory)

    def optimize(self, name: str) -> OptimizedMap:
        """Optimize the poses of a map's captures, and write the moved map as one version.

        Raises:
            Problem: 404 if there is no such map, 409 if it was written in the meantime, 501 if the
                package gtsam is missing, and the problems of `MapWriter`.
        """
        check_solver()
        maps = self.writer.maps
        before = maps.get(name)
        self.writer.conditions.check(before.tag)
        model = self.writer.models.named(before.model_id)
        content = before.layers.content()
        uid, finder = before.head.uid, f"{model.id} {self.parameters!r}"
        known = self.memory.get(uid, finder)
        bent, after = bend_content(content, model, self.parameters, known)
        if bent.known is not None:
            self.memory.put(uid, finder, bent.known)
        robots = robots_of_captures(content)
        sequence = before.head.sequence
        if self.dry_run or after is None:
            written = None if self.dry_run else WriteResult(before, 0, 0)
            return OptimizedMap(bent, after, robots, written, sequence)
        self.check()
        with maps.writing(name):
            snapshot = maps.get(name)
            if snapshot.tag != before.tag:
                raise Problem(
                    409,
                    "map-changed",
                    f"Map {name!r:.80} was written during the optimization; nothing was changed. "
                    "Try again.",
                )
            change = snapshot.layers.change_to(after, sequence, content)
            written = self.writer.commit(snapshot, change, "optimize")
        return OptimizedMap(bent, after, robots, written, sequence)


def robots_of_captures(content: CompactMap) -> tuple[str, ...]:
    """Return the name of the robot of each capture: that of its first segment."""
    captures, first = np.unique(content.frame_index, return_index=True)
    names = [""] * len(content.frame_times)
    for capture, row in zip(captures.tolist(), first.tolist(), strict=True):
        names[capture] = content.robots[int(content.robot[row])]
    return tuple(names)


def cost_of_loops(contents: Sequence[CompactMap], parameters: PoseGraphParameters) -> Cost:
    """Return the cost of searching the loops within and between maps, if none is known yet.

    The localization of each capture takes about as long as the search, and is not counted.
    """
    maps = [each for each in contents if len(each)]
    captures = sum(len(chosen_captures(graph_of(each), parameters)) for each in maps)
    queries = captures * parameters.landmarks * parameters.views
    return cost_of_search(queries, sum(map(len, maps)), parameters.candidates, 1)


def _tracks_of(content: CompactMap) -> Int64:
    """Return a number for each stretch of a robot's captures without a gap, int64 (f,)."""
    origins = _origins_of(content)
    tracks = np.zeros(len(content.frame_times), dtype=np.int64)
    for origin in dict.fromkeys(origins):
        rows = np.flatnonzero(np.array([each == origin for each in origins]))
        rows = rows[np.argsort(content.frame_times[rows], kind="stable")]
        seconds = np.diff(content.frame_times[rows])
        meters = np.linalg.norm(np.diff(content.frame_positions[rows], axis=0), axis=1)
        gaps = (seconds > APART_SECONDS) | (meters > APART_METERS)
        part = np.concatenate([[0], np.cumsum(gaps)])
        begins = content.frame_times[rows][np.flatnonzero(np.diff(part, prepend=-1))]
        keys = [f"{origin}/{begins[number]!r}" for number in range(len(begins))]
        numbers = np.array([crc32(key.encode()) or 1 for key in keys], dtype=np.int64)
        tracks[rows] = numbers[part]
    return tracks


def _origins_of(content: CompactMap) -> Sequence[tuple[str, str]]:
    """Return the robot and the source map of each capture."""
    robots = robots_of_captures(content)
    sources = [""] * len(robots)
    if content.source is not None:
        captures, first = np.unique(content.frame_index, return_index=True)
        for capture, row in zip(captures.tolist(), first.tolist(), strict=True):
            number = int(content.source[row])
            sources[capture] = content.sources[number - 1] if number else ""
    return list(zip(robots, sources, strict=True))


def parts_listed(result: OptimizedMap) -> list[tuple[list[str], int, float]]:
    """Return robots, number of captures and largest movement of each part, the largest first."""
    bent = result.bent
    listed = []
    for part in range(int(bent.parts.max()) + 1 if len(bent.parts) else 0):
        rows = np.flatnonzero(bent.parts == part)
        robots = Counter(result.robots[row] for row in rows.tolist())
        listed.append((sorted(robots), len(rows), float(bent.moved[rows].max())))
    return sorted(listed, key=lambda each: -each[1])


def movement(bent: BentMap) -> Float64:
    """Return median and largest movement of the captures, meters, float64 (2,)."""
    moved = bent.moved
    return np.array([np.median(moved), moved.max()]) if len(moved) else np.zeros(2)
