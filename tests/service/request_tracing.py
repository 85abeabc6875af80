"""Record which files a request passes on its way from a route to FAISS or to SQLite.

A request *passes* a file if a function of it is called on the way and hands the work on to another
file. Not counted are the helpers of the two core packages (timing, cancellation, costs, keys), and
properties and special methods, which only read a value. So a file that does its part alone, such as
the voxels of a segment, is called, but not passed.
"""

import importlib
import inspect
import opcode
import sqlite3
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import faiss
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import cloud, map_of, random_codes, request_of

ROOT = Path(__file__).resolve().parents[2]

RESUME = opcode.opmap["RESUME"]

AFTER_AWAIT = 3
"""Mask of the operand of RESUME: 0 at the start of a function, else after a yield or an await."""

CORE = ("service/core/", "placecell/core/")


@dataclass
class Trace:
    """Calls between a start function and the end.

    Attributes:
        start: file and name of the function at whose call the recording begins.
        files: files of which a function was called, in the order of their first calls.
        passed: files that a request passes, in the order in which they first handed work on; with
            the file that called the end.
        is_on: whether calls are recorded now.
        has_ended: whether the recording is over.
    """

    start: tuple[str, str]
    files: list[str] = field(default_factory=list)
    passed: list[str] = field(default_factory=list)
    is_on: bool = False
    has_ended: bool = False

    def stop(self) -> None:
        """End the recording: the caller is the end of the way."""
        if self.is_on:
            frame = inspect.currentframe()
            assert frame is not None
            caller = _caller_of(frame, skip=Path(__file__).name)
            if caller is not None:
                self._pass(file_of(caller.f_code))
            self.has_ended, self.is_on = True, False

    def note(self, frame: FrameType, event: str, _: Any) -> None:
        """Record a call; this is a profile function."""
        if event != "call":
            return
        name = file_of(frame.f_code)
        if name is None:
            return
        is_start = (name, frame.f_code.co_name) == self.start and not self.has_ended
        if is_start:
            self.is_on = True
        if not self.is_on or _is_resumed(frame):
            return
        if name not in self.files:
            self.files.append(name)
        caller = None if is_start else _caller_of(frame)
        if caller is None or reads_value(frame.f_code) or reads_value(caller.f_code):
            return
        before = file_of(caller.f_code)
        if before != name and not name.startswith(CORE):
            self._pass(before)

    def _pass(self, name: str | None) -> None:
        if name is not None and name not in self.passed and not name.startswith(CORE):
            self.passed.append(name)


def _is_resumed(frame: FrameType) -> bool:
    """Return whether a coroutine or generator goes on, such as those of the middleware."""
    code, at = frame.f_code.co_code, frame.f_lasti
    return code[at] == RESUME and bool(code[at + 1] & AFTER_AWAIT)


def _caller_of(frame: FrameType, skip: str = "") -> FrameType | None:
    """Return the frame of the nearest caller that is ours."""
    above = frame.f_back
    while above is not None and (
        file_of(above.f_code) is None or (skip and above.f_code.co_filename.endswith(skip))
    ):
        above = above.f_back
    return above


@cache
def file_of(code: CodeType) -> str | None:
    """Return the file of a function of ours; None for a function of a library or a test."""
    if not code.co_filename.startswith(f"{ROOT}/"):
        return None
    name = code.co_filename.removeprefix(f"{ROOT}/").removeprefix("client/")
    return name if name.split("/")[0] in {"service", "placecell", "placecell_client"} else None


@cache
def reads_value(code: CodeType) -> bool:
    """Return whether a function is a property or a special method."""
    if code.co_name.startswith("__"):
        return True
    owner, _, name = code.co_qualname.rpartition(".")
    file = file_of(code)
    if not owner or "<" in owner or file is None:
        return False
    found: Any = importlib.import_module(file.removesuffix(".py").replace("/", "."))
    for part in owner.split("."):
        found = getattr(found, part)
    return isinstance(inspect.getattr_static(found, name, None), property | cached_property)


@contextmanager
def traced(start: tuple[str, str]) -> Iterator[Trace]:
    """Record the calls of all threads that begin in the block.

    Args:
        start: file and name of the function at whose call the recording begins.
    """
    trace = Trace(start)
    threading.setprofile(trace.note)
    sys.setprofile(trace.note)
    try:
        yield trace
    finally:
        sys.setprofile(None)
        threading.setprofile(None)


def ended_by(trace: Trace, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function with a trace that ends at its first call."""

    def stopping(*args: Any, **kwargs: Any) -> Any:
        trace.stop()
        return function(*args, **kwargs)

    return stopping


def end_at_commit(trace: Trace, monkeypatch: pytest.MonkeyPatch) -> None:
    """End a trace at the commit of a transaction of SQLite."""

    class Connection(sqlite3.Connection):
        def execute(self, sql: str, *parameters: Any) -> sqlite3.Cursor:
            if sql == "COMMIT":
                trace.stop()
            return super().execute(sql, *parameters)

    connect = partial(sqlite3.connect, factory=Connection)
    monkeypatch.setattr("service.maps.sqlite.database.sqlite3.connect", connect)


def trace_of_search(
    start: Callable[..., Any], models_dir: Path, monkeypatch: pytest.MonkeyPatch, path: str
) -> Trace:
    """Search a stored map for some segments; return the way from the route to FAISS.

    Args:
        start: starts a service.
        models_dir: folder of the models, among them `onnx`.
        monkeypatch: restores FAISS after the test.
        path: `match` or `localize`.
    """
    manifest = Manifest.load(models_dir / "onnx")
    with traced((f"service/api/routes/{path}.py", path)) as trace:
        monkeypatch.setattr(faiss.IndexFlat, "search", ended_by(trace, faiss.IndexFlat.search))
        with start(model="onnx") as service:
            codes = random_codes(50, dimension=manifest.code_bytes)
            yard = encode(map_of(codes, manifest.model_id))
            assert service.put("/maps/yard", content=yard).status_code == 201
            request = request_of([cloud(seed) for seed in range(8)])
            assert service.post(f"/{path}", json=request).status_code == 200
    return trace
