"""Tests of the replicas that benchmarks start."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.replicas.replica_group import may_set_niceness, set_niceness

PROGRAM = """
import threading
threads = [threading.Thread(target=threading.Event().wait, daemon=True) for _ in range(3)]
for each in threads:
    each.start()
print("ready", flush=True)
threads[0].join()
"""


@pytest.mark.skipif(not may_set_niceness(), reason="only root may lower a niceness again")
def test_niceness_of_all_threads_is_set_and_reset() -> None:
    program = [sys.executable, "-c", PROGRAM]
    with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        threads = [int(each.name) for each in Path(f"/proc/{process.pid}/task").glob("*")]
        assert len(threads) == 4
        for niceness in (15, 0):
            set_niceness(process.pid, niceness)
            found = {os.getpriority(os.PRIO_PROCESS, each) for each in threads}
            assert found == {niceness}
        process.kill()


def test_niceness_of_an_ended_process_is_not_set() -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    set_niceness(process.pid, 15)
