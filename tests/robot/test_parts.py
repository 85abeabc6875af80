"""Small parts of the agent: worker, back-off, keyframes, scan jumps, state."""

import threading

import numpy as np
import pytest

from robot.core.backoff import Backoff
from robot.core.settings import AgentSettings
from robot.core.worker import InlineWorker, Worker
from robot.localization.scan_jump import ScanAgreement, object_columns
from robot.localization.state import LocalizationState
from robot.mapping.keyframes import Keyframes
from tests.robot.agent_fakes import FakeClock, Street, at


def test_worker_makes_one_call_at_a_time() -> None:
    worker = Worker[int]("test")
    gate = threading.Event()
    assert worker.submit(lambda: int(gate.wait(5)))
    assert not worker.submit(lambda: 2)
    assert worker.take() is None
    gate.set()
    assert worker.wait(5)
    assert worker.take() == 1
    assert worker.take() is None
    worker.close()


@pytest.mark.parametrize("kind", [Worker, InlineWorker])
def test_error_of_a_call_is_raised_when_it_is_taken(kind: type[Worker[int]]) -> None:
    worker = kind("test")
    worker.submit(lambda: 1 // 0)
    assert worker.wait(5)
    with pytest.raises(ZeroDivisionError):
        worker.take()
    assert worker.submit(lambda: 3)
    assert worker.wait(5)
    assert worker.take() == 3
    worker.close()


def test_backoff_doubles_and_adds_the_wait_of_the_service() -> None:
    clock = FakeClock()
    backoff = Backoff(clock, first=1.0, longest=4.0, jitter=lambda: 1.0)
    waits = []
    for _ in range(4):
        backoff.failed()
        waits.append(backoff.remaining)
    assert waits == [1.0, 2.0, 4.0, 4.0]
    backoff.failed(retry_after=30.0)
    assert backoff.remaining == 34.0
    assert not backoff.is_over
    clock.now += 34.0
    assert backoff.is_over
    backoff.succeeded()
    assert backoff.is_over


def test_keyframes_follow_the_distance_not_the_noise() -> None:
    rule = Keyframes(2.0, 3)
    assert [rule.add(at(0)) for _ in range(4)] == [False, False, True, False]
    rng = np.random.default_rng(0)
    assert not any(rule.add(at(*rng.normal(0, 0.1, 2))) for _ in range(100))
    assert rule.add(at(2.1))
    rule.expect()
    assert rule.add(at(2.2))
    rule.reset(at(49.0))
    assert not rule.add(at(50))


def test_fast_robot_makes_a_keyframe_before_its_local_map_is_complete() -> None:
    rule = Keyframes(2.0, 5)
    found = [(rule.add(at(x)), rule.is_complete) for x in (0.0, 1.0, 2.0, 3.0, 4.0)]
    assert found == [(False, False), (False, False), (True, False), (False, False), (True, True)]
    rule.reset(at(100.0))
    assert not rule.is_complete
    assert rule.add(at(102.0))
    assert not rule.is_complete
    found = [(rule.add(at(x)), rule.is_complete) for x in (103.0, 104.0, 105.0)]
    assert found == [(False, False), (True, False), (False, True)]


@pytest.mark.parametrize(
    ("apart", "every"), [(0.1, 20), (0.3, 7), (0.9, 2), (1.5, 1), (1.99, 1), (2.01, 1), (5.0, 1)]
)
def test_keyframe_is_the_scan_nearest_to_its_distance(apart: float, every: int) -> None:
    rule = Keyframes(2.0, 1)
    chosen = [number for number in range(100) if rule.add(at(apart * number))]
    assert set(np.diff(chosen)) == {every}


def test_scans_of_one_drive_fit_and_those_of_another_place_do_not() -> None:
    street, agreement = Street(1), ScanAgreement()
    for place in range(12):
        columns = object_columns(street.scan(at(place)), at(place))
        fit = agreement.examine(columns)
        assert fit.fits
        agreement.accept(columns, fit)
    elsewhere = object_columns(street.scan(at(120)), at(12))
    assert not agreement.examine(elsewhere).fits
    # The odometry jumps, but the robot does not: the same scan at another pose.
    assert not agreement.examine(object_columns(street.scan(at(12)), at(32, 20))).fits
    agreement.reset()
    assert agreement.examine(elsewhere).fits


def test_empty_scan_says_nothing() -> None:
    agreement = ScanAgreement()
    columns = object_columns(np.zeros((0, 3), np.float32), at(0))
    assert agreement.examine(columns).fits


@pytest.mark.parametrize("name", ["map", "robot", "session"])
def test_empty_names_are_refused(name: str) -> None:
    with pytest.raises(ValueError, match=name):
        AgentSettings(**({"map": "yard"} | {name: ""}))  # type: ignore[arg-type]


def test_distances_that_are_not_positive_are_refused() -> None:
    with pytest.raises(ValueError, match="keyframe_meters"):
        AgentSettings("yard", keyframe_meters=0)
    with pytest.raises(ValueError, match=r"Invalid class 'cars'\. Expected building"):
        AgentSettings("yard", ignore=("cars",))


def test_robot_that_maps_ignores_fixes() -> None:
    state = LocalizationState()
    state.started(localizes=False)
    state.fixed("first")
    state.missed("nothing", True, True)
    state.carried_away()
    state.map_replaced("yard")
    assert state.state.value == "mapping"
