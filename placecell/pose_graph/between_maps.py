"""Loops between maps: bends several maps that drift, each in its own frame, until they fit.

Maps that drift agree with each other locally, but not as a whole. Loops between them show where.
The largest consistent set of loops gives the initial transform of each map. All maps are then
optimized as one pose graph, and each part of a map is moved back to where it lay in its own map.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.localization import Confidence, Pose
from placecell.localization.registration import register_yaw
from placecell.map_alignment import PairwiseAlignment, poses_from
from placecell.map_alignment.loops import LoopCheck
from placecell.pose_graph.bend import BentMap, judged
from placecell.pose_graph.consistency import consistent_loops, supporters_of
from placecell.pose_graph.frames import (
    NO_TRACK,
    CaptureOdometry,
    GraphFrames,
    Links,
    composed,
    rotated,
    wrapped,
)
from placecell.pose_graph.known_loops import KnownLoops
from placecell.pose_graph.loops import (
    FoundLoop,
    GraphMap,
    SegmentSearch,
    chosen_captures,
    find_loops,
    links_of,
)
from placecell.pose_graph.odometry_correction import with_corrected_odometry
from placecell.pose_graph.optimize import solver
from placecell.pose_graph.parameters import PoseGraphParameters

LEVER = 10.0
"""Distance from a capture to a second point ahead of it, which represents its heading, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class BentMaps:
    """Maps that were bent by the loops between them and within them.

    Attributes:
        poses: for each map, positions, float64 (f, 3), meters, and headings, float64 (f,), radians,
            of its captures. Each part of a map that loops connect keeps its place in the map on
            average.
        known: the loops, for an optimization of the joined maps; None if two maps share an odometry
            track, which does not tell their captures apart then.
    """

    poses: list[tuple[Float64, Float64]]
    known: KnownLoops | None


ALL_RIGHT = LoopCheck((), (), frozenset())
"""Check that rejects no alignment."""


def bend_between(
    graphs: Sequence[GraphMap],
    search: SegmentSearch,
    parameters: PoseGraphParameters,
    confidence: Confidence | None = None,
) -> BentMaps:
    """Bend maps by the loops between them and within them.

    Args:
        graphs: the maps, each in its own frame.
        search: search for similar segments in all maps; its rows are those of the maps, one map
            after the other.
        parameters: constants of the pose graph.
        confidence: model of the loops' probability; None for that of the default model.

    Raises:
        Cancelled: The request is late, or its client disconnected.
        PoseGraphUnavailableError: The extra `pose-graph` is not installed.
    """
    solver()  # before a search that may take minutes
    graph, maps = united(graphs)
    driven = with_corrected_odometry(graph.as_driven(), parameters)
    localized = chosen_captures(driven, parameters)
    loops = find_loops(driven, search, parameters, confidence, localized)
    frames = replace(graph.frames, odometry=driven.frames.odometry)
    initial = initial_poses(frames, maps, links_of(loops, parameters), parameters)
    begun = _placed(frames, [initial[number] for number in maps.tolist()])
    bent = judged(begun, loops, parameters)
    positions, yaws = in_own_frames(bent, frames, maps)
    counts = np.cumsum([len(each.frames) for each in graphs])[:-1]
    poses = list(zip(np.split(positions, counts), np.split(yaws, counts), strict=True))
    return BentMaps(poses, _known(graphs, driven.frames, localized, loops))


def _known(
    graphs: Sequence[GraphMap], frames: GraphFrames, localized: Int64, loops: list[FoundLoop]
) -> KnownLoops | None:
    """Return loops by the tracks that the captures have in their own maps; None if ambiguous."""
    tracks = [each.frames.odometry.tracks for each in graphs]
    own = np.concatenate([np.unique(each[each != NO_TRACK]) for each in tracks])
    if len(np.unique(own)) < len(own):
        return None
    odometry = replace(frames.odometry, tracks=np.concatenate(tracks))
    return KnownLoops.of(replace(frames, odometry=odometry), localized, loops)


def united(graphs: Sequence[GraphMap]) -> tuple[GraphMap, Int64]:
    """Return maps as one graph, with tracks of their own, and the map of each capture (f,)."""
    frames = [each.frames for each in graphs]
    maps = np.repeat(np.arange(len(graphs)), [len(each) for each in frames])
    tracks = np.concatenate([each.odometry.tracks for each in frames])
    _, numbers = np.unique(np.column_stack([maps, tracks]), axis=0, return_inverse=True)
    odometry = CaptureOdometry(
        np.where(tracks == NO_TRACK, NO_TRACK, numbers.ravel() + 1),
        np.concatenate([each.odometry.positions for each in frames]),
        np.concatenate([each.odometry.yaws for each in frames]),
        np.concatenate([each.odometry.variances for each in frames]),
    )
    begins = np.cumsum([0, *(len(each) for each in frames)])[:-1]
    together = GraphMap(
        GraphFrames(
            np.concatenate([each.times for each in frames]),
            np.concatenate([each.positions for each in frames]),
            np.concatenate([each.yaws for each in frames]),
            odometry,
        ),
        np.concatenate([each.centroids for each in graphs]),
        np.concatenate(
            [each.captures + begin for each, begin in zip(graphs, begins.tolist(), strict=True)]
        ),
        _sides(graphs),
    )
    return together, maps


