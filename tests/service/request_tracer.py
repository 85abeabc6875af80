"""Request tracer: finds the files of this repository that a request passes on its way to a target.

Start it before the service, because it profiles only threads that start later.
"""

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

ROOT = Path(__file__).parents[2]
PACKAGES = ("service", "placecell", "client")
HANDOFF = "service/api/admission/fair_threads.py"
"""File whose `run` moves the work of a request from the event loop to a thread."""


class RequestTracer:
    """Files of the library, the client and the service between a route function and a target.

    Attributes:
        passed: files on the call stack whenever the target is called, from the route function on;
            the way that a reader follows from call to call.
        called: all files with a function that ran between the route function and the target.
    """

    def __init__(self, route: Callable[..., Any], is_target: Callable[[Any], bool]) -> None:
        """Create a tracer.

        Args:
            route: the route function; each of its calls begins a trace.
            is_target: decides whether a built-in function that is called is the target.
        """
        self.passed: set[str] = set()
        self.called: set[str] = set()
        self._route = route.__code__
        self._is_target = is_target
        self._files: dict[CodeType, str | None] = {}
        self._ran: set[str] | None = None
        self._before_handoff: set[str] = set()

    def profile(self, frame: FrameType, event: str, arg: Any) -> None:
        """Note an event of the interpreter; see `sys.setprofile`."""
        if event == "call":
            file = self._file(frame.f_code)
            if file is None or threading.current_thread().name == "maintenance":
                return
            if frame.f_code is self._route and self._ran is None:
                self._ran = set()
            if self._ran is not None:
                self._ran.add(file)
                if file == HANDOFF and frame.f_code.co_name == "run":
                    self._before_handoff = self._stack(frame)
        elif event == "c_call" and self._ran is not None and self._is_target(arg):
            if threading.current_thread().name != "maintenance":
                self.passed |= self._before_handoff | self._stack(frame)
                self.called |= self._ran
        elif event == "return" and frame.f_code is self._route and _is_done(frame, arg):
            self._ran = None

    def _stack(self, frame: FrameType | None) -> set[str]:
        """Return the files on the call stack, up to the route function."""
        files = set()
        while frame is not None:
            if file := self._file(frame.f_code):
                files.add(file)
            if frame.f_code is self._route:
                break
            frame = frame.f_back
        return files

    def _file(self, code: CodeType) -> str | None:
        """Return the file of a function, relative to the repository; None if it is elsewhere."""
        if code not in self._files:
            path = Path(code.co_filename)
            is_own = path.is_absolute() and path.is_relative_to(ROOT)
            name = path.relative_to(ROOT).as_posix() if is_own else ""
            self._files[code] = name if name.partition("/")[0] in PACKAGES else None
        return self._files[code]


def _is_done(frame: FrameType, result: Any) -> bool:
    """Return whether a coroutine function returned; it also yields whenever it waits."""
    return result is not None and not hasattr(result, "_asyncio_future_blocking")


@contextmanager
def tracing(tracer: RequestTracer) -> Iterator[None]:
    """Profile this thread, and threads that start in the block."""
    threading.setprofile(tracer.profile)
    sys.setprofile(tracer.profile)
    try:
        yield
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
