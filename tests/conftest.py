"""Markers that tests get by rule, the order of the test files, and the setup of workers.

A test that starts a process is `integration`. `starts_process` finds most of these tests. A test
whose start it cannot see names the marker itself; `pytest_runtest_teardown` fails it otherwise.
"""

import gc
import inspect
import os
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType

import pytest
import typer.main
import typer.testing
from hypothesis import settings

from tests.service.postgres_server import ON_POSTGRES, postgres_database, postgres_server
from tests.tracing import settrace

__all__ = ["postgres_database", "postgres_server"]  # fixtures

SERVICE = Path(__file__).resolve().parent / "service"

settings.register_profile("fast", settings.get_profile("ci"), max_examples=20)

if "PYTEST_XDIST_WORKER" in os.environ:
    # The workers already use all cores. Libraries read these variables when they are imported.
    for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(_variable, "1")

STARTERS = {"subprocess", "multiprocessing", "running_service"}
"""A test starts a process if it, its fixtures or their helpers use one of these names."""

START_EVENTS = {"subprocess.Popen", "os.fork", "os.forkpty", "os.posix_spawn"}
"""Python's audit events for the start of a process."""

started: list[str] = []
"""Processes that the running test started."""


def note_start(event: str, arguments: tuple[object, ...]) -> None:
    """Note each process that is started; an audit hook."""
    if event in START_EVENTS:
        started.append(f"{event} {arguments!r:.200}")


sys.addaudithook(note_start)
sys.settrace = settrace


def names_in(code: CodeType) -> Iterator[str]:
    """Yield the global names and the attributes that a function uses, inner functions included."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from names_in(constant)


def starts_process(function: object, known: dict[object, bool]) -> bool:
    """Return whether a function, or a function of the tests that it calls, uses a starter.

    Args:
        function: of a test or a fixture.
        known: the answers so far, which this call extends.
    """
    function = inspect.unwrap(function) if callable(function) else function
    if not isinstance(function, FunctionType) or not function.__module__.startswith("tests."):
        return False
    if function not in known:
        known[function] = False  # ends a recursion
        names = {*names_in(function.__code__)}
        known[function] = bool(names & STARTERS) or any(
            starts_process(function.__globals__.get(name), known) for name in names
        )
    return known[function]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark tests that start processes, and move files with slow tests to the front.

    A worker takes whole files. A long file at the end would leave the other workers idle.
    """
    if ON_POSTGRES:
        for item in items:
            if SERVICE in item.path.parents:
                item.add_marker(pytest.mark.integration)
                if item.get_closest_marker("sqlite"):
                    item.add_marker(pytest.mark.skip("is about the files of SQLite"))
    known = dict[object, bool]()
    for item in items:
        assert isinstance(item, pytest.Function)
        fixtures = [one for each in item._fixtureinfo.name2fixturedefs.values() for one in each]
        if any(starts_process(each, known) for each in (item.obj, *(one.func for one in fixtures))):
            item.add_marker(pytest.mark.integration)
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: item.path not in slow)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Keep modules and items out of garbage collections, as `placecell serve` does.

    They live until the end, so a collection would visit all of them in vain.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()


@pytest.fixture(scope="session", autouse=True)
def commands_are_built_once() -> Iterator[None]:
    """Build the command line once a worker; `CliRunner` would build it in each call, for 40 ms."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(typer.testing, "_get_command", cache(typer.main.get_command))
        yield


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Iterator[None]:
    """Forget the processes of the test before."""
    started.clear()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    """Fail a test that started a process and is not marked for it."""
    result = yield
    if started and item.get_closest_marker("integration") is None:
        pytest.fail(f"The test starts a process. Mark it 'integration'. Started: {started[0]}")
    return result
