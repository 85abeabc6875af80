"""Merge plan: aligns every pair of maps and checks loop consistency."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from placecell_client import CompactMap

from placecell.localization import Pose
from placecell.map_alignment import (
    AlignmentParameters,
    MapAlignment,
    PairwiseAlignment,
    check_loops,
    fits_as_well,
    poses_from,
)
from placecell.map_alignment.loops import LoopCheck
from placecell.pose_graph.known_loops import KnownLoops
from service.inference.model_registry import Model
from service.maps.snapshot import MapSnapshot
from service.merging.alignment import (
    CancellationCheck,
    MapSide,
    StoredMatchProbabilities,
    align_maps,
)


@dataclass(frozen=True, slots=True, eq=False)
class AlignedPair:
    """Alignment of two of the maps.

    Attributes:
        one: number of the one map.
        other: number of the other map.
        found: alignment of the other map with the one.
        is_rejected: whether loop consistency rules the alignment out.
        is_proven: whether the alignment is part of a loop that closes.
    """

    one: int
    other: int
    found: MapAlignment
    is_rejected: bool
    is_proven: bool


@dataclass(frozen=True, slots=True, eq=False)
class MergePlan:
    """Poses of maps in the frame of the first one.

    Attributes:
        sides: the maps; the others are aligned with the first.
        pairs: alignments of all pairs.
        checked: result of the loop check.
        poses: transform from each map's frame into the first's, by number; only of maps that are
            connected with the first.
        loops: loops that were found within and between the maps, for the optimization of the merged
            map; None if none were searched.
    """

    sides: tuple[MapSide, ...]
    pairs: tuple[AlignedPair, ...]
    checked: LoopCheck
    poses: dict[int, Pose]
    loops: KnownLoops | None = None

    @property
    def maps(self) -> tuple[MapSnapshot, ...]:
        """Snapshots of the maps."""
        return tuple(side.snapshot for side in self.sides)


def plan_merge(
    maps: Sequence[MapSnapshot],
    model: Model,
    parameters: AlignmentParameters,
    check: CancellationCheck,
    prepare: Callable[[CompactMap], CompactMap] | None = None,
) -> MergePlan:
    """Align all pairs, reject inconsistent alignments, and place connected maps in the first.

    Args:
        maps: the maps.
        model: model of their descriptors.
        parameters: parameters of the alignments.
        check: raises `Cancelled` if the deadline passed or the client disconnected.
        prepare: function that changes the poses of each map's captures first; None: they stay.
    """
    return plan_of(
        tuple(MapSide.of(snapshot, prepare) for snapshot in maps), model, parameters, check
    )


def plan_of(
    sides: tuple[MapSide, ...],
    model: Model,
    parameters: AlignmentParameters,
    check: CancellationCheck,
) -> MergePlan:
    """Plan the merge of prepared maps; see `plan_merge`."""
    found: dict[tuple[int, int], MapAlignment] = {}
    for one in range(len(sides) - 1):
        found |= _with_later(one, sides, model, parameters, check)
    edges = [
        PairwiseAlignment(
            one,
            other,
            each.best.pose,
            each.best.pose.apply(each.best.source.mean(axis=0)),
            each.best.score,
        )
        for (one, other), each in found.items()
        if each.best is not None and each.pose is not None
    ]

    def fits(index: int, pose: Pose) -> bool:
        check()
        one, other = edges[index].one, edges[index].other
        best = found[one, other].best
        assert best is not None  # edges are made of alignments with a best overlap
        likeness = StoredMatchProbabilities(model, sides[one].content, sides[other].content, check)
        return fits_as_well(sides[one].view, sides[other].view, pose, best, likeness, parameters)

    checked = check_loops(edges, fits)
    numbers = {(edge.one, edge.other): number for number, edge in enumerate(edges)}
    pairs = tuple(
        AlignedPair(
            one=pair[0],
            other=pair[1],
            found=each,
            is_rejected=numbers.get(pair) in checked.rejected,
            is_proven=numbers.get(pair) in checked.proven,
        )
        for pair, each in found.items()
    )
    return MergePlan(sides, pairs, checked, poses_from(0, edges, checked))


def _with_later(
    one: int,
    sides: Sequence[MapSide],
    model: Model,
    parameters: AlignmentParameters,
    check: CancellationCheck,
) -> dict[tuple[int, int], MapAlignment]:
    """Align each later map with this one.

    A function of its own, so that one index at a time is in memory; it may exceed its map.
    """
    index = sides[one].index(model)
    return {
        (one, other): align_maps(sides[one], sides[other], index, model, parameters, check)
        for other in range(one + 1, len(sides))
    }
