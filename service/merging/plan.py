"""Which maps can be merged, and how they lie: all pairs are aligned, and loops are checked."""

from collections.abc import Sequence
from dataclasses import dataclass

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
from service.inference.model_registry import Model
from service.maps.snapshot import MapSnapshot
from service.merging.alignment import Check, MapSide, StoredMatchProbabilities, align_maps


@dataclass(frozen=True, slots=True, eq=False)
class AlignedPair:
    """What was found of two maps.

    Attributes:
        one, other: their numbers.
        found: how the other lies to the one.
        is_rejected: whether loops rule it out.
        is_proven: whether a loop that closes holds it.
    """

    one: int
    other: int
    found: MapAlignment
    is_rejected: bool
    is_proven: bool


@dataclass(frozen=True, slots=True, eq=False)
class MergePlan:
    """How maps lie to the first of them.

    Attributes:
        sides: the maps; the first is the one that the others are laid on.
        pairings: of each two.
        checked: what the loops say.
        poses: by number, from the map's frame to the first's, of those that can be laid on it.
    """

    sides: tuple[MapSide, ...]
    pairings: tuple[AlignedPair, ...]
    checked: LoopCheck
    poses: dict[int, Pose]

    @property
    def maps(self) -> tuple[MapSnapshot, ...]:
        """As they are stored."""
        return tuple(side.stored for side in self.sides)


def plan_merge(
    maps: Sequence[MapSnapshot], model: Model, parameters: AlignmentParameters, check: Check
) -> MergePlan:
    """Align each two, reject what loops rule out, and lay all that is connected on the first."""
    sides = tuple(MapSide.of(stored) for stored in maps)
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

    def lies(index: int, pose: Pose) -> bool:
        check()
        one, other = edges[index].one, edges[index].other
        best = found[one, other].best
        assert best is not None  # of that it is an edge
        likeness = StoredMatchProbabilities(model, sides[one].content, sides[other].content, check)
        return fits_as_well(sides[one].view, sides[other].view, pose, best, likeness, parameters)

    checked = check_loops(edges, lies)
    numbers = {(edge.one, edge.other): number for number, edge in enumerate(edges)}
    pairings = tuple(
        AlignedPair(
            *pair,
            each,
            numbers.get(pair) in checked.rejected,
            numbers.get(pair) in checked.proven,
        )
        for pair, each in found.items()
    )
    return MergePlan(sides, pairings, checked, poses_from(0, edges, checked))


def _with_later(
    one: int,
    sides: Sequence[MapSide],
    model: Model,
    parameters: AlignmentParameters,
    check: Check,
) -> dict[tuple[int, int], MapAlignment]:
    """How each map after this one lies to it.

    By itself, so that no two indices are there at once: one may be larger than its map.
    """
    index = sides[one].index(model)
    return {
        (one, other): align_maps(sides[one], sides[other], index, model, parameters, check)
        for other in range(one + 1, len(sides))
    }