def _sides(graphs: Sequence[GraphMap]) -> Float64 | None:
    """Return the sides of all segments' boxes, 0 for those of maps without; None if none has."""
    if all(each.sides is None for each in graphs):
        return None
    return np.concatenate(
        [
            np.zeros((len(each.centroids), 2)) if each.sides is None else each.sides
            for each in graphs
        ]
    )


def initial_poses(
    frames: GraphFrames, maps: Int64, loops: Links, parameters: PoseGraphParameters
) -> dict[int, Pose]:
    """Return a transform of each map into the frame of the first map that loops connect it with.

    Two maps are placed by the two tracks with the most consistent loops between them.

    Args:
        frames: captures of all maps, each in the frame of its map.
        maps: int64 (f,), map of each capture.
        loops: loops between the captures.
        parameters: constants of the pose graph.
    """
    loops = loops.take(np.flatnonzero(maps[loops.one] != maps[loops.other]))
    loops = loops.take(
        np.flatnonzero(supporters_of(frames, loops, parameters) >= parameters.supporters)
    )
    loops = loops.take(consistent_loops(frames, loops, parameters))
    tracks = frames.odometry.tracks
    ends = np.column_stack([tracks[loops.one], tracks[loops.other]])
    _, groups = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    best: dict[tuple[int, int], PairwiseAlignment] = {}
    for group in range(int(groups.max()) + 1 if len(loops) else 0):
        rows = np.flatnonzero(groups.ravel() == group)
        found = _alignment(frames, maps, loops.take(rows))
        pair = found.one, found.other
        if pair not in best or found.weight > best[pair].weight:
            best[pair] = found
    poses: dict[int, Pose] = {}
    for number in range(int(maps.max()) + 1 if len(maps) else 0):
        if number not in poses:
            poses |= poses_from(number, list(best.values()), ALL_RIGHT)
    return poses


def _alignment(frames: GraphFrames, maps: Int64, loops: Links) -> PairwiseAlignment:
    """Return the least-squares transform of the loops between two tracks of two maps."""
    there, turned = composed(
        frames.positions[loops.one], frames.yaws[loops.one], loops.positions, loops.yaws
    )
    here, heading = frames.positions[loops.other], frames.yaws[loops.other]
    # Loops in both directions, as transforms from the second map to the first.
    first = int(min(maps[loops.one[0]], maps[loops.other[0]]))
    second = int(max(maps[loops.one[0]], maps[loops.other[0]]))
    forward = (maps[loops.one] == first)[:, None]
    ends = _with_lever(here, heading), _with_lever(there, turned)
    forward = np.concatenate([forward, forward])
    source = np.where(forward, ends[0], ends[1])
    target = np.where(forward, ends[1], ends[0])
    pose = register_yaw(source, target, np.ones(len(source)))
    return PairwiseAlignment(first, second, pose, target.mean(axis=0), float(len(loops)))


def in_own_frames(bent: BentMap, frames: GraphFrames, maps: Int64) -> tuple[Float64, Float64]:
    """Return the optimized poses, each part of each map moved back to where it lay in its map.

    Captures without loops stay as they are.

    Args:
        bent: all maps, optimized together.
        frames: the captures, each in the frame of its map.
        maps: int64 (f,), map of each capture.
    """
    positions, yaws = frames.positions.copy(), frames.yaws.copy()
    looped = {int(bent.parts[each.loop.one]) for each in bent.loops if each.verdict == "accepted"}
    for number in np.unique(maps).tolist():
        for part in np.unique(bent.parts[maps == number]).tolist():
            if part not in looped:
                continue
            rows = np.flatnonzero((maps == number) & (bent.parts == part))
            after = bent.positions[rows], bent.yaws[rows]
            pose = register_yaw(
                _with_lever(*after),
                _with_lever(positions[rows], yaws[rows]),
                np.ones(2 * len(rows)),
            )
            positions[rows], yaws[rows] = pose.apply(after[0]), wrapped(after[1] + pose.yaw)
    return positions, yaws


def _placed(frames: GraphFrames, poses: Sequence[Pose]) -> GraphFrames:
    """Return the captures, each moved by its transform."""
    yaws = np.array([each.yaw for each in poses])
    offsets = np.array([each.translation for each in poses]).reshape(-1, 3)
    return frames.moved(rotated(frames.positions, yaws) + offsets, wrapped(frames.yaws + yaws))


def _with_lever(positions: Float64, yaws: Float64) -> Float64:
    """Return the positions (n, 3), and points ahead of them, float64 (2 n, 3)."""
    ahead = np.column_stack([np.cos(yaws), np.sin(yaws), np.zeros(len(yaws))])
    return np.concatenate([positions, positions + LEVER * ahead])
