"""Loop check: rejected alignments and resulting poses."""

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.localization import Pose
from placecell.map_alignment import PairwiseAlignment, check_loops, poses_from
from placecell.map_alignment.loops import loops_of
from tests.placecell.map_alignment.map_builders import a_pose

WRONG = Pose.of_yaw(2.0, np.array([40.0, -7.0, 0.0]))


def frames(count: int, seed: int = 0) -> list[Pose]:
    """Return true poses of maps, kilometers apart; the first is the identity."""
    random = np.random.default_rng(seed)
    return [Pose.of_yaw(0.0, np.zeros(3)), *(a_pose(random) for _ in range(count - 1))]


def alignment(
    truth: Sequence[Pose], one: int, other: int, weight: float = 50.0, error: Pose | None = None
) -> PairwiseAlignment:
    pose = truth[one].inverse().after(truth[other])
    # What both have is at the origin of the one.
    return PairwiseAlignment(one, other, error.after(pose) if error else pose, np.zeros(3), weight)


def ring(truth: Sequence[Pose], wrong: Iterable[int] = ()) -> list[PairwiseAlignment]:
    ends = [(n, (n + 1) % len(truth)) for n in range(len(truth))]
    return [
        alignment(truth, *pair, error=WRONG if number in wrong else None)
        for number, pair in enumerate(ends)
    ]


def assert_laid(poses: dict[int, Pose], truth: Sequence[Pose], maps: Iterable[int]) -> None:
    assert sorted(poses) == sorted(maps)
    for number, pose in poses.items():
        np.testing.assert_allclose(pose.matrix, truth[number].matrix, atol=1e-6)


def test_a_loop_is_measured() -> None:
    truth = frames(3)
    shifted = Pose.of_yaw(np.radians(3.0), np.array([0.0, 2.0, 0.0]))
    edges = [
        alignment(truth, 0, 1),
        alignment(truth, 1, 2),
        alignment(truth, 0, 2, error=shifted.inverse()),
    ]
    (loop,) = check_loops(edges).loops
    assert sorted(loop.maps) == sorted(loop.alignments) == [0, 1, 2]
    # A turn about the origin of the first map, where all that is shared is, and a shift.
    assert loop.meters == pytest.approx(2.0, abs=0.4)
    assert loop.degrees == pytest.approx(3.0)
    assert loop.closes


@pytest.mark.parametrize(
    ("meters", "degrees", "closes"),
    [(2.9, 0.0, True), (3.1, 0.0, False), (0.0, 5.9, True), (0.0, 6.1, False)],
)
def test_loop_tolerance_grows_with_its_alignments(
    meters: float, degrees: float, closes: bool
) -> None:
    truth = [Pose.of_yaw(0.0, np.zeros(3))] * 3
    error = Pose.of_yaw(np.radians(degrees), np.array([meters, 0.0, 0.0]))
    edges = [*ring(truth)[:2], alignment(truth, 0, 2, error=error)]
    (loop,) = loops_of(edges)
    assert (loop.meters, loop.degrees) == pytest.approx((meters, degrees))
    assert loop.closes == closes


def test_right_alignments_are_all_proven() -> None:
    truth = frames(5)
    edges = [alignment(truth, *pair) for pair in combinations(range(5), 2)]
    checked = check_loops(edges)
    assert checked.rejected == ()
    assert all(loop.closes for loop in checked.loops)
    # Ten triangles and fifteen squares; five of five maps are not needed.
    assert len(checked.loops) == 25
    assert checked.proven == frozenset(range(10))
    assert_laid(poses_from(0, edges, checked), truth, range(5))
    # Whatever the map to start from, the others lie to it as they do.
    to_third = {number: truth[3].inverse().after(pose) for number, pose in enumerate(truth)}
    for number, pose in poses_from(3, edges, checked).items():
        np.testing.assert_allclose(pose.matrix, to_third[number].matrix, atol=1e-6)


