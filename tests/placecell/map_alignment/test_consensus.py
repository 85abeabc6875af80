"""Consensus of submap poses, with values by hand."""

import numpy as np
import pytest

from placecell.localization import LocalizationParameters, Pose
from placecell.map_alignment import AlignmentParameters
from placecell.map_alignment.consensus import SubmapPose, agreement, common_pose, consensus

PARAMETERS = AlignmentParameters()


def guess(
    submap: int, x: float, shift: tuple[float, float] = (0.0, 0.0), yaw: float = 0.0,
    score: float = 1.0,
) -> SubmapPose:  # fmt: skip
    """Return a pose of a submap at x, shifted, and rotated about its center by degrees."""
    middle = np.array([x, 0.0, 0.0])
    turn = Pose.of_yaw(np.radians(yaw), np.zeros(3))
    return SubmapPose(
        submap, middle, Pose(turn.rotation, middle + (*shift, 0.0) - turn.apply(middle)), score
    )


def test_two_poses_agree_if_each_predicts_the_other() -> None:
    base = guess(0, 0.0)
    for other, agrees in [
        (guess(1, 100.0, (2.9, 0.0)), True),
        # Three meters, and 3 cm more for each meter between them.
        (guess(1, 100.0, (5.9, 0.0)), True),
        (guess(1, 100.0, (6.1, 0.0)), False),
        (guess(1, 0.0, (2.9, 0.0)), True),
        (guess(1, 0.0, (3.1, 0.0)), False),
        # Turned by three degrees, it puts the first 5.2 m off,
        (guess(1, 100.0, yaw=3.0), True),
        # by four, 7 m, though it lies itself where it should,
        (guess(1, 100.0, yaw=4.0), False),
        # and by more than six degrees it is another direction, however near.
        (guess(1, 1.0, yaw=5.9), True),
        (guess(1, 1.0, yaw=6.1), False),
        (guess(1, 1.0, yaw=180.0), False),
    ]:
        told = agreement([base, other], PARAMETERS)
        np.testing.assert_array_equal(told, [[True, agrees], [agrees, True]])


def test_yaws_are_compared_across_half_a_turn() -> None:
    told = agreement([guess(0, 0.0, yaw=179.0), guess(1, 1.0, yaw=-179.0)], PARAMETERS)
    assert told.all()


def test_sets_come_the_weightiest_first_and_share_no_guess() -> None:
    weak = [guess(n, 20.0 * n) for n in range(3)]
    strong = [guess(n, 20.0 * n, (50.0, 0.0), score=2.0) for n in range(2, 5)]
    lone = [guess(7, 0.0, (-90.0, 0.0), score=2.5)]
    first, second, third = consensus([*weak, *strong, *lone], PARAMETERS)
    assert (first, second, third) == (strong, weak, lone)


def test_a_submap_counts_once_by_its_best_guess() -> None:
    # Three guesses of one submap are no consensus: worth 3, not 9.
    same = [guess(0, 0.0, (0.1 * n, 0.0), score=3.0 - 0.1 * n) for n in range(3)]
    other = [guess(n, 20.0 * n, (50.0, 0.0), score=1.5) for n in range(1, 4)]
    first, second, *more = consensus([*same, *other], PARAMETERS)
    assert first == other
    assert second == same[:1]
    # Nor do the others of that submap make a set of their own.
    assert more == []


def test_number_of_sets_is_limited() -> None:
    many = [guess(n, 0.0, (20.0 * n, 0.0)) for n in range(9)]
    assert len(consensus(many, PARAMETERS)) == PARAMETERS.alignments
    assert consensus([], PARAMETERS) == []


def test_a_thousand_poses_are_grouped() -> None:
    random = np.random.default_rng(0)
    wrong = [
        guess(n % 120, 10.0 * (n % 120), tuple(random.uniform(-500, 500, 2)), 360 * random.random())
        for n in range(1_000)
    ]
    right = [guess(n, 10.0 * n, tuple(random.normal(scale=0.5, size=2))) for n in range(40)]
    first = consensus([*wrong, *right], PARAMETERS)[0]
    assert len(set(map(id, first)) & set(map(id, right))) > 35
    assert len(first) < 45


@pytest.mark.parametrize("model", ["yaw", "se3"])
def test_common_pose_is_weighted_by_score(model: str) -> None:
    parameters = AlignmentParameters(local=LocalizationParameters(model=model))  # type: ignore[arg-type]
    # Two guesses about one place: a shift of 0 with score 3, of 1 m with score 1.
    two = [guess(0, 0.0, score=3.0), guess(0, 0.0, (1.0, 0.0), score=1.0)]
    np.testing.assert_allclose(
        common_pose(two, parameters).matrix,
        Pose.of_yaw(0.0, np.array([0.25, 0.0, 0.0])).matrix,
        atol=1e-12,
    )
    # Of one guess it is that guess.
    one = guess(0, 30.0, (4.0, 5.0), 33.0)
    np.testing.assert_allclose(common_pose([one], parameters).matrix, one.pose.matrix, atol=1e-9)
