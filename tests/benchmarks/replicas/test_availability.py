"""Tests of the times without an answer, by hand."""

from benchmarks.replicas.availability import AnswerTimes, Fault, FaultLog, cause_of, longest_gaps

FAULTS = (Fault("replica", 10.0), Fault("primary", 20.0), Fault("replica", 30.0))


def test_a_gap_belongs_to_the_fault_that_began_in_it() -> None:
    assert cause_of(9.0, 11.0, FAULTS) == "replica"
    assert cause_of(19.5, 22.0, FAULTS) == "primary"


def test_a_gap_without_a_fault_belongs_to_the_fault_before() -> None:
    assert cause_of(12.0, 13.0, FAULTS) == "replica"
    assert cause_of(25.0, 26.0, FAULTS) == "primary"
    assert cause_of(1.0, 2.0, FAULTS) == "none"


def test_longest_gap_of_any_client_counts() -> None:
    quick = AnswerTimes("read", [9.9, 10.1, 19.9, 20.0, 20.5, 29.9, 30.1])
    slow = AnswerTimes("write", [9.8, 10.9, 19.95, 22.5, 29.9, 30.2])
    found = longest_gaps([quick, slow], FAULTS)
    # After the first kill: 10.1 to 19.9, and 10.9 to 19.95; after the crash: 20.5 to 29.9.
    assert found == {"replica": 9.8, "primary": 9.4}


def test_short_gaps_of_every_cause_are_told() -> None:
    found = longest_gaps([AnswerTimes("read", [10.0, 10.5, 20.0, 20.25])], FAULTS)
    assert set(found) == {"replica", "primary"}


def test_counts_of_faults_are_by_cause() -> None:
    log = FaultLog()
    for fault in FAULTS:
        log.add(fault.cause, fault.start)
    assert log.counts() == {"replica": 2, "primary": 1}
