import threading

import numpy as np
import pytest

from placecell.localization import Hypothesis, LocalizationParameters, Pose
from service.search.sessions import SessionKey, Sessions

BEFORE, NOW = np.zeros(3), np.array([5.0, 0.0, 0.0])
"""Middle of the segments that a robot saw before, and now that it has moved."""


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def key(
    robot: str = "ann", principal: str = "anyone", map_: str = "yard", since: int = 1
) -> SessionKey:
    return SessionKey(principal, robot, map_, since)


def hypothesis(score: float = 10.0) -> Hypothesis:
    source = np.array([[-10.0, 0, 0], [10, 0, 0], [0, 10, 0], [0, -10, 0]])
    numbers = np.arange(4)
    pose = Pose.of_yaw(0.0, np.zeros(3))
    return Hypothesis(pose, np.eye(4), score, numbers, numbers, source, np.zeros(4))


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def sessions(clock: Clock) -> Sessions:
    return Sessions(3, LocalizationParameters(memory=10.0), clock)


def test_earlier_request_is_evidence(sessions: Sessions) -> None:
    assert sessions.evidence(key(), NOW) is None
    sessions.remember(key(), BEFORE, [hypothesis()])
    evidence = sessions.evidence(key(), NOW)
    assert evidence is not None
    assert evidence.support(hypothesis()) > 0


def test_repeated_request_is_no_evidence(sessions: Sessions) -> None:
    for _ in range(10):
        sessions.remember(key(), BEFORE, [hypothesis()])
    evidence = sessions.evidence(key(), BEFORE)
    assert evidence is not None
    assert evidence.support(hypothesis()) == 0


@pytest.mark.parametrize(
    "other", [key("bob"), key(principal="another key"), key(map_="hall"), key(since=2)]
)
def test_other_session_key_has_no_evidence(sessions: Sessions, other: SessionKey) -> None:
    sessions.remember(key(), BEFORE, [hypothesis()])
    assert sessions.evidence(other, NOW) is None


def test_evidence_expires(sessions: Sessions, clock: Clock) -> None:
    sessions.remember(key(), BEFORE, [hypothesis()])
    clock.now += 10.1
    evidence = sessions.evidence(key(), NOW)
    assert evidence is not None
    assert evidence.support(hypothesis()) == 0
    # And with the next request of anyone it is gone.
    sessions.remember(key("bob"), BEFORE, [])
    assert len(sessions) == 1


def test_oldest_of_too_many_sessions_is_dropped(sessions: Sessions, clock: Clock) -> None:
    for name in ("a", "b", "c"):
        sessions.remember(key(name), BEFORE, [hypothesis()])
        clock.now += 1
    sessions.remember(key("a"), BEFORE, [hypothesis()])
    sessions.remember(key("d"), BEFORE, [hypothesis()])
    assert len(sessions) == 3
    assert sessions.evidence(key("b"), NOW) is None
    assert sessions.evidence(key("a"), NOW) is not None


def test_A25_key_with_many_sessions_displaces_only_its_own(clock: Clock) -> None:
    sessions = Sessions(6, LocalizationParameters(memory=10.0), clock)
    for name in ("a", "b"):
        sessions.remember(key(name, principal="quiet"), BEFORE, [hypothesis()])
    sessions.remember(key("c", principal="another"), BEFORE, [hypothesis()])
    for number in range(50):
        clock.now += 0.01
        sessions.remember(key(f"robot {number}", principal="greedy"), BEFORE, [hypothesis()])
    assert len(sessions) == 6
    for kept in (
        key("a", principal="quiet"),
        key("b", principal="quiet"),
        key("c", principal="another"),
    ):
        assert sessions.evidence(kept, NOW) is not None
    greedy = [key(f"robot {number}", principal="greedy") for number in range(50)]
    assert [each for each in greedy if sessions.evidence(each, NOW) is not None] == greedy[-3:]
    # A key that comes when all is taken gets its share.
    sessions.remember(key("d", principal="late"), BEFORE, [hypothesis()])
    assert sessions.evidence(key("d", principal="late"), NOW) is not None
    assert sessions.evidence(key("a", principal="quiet"), NOW) is not None
    assert len(sessions) == 6
    # All are dropped when their time is over, and nothing is left of their keys.
    clock.now += 11
    sessions.remember(key("e", principal="last"), BEFORE, [])
    assert len(sessions) == 1
    assert {*sessions._of_principal} == {"last"}


def test_session_keeps_a_limited_number_of_requests(sessions: Sessions, clock: Clock) -> None:
    for _ in range(1_000):
        clock.now += 0.001
        sessions.remember(key(), BEFORE, [hypothesis()] * 3)
    evidence = sessions.evidence(key(), NOW)
    assert evidence is not None
    assert len(evidence.past) == LocalizationParameters().remembered


def test_concurrent_threads_keep_the_limit() -> None:
    sessions = Sessions(50)
    failures: list[BaseException] = []

    def work(number: int) -> None:
        try:
            for step in range(300):
                mine = key(f"robot-{(number + step) % 80}")
                sessions.remember(mine, BEFORE, [hypothesis()])
                sessions.evidence(mine, NOW)
        except BaseException as error:
            failures.append(error)
            raise

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert len(sessions) == 50
