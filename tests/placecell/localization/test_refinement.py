import numpy as np
import pytest

from placecell.core.types import Float64, Int64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.refinement import kernel, one_to_one, refine, residuals

IDENTITY = Pose.of_yaw(0.0, np.zeros(3))


def pairs(
    queries: list[int], places: list[int], source: Float64, target: Float64
) -> Correspondences:
    rows: Int64 = np.arange(len(queries))
    return Correspondences(
        np.array(queries), np.array(places), rows, source, target, np.ones(len(rows)), 9
    )


def test_the_kernel_by_hand() -> None:
    assert kernel(np.array([0.0, 0.5, 1.5]), 0.5) == pytest.approx([1, 1 / 4, 1 / 100])


def test_each_query_and_each_place_once_the_nearest() -> None:
    zero = np.zeros((4, 3))
    target = np.array([[0.4, 0, 0], [0.1, 0, 0], [0.2, 0, 0], [5, 0, 0]])
    # 0 and 1 are of one query, 1 and 2 of one place, 3 is too far away.
    found = pairs([0, 0, 1, 2], [0, 1, 1, 3], zero, target)
    assert one_to_one(IDENTITY, found, 1.5).tolist() == [1]
    np.testing.assert_allclose(residuals(IDENTITY, found), [0.4, 0.1, 0.2, 5])


def test_refinement_collects_inliers_and_drops_outliers() -> None:
    random = np.random.default_rng(0)
    true = Pose.of_yaw(0.3, np.array([10.0, 20, 1]))
    source = random.uniform(-30, 30, (40, 3))
    target = true.apply(source) + random.normal(scale=0.1, size=source.shape)
    target[25:] += random.uniform(2, 40, (15, 3))
    found = pairs(list(range(40)), list(range(40)), source, target)
    begun = Pose.of_yaw(0.32, np.array([10.8, 19.5, 1]))
    pose, agreeing = refine(begun, found, LocalizationParameters())
    assert agreeing.tolist() == list(range(25))
    meters, angle = pose.difference(true, np.zeros(3))
    assert meters < 0.1
    assert np.degrees(angle) < 0.3


def test_without_inliers_the_pose_is_unchanged() -> None:
    found = pairs([0, 1], [0, 1], np.zeros((2, 3)), np.full((2, 3), 50.0))
    pose, agreeing = refine(IDENTITY, found, LocalizationParameters())
    assert pose is IDENTITY
    assert not len(agreeing)
