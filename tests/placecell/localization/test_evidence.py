import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.localization import LocalizationParameters, Pose, localize
from placecell.localization.evidence import RequestHistory, middle_of
from placecell.localization.hypothesis import Hypothesis
from tests.placecell.localization.scene_builders import scene
from tests.placecell.localization.test_localize import look_alikes

PARAMETERS = LocalizationParameters(memory=10.0, half_life=3.0, past_weight=0.5, remembered=4)


def hypothesis(x: float, score: float, yaw: float = 0.0) -> Hypothesis:
    """Return a hypothesis at x meters along the map, with segments around the robot."""
    source = np.array([[-10.0, 0, 0], [10, 0, 0], [0, 10, 0], [0, -10, 0]])
    numbers = np.arange(4)
    pose = Pose.of_yaw(yaw, np.array([x, 0.0, 0.0]))
    return Hypothesis(pose, np.eye(4), score, numbers, numbers, source, np.zeros(4))


def at(x: float) -> Float64:
    """Return the mean centroid at x meters along the robot's path."""
    return np.array([x, 0.0, 0.0])


def driven(history: RequestHistory, start: float, end: float, *found: Hypothesis) -> None:
    """Add five requests at distances of 4 m with one result; then the robot is at 0."""
    for number, time in enumerate(np.linspace(start, end, 5)):
        history.add(float(time), at(4.0 * number - 20), found)


def test_the_same_place_is_supported_and_another_is_not() -> None:
    history = RequestHistory(PARAMETERS)
    history.add(100.0, at(-5), [hypothesis(0, 20), hypothesis(50, 8), hypothesis(51, 6)])
    now = history.at(100.0, at(0))
    assert now.support(hypothesis(1, 5)) == pytest.approx(10)
    assert now.support(hypothesis(52, 5)) == pytest.approx(4)  # the better of two counts
    assert now.support(hypothesis(20, 5)) == 0
    assert now.support(hypothesis(0, 5, yaw=0.5)) == 0


def test_support_fades_and_is_forgotten() -> None:
    history = RequestHistory(PARAMETERS)
    history.add(100.0, at(-5), [hypothesis(0, 20)])
    assert history.at(103.0, at(0)).support(hypothesis(0, 5)) == pytest.approx(5)
    assert history.at(109.9, at(0)).past
    assert not history.at(110.1, at(0)).past


def test_requests_add_up_to_a_number_that_is_bounded() -> None:
    history = RequestHistory(PARAMETERS)
    for number in range(100):
        history.add(100.0 + number / 1e3, at(5 * number), [hypothesis(0, 20)])
    now = history.at(100.1, at(500))
    assert len(now.past) == len(now.independent) == 4


def test_a_standing_robot_gains_no_evidence() -> None:
    history = RequestHistory(PARAMETERS)
    history.add(99.7, at(0), [hypothesis(0, 20)])
    now = history.at(100.0, at(2.9))
    assert now.support(hypothesis(0, 5)) == 0
    assert len(now.guesses(np.zeros(3))) == 1  # but knows where to look
    # Nor does it learn by having stood elsewhere for long.
    for tenth in range(3):
        history.add(99.8 + tenth / 10, at(tenth), [hypothesis(0, 20)])
    assert history.at(100.0, at(5)).support(hypothesis(0, 5)) == pytest.approx(10)


def test_request_without_a_place_is_no_evidence() -> None:
    history = RequestHistory(PARAMETERS)
    history.add(100.0, middle_of(np.full((2, 3), np.nan)), [hypothesis(0, 20)])
    assert history.at(100.0, at(0)).support(hypothesis(0, 5)) == 0
    history.add(100.0, at(5), [hypothesis(0, 20)])
    assert history.at(100.0, np.full(3, np.nan)).support(hypothesis(0, 5)) == 0


def test_the_middle_by_hand() -> None:
    centroids = np.array([[1.0, 2, 3], [3, 4, 5], [np.nan, 0, 0], [0, np.inf, 0]])
    assert middle_of(centroids).tolist() == [2, 3, 4]


def test_guesses_are_the_best_places_of_the_past_the_latest_first() -> None:
    history = RequestHistory(PARAMETERS)
    history.add(100.0, at(0), [hypothesis(0, 20), hypothesis(50, 8)])
    history.add(101.0, at(0), [])
    history.add(102.0, at(0), [hypothesis(7, 9)])
    history.add(102.5, at(0), [hypothesis(8, 9)])
    guesses = history.at(103.0, at(0)).guesses(np.zeros(3))
    assert [pose.translation[0] for pose in guesses] == [8, 0]  # 7 m is the place of 8 m


def test_earlier_requests_decide_between_two_places() -> None:
    """The robot saw which of two similar streets it entered."""
    made = look_alikes(2, 60.0)
    assert localize(made.candidates).reason == "ambiguous"
    history = RequestHistory(LocalizationParameters())
    second = Pose.of_yaw(0.0, np.array([60.0, 0, 0]))
    there = hypothesis(60.0, 100.0)
    assert there.pose.difference(second, np.zeros(3)) == (0, 0)
    driven(history, 50.0, 50.4, there)
    found = localize(made.candidates, evidence=history.at(50.5, at(0)))
    assert found.pose is not None
    assert found.pose.translation == pytest.approx([60, 0, 0], abs=0.3)


def test_earlier_requests_alone_give_no_place() -> None:
    """The current segments do not fit the earlier place."""
    history = RequestHistory(LocalizationParameters())
    history.add(50.0, at(-5), [hypothesis(1e4, 1000.0)])
    made = scene(1)
    found = localize(made.candidates, evidence=history.at(50.1, at(0)))
    assert found.pose is not None
    meters, _ = found.pose.difference(made.pose, np.zeros(3))
    assert meters < 0.5
    noise = scene(2, found=0.0)
    assert localize(noise.candidates, evidence=history.at(50.1, at(0))).pose is None


def test_place_of_an_earlier_request_is_checked_again() -> None:
    """Few inliers suffice at the expected place."""
    made = scene(3, segments=60, found=0.12, k=25)
    history = RequestHistory(LocalizationParameters())
    source = made.candidates.centroids[:4]
    before = Hypothesis(made.pose, np.eye(4), 60.0, np.arange(4), np.arange(4), source, np.zeros(4))
    driven(history, 50.0, 50.4, before)
    found = localize(made.candidates, evidence=history.at(50.5, at(0)))
    assert found.best is not None
    meters, _ = found.best.pose.difference(made.pose, source.mean(axis=0))
    assert meters < 0.5
