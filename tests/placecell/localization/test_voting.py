import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.voting import most_voted


def haystack(right: int, wrong: int, seed: int = 0) -> tuple[Correspondences, np.ndarray]:
    """Return shuffled correspondences of one motion and of none, and which are right."""
    random = np.random.default_rng(seed)
    pose = Pose.of_yaw(2.0, np.array([300.0, -100, 5]))
    source = random.uniform(-40, 40, (right + wrong, 3)) * (1, 1, 0.05)
    target = pose.apply(source) + random.normal(scale=0.2, size=source.shape)
    target[right:] = random.uniform(-500, 500, (wrong, 3)) * (1, 1, 0.01)
    order = random.permutation(right + wrong)
    numbers = np.arange(right + wrong)
    found = Correspondences(
        numbers, numbers, numbers, source[order], target[order], np.ones(len(order)), len(order)
    )
    return found, np.flatnonzero(order < right)


@pytest.mark.parametrize("seed", range(5))
def test_correspondences_of_one_motion_are_kept(seed: int) -> None:
    found, right = haystack(30, 9_970, seed)
    kept = most_voted(found, LocalizationParameters())
    assert len(kept) == LocalizationParameters().most
    assert np.isin(right, kept.queries).all()
    assert (np.diff(kept.queries) > 0).all()  # in their old order


def test_few_correspondences_are_all_kept() -> None:
    found, _ = haystack(30, 100)
    assert most_voted(found, LocalizationParameters()) is found


def test_a_query_counts_once_in_a_cell() -> None:
    """A thousand adjacent places of one query count as one."""
    found, right = haystack(12, 2_000)
    random = np.random.default_rng(1)
    crowd = Correspondences(
        np.concatenate([found.queries, np.full(1_000, 5_000)]),
        np.arange(len(found) + 1_000),
        np.arange(len(found) + 1_000),
        np.concatenate([found.source, np.zeros((1_000, 3))]),
        np.concatenate([found.target, random.uniform(0, 1, (1_000, 3))]),
        np.ones(len(found) + 1_000),
        len(found) + 1,
    )
    kept = most_voted(crowd, LocalizationParameters(most=300))
    assert np.isin(right, kept.queries).all()


def test_two_motions_are_both_kept() -> None:
    one, right = haystack(30, 2_000, seed=0)
    other, also_right = haystack(30, 2_000, seed=1)
    both = Correspondences(
        np.concatenate([one.queries, other.queries + len(one)]),
        np.arange(len(one) + len(other)),
        np.arange(len(one) + len(other)),
        np.concatenate([one.source, other.source]),
        np.concatenate([one.target, other.target + (2_000.0, -5_000.0, 0.0)]),
        np.ones(len(one) + len(other)),
        len(one) + len(other),
    )
    kept = most_voted(both, LocalizationParameters(most=600))
    assert np.isin(right, kept.queries).all()
    assert np.isin(also_right + len(one), kept.queries).all()


def test_request_that_is_late_is_stopped() -> None:
    found, _ = haystack(30, 4_000)
    token = CancelToken()
    token.cancel()
    with cancelled_by(token), pytest.raises(Cancelled):
        most_voted(found, LocalizationParameters())