def test_a_wrong_one_is_outvoted_whatever_its_weight() -> None:
    truth = frames(4)
    edges = [alignment(truth, *pair) for pair in combinations(range(4), 2)]
    edges[2] = alignment(truth, 0, 3, weight=1e6, error=WRONG)
    checked = check_loops(edges)
    assert checked.rejected == (2,)
    assert checked.proven == frozenset({0, 1, 3, 4, 5})
    assert any(not loop.closes for loop in checked.loops)
    assert_laid(poses_from(0, edges, checked), truth, range(4))


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.sets(st.integers(0, 14), min_size=1, max_size=2))
def test_two_wrong_alignments_among_six_maps_are_rejected(seed: int, wrong: set[int]) -> None:
    truth, random = frames(6, seed), np.random.default_rng(seed)
    edges = [
        alignment(
            truth,
            *pair,
            weight=random.uniform(20, 200),
            error=a_pose(random) if n in wrong else None,
        )
        for n, pair in enumerate(combinations(range(6), 2))
    ]
    checked = check_loops(edges)
    assert set(checked.rejected) == wrong
    assert_laid(poses_from(0, edges, checked), truth, range(6))


class ByTruth:
    """Function that accepts a pose if it is the true one, except for undecidable alignments."""

    def __init__(
        self, truth: Sequence[Pose], edges: Sequence[PairwiseAlignment], untold: Iterable[int] = ()
    ) -> None:
        self.truth, self.edges, self.untold = truth, edges, set(untold)
        self.asked: list[int] = []

    def __call__(self, index: int, pose: Pose) -> bool:
        self.asked.append(index)
        edge = self.edges[index]
        true = self.truth[edge.one].inverse().after(self.truth[edge.other])
        meters, angle = pose.difference(true, edge.pose.inverse().apply(edge.middle))
        return index not in self.untold and meters < 1.0 and angle < 0.01


@pytest.mark.parametrize("wrong", [0, 1, 2])
@pytest.mark.parametrize("turned", [False, True])
def test_failing_lone_loop_rejects_the_one_that_fits_otherwise(wrong: int, turned: bool) -> None:
    truth = frames(3)
    # The wrong one weighs most, and the alignments may be told from either side.
    pairs = [(0, 1), (1, 2), (0, 2)]
    edges = [
        alignment(
            truth,
            *(pair[::-1] if turned and number % 2 else pair),
            weight=50.0 if number == wrong else 20.0,
            error=WRONG if number == wrong else None,
        )
        for number, pair in enumerate(pairs)
    ]
    lies = ByTruth(truth, edges)
    checked = check_loops(edges, lies)
    assert checked.rejected == (wrong,)
    assert sorted(lies.asked) == [0, 1, 2]
    # What is left holds no loop, and so nothing is proven.
    assert checked.proven == frozenset()
    assert_laid(poses_from(0, edges, checked), truth, range(3))


def test_failing_lone_loop_rejects_all_without_evidence() -> None:
    truth = frames(3)
    edges = [alignment(truth, 0, 1), alignment(truth, 1, 2), alignment(truth, 0, 2, error=WRONG)]
    for lies in (ByTruth(truth, edges, untold=[2]), lambda *_: True, lambda index, _: index < 2):
        checked = check_loops(edges, lies)
        assert sorted(checked.rejected) == [0, 1, 2]
        assert_laid(poses_from(0, edges, checked), truth, [0])
    assert sorted(check_loops(edges).rejected) == [0, 1, 2]


def test_wrong_alignment_shared_by_two_loops_is_rejected() -> None:
    truth = frames(4)
    edges = [
        alignment(truth, 0, 1),
        alignment(truth, 1, 2),
        alignment(truth, 0, 2, 99.0, error=WRONG),
        alignment(truth, 2, 3),
        alignment(truth, 0, 3),
    ]
    lies = ByTruth(truth, edges)
    checked = check_loops(edges, lies)
    assert checked.rejected == (2,)
    assert lies.asked == []
    assert checked.proven == frozenset({0, 1, 3, 4})
    assert_laid(poses_from(0, edges, checked), truth, range(4))


def test_two_separate_failing_loops_are_both_resolved() -> None:
    truth = frames(5)
    edges = [
        *(alignment(truth, 0, 1), alignment(truth, 1, 2, error=WRONG), alignment(truth, 0, 2)),
        *(alignment(truth, 2, 3), alignment(truth, 3, 4), alignment(truth, 2, 4, error=WRONG)),
    ]
    lies = ByTruth(truth, edges, untold=[5])
    checked = check_loops(edges, lies)
    assert sorted(checked.rejected) == [1, 3, 4, 5]
    assert sorted(lies.asked) == [*range(6)]
    assert_laid(poses_from(0, edges, checked), truth, range(3))


