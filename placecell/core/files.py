"""Files: their order by name, writing one as a whole or not at all, and locks."""

import errno
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # a system without it cannot lock
    fcntl = None  # type: ignore[assignment]


def natural_key(file: Path) -> tuple[tuple[str | int, ...], str]:
    """Return a key that sorts names by their numbers: 10 after 9.

    The suffix decides only between names that are else equal.
    """
    parts = re.split(r"(\d+)", file.stem)
    parts[::2] = [part.lower() for part in parts[::2]]
    numbered = (int(part) if at % 2 else part for at, part in enumerate(parts))
    return tuple(numbered), file.suffix


@contextmanager
def written_whole(file: Path) -> Iterator[Path]:
    """Yield a path to write to; it becomes the file if the block ends without an error.

    Readers see the old file or the whole new one. The folder of the file is created.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f"{file.name}.{os.getpid()}.unfinished")
    try:
        yield unfinished
        unfinished.replace(file)
    finally:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)


def lock_at_once(descriptor: int) -> None:
    """Lock an open file or folder until it is closed, or the process ends; do not wait.

    A system without such locks locks nothing.

    Raises:
        BlockingIOError: Another process has the lock.
        OSError: The file system cannot lock, as some of networks.
    """
    if fcntl is None:
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in {errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES}:
            raise BlockingIOError(error.errno, error.strerror) from error
        raise
