import threading

import numpy as np
import pytest

from segments.localisation import Hypothesis, LocalisationParameters, Pose
from service.sessions import SessionKey, Sessions


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def key(
    robot: str = "ann", holder: str = "anyone", map_: str = "yard", since: int = 1
) -> SessionKey:
    return SessionKey(holder, robot, map_, since)


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
    return Sessions(3, LocalisationParameters(memory=10.0), clock)


def test_what_was_found_is_evidence(sessions: Sessions) -> None:
    assert sessions.evidence(key(), b"now") is None
    sessions.remember(key(), [hypothesis()], b"before")
    evidence = sessions.evidence(key(), b"now")
    assert evidence is not None
    assert evidence.support(hypothesis()) > 0


def test_a_request_that_is_sent_again_counts_once(sessions: Sessions, clock: Clock) -> None:
    def support(digest: bytes) -> float:
        evidence = sessions.evidence(key(), digest)
        assert evidence is not None
        return evidence.support(hypothesis())

    sessions.remember(key(), [hypothesis()], b"one")
    once = support(b"two")
    assert support(b"one") == 0
    sessions.remember(key(), [hypothesis()], b"one")
    assert support(b"two") == once > 0
    sessions.remember(key(), [hypothesis()], b"two")
    assert support(b"three") == 2 * once


@pytest.mark.parametrize(
    "other", [key("bob"), key(holder="another key"), key(map_="hall"), key(since=2)]
)
def test_nobody_else_has_it(sessions: Sessions, other: SessionKey) -> None:
    sessions.remember(key(), [hypothesis()], b"before")
    assert sessions.evidence(other, b"now") is None


def test_it_is_forgotten_in_time(sessions: Sessions, clock: Clock) -> None:
    sessions.remember(key(), [hypothesis()], b"before")
    clock.now += 10.1
    evidence = sessions.evidence(key(), b"now")
    assert evidence is not None
    assert evidence.support(hypothesis()) == 0
    # And with the next request of anyone it is gone.
    sessions.remember(key("bob"), [], b"before")
    assert len(sessions) == 1


def test_of_too_many_the_one_silent_longest_goes(sessions: Sessions, clock: Clock) -> None:
    for name in ("a", "b", "c"):
        sessions.remember(key(name), [hypothesis()], b"before")
        clock.now += 1
    sessions.remember(key("a"), [hypothesis()], b"before")
    sessions.remember(key("d"), [hypothesis()], b"before")
    assert len(sessions) == 3
    assert sessions.evidence(key("b"), b"now") is None
    assert sessions.evidence(key("a"), b"now") is not None


def test_a_session_keeps_so_many_requests(sessions: Sessions, clock: Clock) -> None:
    for number in range(1_000):
        clock.now += 0.001
        sessions.remember(key(), [hypothesis()] * 3, f"{number}".encode())
    evidence = sessions.evidence(key(), b"now")
    assert evidence is not None
    assert len(evidence.past) == LocalisationParameters().remembered


def test_many_threads_at_once() -> None:
    sessions = Sessions(50)
    failures: list[BaseException] = []

    def work(number: int) -> None:
        try:
            for step in range(300):
                mine = key(f"robot-{(number + step) % 80}")
                sessions.remember(mine, [hypothesis()], b"before")
                sessions.evidence(mine, b"now")
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
