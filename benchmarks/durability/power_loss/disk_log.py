"""Log of all file operations of a process in a folder, read from strace."""

import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

StepKind = Literal["open", "write", "cut", "sync", "rename", "remove", "folder", "said"]

TRACED = (
    *("openat", "write", "pwrite64", "lseek", "ftruncate", "fsync", "fdatasync"),
    *("rename", "unlink", "mkdir", "sendto"),
)
ANSWERED = re.compile(rb"^x-request-id: ([\w.-]+)\r$", re.IGNORECASE | re.MULTILINE)
"""Header of an HTTP answer: id of the request."""

_PID = re.compile(r"(\d+) +(.*)", re.DOTALL)
_UNFINISHED = " <unfinished ...>"
_RESUMED = re.compile(r"<\.\.\. \w+ resumed>(.*)", re.DOTALL)
_CALL = re.compile(r"(\w+)\((.*)\) += (\d+)(?:<((?:\\x[0-9a-f]{2})+)>)?", re.DOTALL)
_DESCRIPTOR = re.compile(r"(\d+)(?:<((?:\\x[0-9a-f]{2})*)>)?")
_TEXT = re.compile(r'"((?:\\x[0-9a-f]{2})*)"')


@dataclass(frozen=True, slots=True)
class Step:
    """One operation on a file, or one HTTP answer (`said`).

    Attributes:
        kind: kind of the operation; `cut` is a truncation.
        begun, ended: line numbers in the log. A step that ended before another began is earlier.
        path: path of the file.
        to: new path of a `rename`; id of the request of a `said`.
        offset: offset of a `write`; new size of a `cut`.
        data: content of a `write`.
    """

    kind: StepKind
    begun: int
    ended: int
    path: str
    to: str = ""
    offset: int = 0
    data: bytes = b""


def tracer(log: Path) -> tuple[str, ...]:
    """Return the command prefix with which strace writes the log of a command.

    Raises:
        FileNotFoundError: strace is not installed.
    """
    program = shutil.which("strace")
    if program is None:
        raise FileNotFoundError("strace is not installed. Install the package 'strace'.")
    # -D keeps the command a child of the caller; -xx escapes all characters.
    options = ("-f", "-D", "-y", "-xx", "-s", str(1 << 26), "--seccomp-bpf")
    return (program, *options, "-e", f"trace={','.join(TRACED)}", "-o", str(log))


def steps_of(logs: Iterable[Path], folder: Path) -> list[Step]:
    """Return the steps in a folder and the HTTP answers, in the order of their begin.

    Args:
        logs: logs of successive processes.
        folder: the folder; steps in its subfolders count too.
    """
    found: list[Step] = []
    first = 0
    for log in logs:
        reader = _Reader(f"{folder.resolve()}/")
        with log.open(errors="replace") as lines:
            for begun, ended, text in _calls(lines):
                found += reader.steps(first + begun, first + ended, text)
        first = max((step.ended + 1 for step in found), default=first)
    return sorted(found, key=lambda step: step.begun)


def _calls(lines: Iterable[str]) -> Iterator[tuple[int, int, str]]:
    """Yield each call that returned: the lines of its begin and end, and its text."""
    begun: dict[str, tuple[int, str]] = {}
    for number, line in enumerate(lines):
        match = _PID.match(line.rstrip("\n"))
        if match is None:
            continue
        pid, text = match.groups()
        if text.endswith(_UNFINISHED):
            begun[pid] = number, text.removesuffix(_UNFINISHED)
        elif resumed := _RESUMED.match(text):
            first, start = begun.pop(pid)
            yield first, number, start + resumed[1]
        else:
            yield number, number, text


class _Reader:
    """Reader of calls; keeps the write position of each open file."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._places: dict[int, int] = {}

    def steps(self, begun: int, ended: int, text: str) -> Iterator[Step]:
        match = _CALL.match(text)
        if match is None:  # a call that failed, or another line
            return
        name, arguments, result = match[1], match[2], int(match[3])
        if name == "openat":
            self._places[result] = 0
            path = _bytes(match[4] or "").decode()
            if self._concerns(path) and "O_CREAT" in arguments:
                yield Step("open", begun, ended, path)
            if self._concerns(path) and "O_TRUNC" in arguments:
                yield Step("cut", begun, ended, path)
        elif name in {"rename", "unlink", "mkdir"}:
            yield from self._named(name, begun, ended, arguments)
        else:
            yield from self._written(name, begun, ended, arguments, result)

    def _named(self, name: str, begun: int, ended: int, arguments: str) -> Iterator[Step]:
        paths = [_bytes(text).decode() for text in _TEXT.findall(arguments)]
        if not self._concerns(paths[0]):
            return
        if name == "rename":
            yield Step("rename", begun, ended, paths[0], paths[1])
        else:
            yield Step("remove" if name == "unlink" else "folder", begun, ended, paths[0])

    def _written(
        self, name: str, begun: int, ended: int, arguments: str, result: int
    ) -> Iterator[Step]:
        opened = _DESCRIPTOR.match(arguments)
        assert opened is not None, arguments[:200]
        descriptor, path = int(opened[1]), _bytes(opened[2] or "").decode(errors="replace")
        place = self._places.get(descriptor, 0)
        if name == "lseek":
            self._places[descriptor] = result
        elif name == "write":
            self._places[descriptor] = place + result
        if name in {"write", "sendto"}:
            answer = ANSWERED.search(_data(arguments)) if not path.startswith("/") else None
            if answer:
                yield Step("said", begun, ended, path, answer[1].decode())
        if not self._concerns(path):
            return
        numbers = arguments.rsplit(", ", 1)
        if name == "write":
            yield Step("write", begun, ended, path, offset=place, data=_data(arguments)[:result])
        elif name == "pwrite64":
            data = _data(arguments)[:result]
            yield Step("write", begun, ended, path, offset=int(numbers[1]), data=data)
        elif name == "ftruncate":
            yield Step("cut", begun, ended, path, offset=int(numbers[1]))
        elif name in {"fsync", "fdatasync"}:
            yield Step("sync", begun, ended, path)

    def _concerns(self, path: str) -> bool:
        return f"{path}/".startswith(self._folder)


def _data(arguments: str) -> bytes:
    match = _TEXT.search(arguments)
    return _bytes(match[1]) if match else b""


def _bytes(text: str) -> bytes:
    r"""Return the bytes of an escaped text such as `\x41\x42`."""
    return bytes.fromhex(text.replace("\\x", ""))
