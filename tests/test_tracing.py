"""Tests of the trace functions of threads."""

import subprocess
import sys

import pytest

PROGRAM = """
import sys, threading, time
from tests.tracing import settrace, settrace_of_python

is_inside = threading.Event()
is_over = threading.Event()

def hold(event, arguments):
    if event == "sys.settrace" and threading.current_thread().name == "first":
        is_inside.set()
        is_over.wait(20)  # the other thread runs, and is refused

sys.addaudithook(hold)
first = threading.Thread(target=settrace_of_python, args=(None,), name="first")
first.start()
assert is_inside.wait(20)
try:
    {install}(None)
finally:
    is_over.set()
    first.join()
print("installed")
"""


def installed_by(install: str) -> str:
    """Return what a program prints that installs a trace function while another thread does."""
    program = [sys.executable, "-c", PROGRAM.format(install=install)]
    done = subprocess.run(program, capture_output=True, text=True, timeout=60, check=False)
    return done.stdout + done.stderr


def test_a_trace_function_is_installed_while_another_thread_installs_one() -> None:
    assert installed_by("settrace") == "installed\n"


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="Python 3.12 installs it by itself")
def test_python_itself_refuses_the_second_thread() -> None:
    assert "while another trace function" in installed_by("settrace_of_python")