def test_a_long_ring_that_closes_is_proven() -> None:
    truth = frames(9)
    edges = ring(truth)
    checked = check_loops(edges)
    (loop,) = checked.loops
    assert len(loop.maps) == 9
    assert loop.closes
    assert checked.proven == frozenset(range(9))
    assert_laid(poses_from(0, edges, checked), truth, range(9))


def test_a_long_ring_may_miss_by_more_and_breaks_where_it_is_wrong() -> None:
    truth = frames(9)
    slipped = Pose.of_yaw(0.0, np.array([8.9, 0.0, 0.0]))
    edges = [*ring(truth)[:8], alignment(truth, 8, 0, error=slipped)]
    assert check_loops(edges).rejected == ()
    edges = [*ring(truth)[:8], alignment(truth, 8, 0, error=WRONG)]
    checked = check_loops(edges, ByTruth(truth, edges))
    assert checked.rejected == (8,)
    assert_laid(poses_from(0, edges, checked), truth, range(9))


def test_shortcut_shows_the_wrong_half_of_a_ring() -> None:
    # The short cut 0-3 makes one loop of four maps, right, and one of six, wrong in 5-6.
    truth = frames(8)
    edges = [*ring(truth, wrong=[5]), alignment(truth, 0, 3)]
    checked = check_loops(edges)
    assert sorted(checked.rejected) == [3, 4, 5, 6, 7]  # none of the loop that closes
    assert checked.proven == frozenset({0, 1, 2, 8})
    assert check_loops(edges, ByTruth(truth, edges)).rejected == (5,)


def test_alignment_without_a_loop_is_kept_and_unproven() -> None:
    truth = frames(5)
    edges = [*ring(truth[:3]), alignment(truth, 2, 3), alignment(truth, 3, 4, 1.0)]
    checked = check_loops(edges)
    assert checked.rejected == ()
    assert checked.proven == frozenset({0, 1, 2})
    assert_laid(poses_from(0, edges, checked), truth, range(5))


def test_proven_alignment_precedes_a_heavier_one() -> None:
    # Within what a loop may miss, the ways differ; 0-2 was rejected by nobody, but is not proven.
    truth = frames(4)
    slip = Pose.of_yaw(0.0, np.array([0.5, 0.0, 0.0]))
    edges = [
        alignment(truth, 0, 1, 20.0),
        alignment(truth, 1, 2, 20.0),
        alignment(truth, 0, 2, 10.0, error=slip),
    ]
    checked = check_loops(edges)
    assert checked.proven == frozenset({0, 1, 2})
    # The weightiest tree leaves out the third.
    assert_laid(poses_from(0, edges, checked), truth, range(3))


def test_only_connected_maps_get_a_pose() -> None:
    truth = frames(6)
    edges = [alignment(truth, 1, 0), alignment(truth, 3, 4)]
    checked = check_loops(edges)
    assert_laid(poses_from(0, edges, checked), truth, [0, 1])
    assert sorted(poses_from(5, edges, checked)) == [5]
    nothing = check_loops([])
    assert (nothing.rejected, nothing.loops, nothing.proven) == ((), (), frozenset())
    assert_laid(poses_from(0, [], nothing), truth, [0])


def test_alignment_has_a_pose_from_either_map() -> None:
    truth = frames(3, seed=4)
    there = alignment(truth, 0, 1)
    back = PairwiseAlignment(1, 0, there.pose.inverse(), there.middle_in(1), there.weight)
    np.testing.assert_allclose(back.into(0).matrix, there.into(0).matrix, atol=1e-9)
    np.testing.assert_allclose(back.middle_in(0), there.middle_in(0), atol=1e-9)
    for first in (there, back):
        edges = [first, alignment(truth, 1, 2), alignment(truth, 2, 0)]
        (loop,) = check_loops(edges).loops
        assert loop.meters < 1e-6
