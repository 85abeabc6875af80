"""Lock of a state folder: one agent uses it at a time."""

import errno
from pathlib import Path
from typing import TextIO

try:
    import fcntl
except ImportError:  # a system without it has no lock
    fcntl = None  # type: ignore[assignment]

FILE = "agent.lock"
"""Name of the locked file in the state folder."""


def lock_state(folder: Path) -> TextIO | None:
    """Lock a state folder until the returned file is closed, or the process ends.

    Args:
        folder: state folder; it exists.

    Returns:
        The locked file; None if the file system cannot lock.

    Raises:
        OSError: another agent uses the folder, or the lock's file cannot be created.
    """
    if fcntl is None:
        return None
    file = (folder / FILE).open("a", encoding="utf-8")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        if error.errno in {errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES}:
            raise OSError(
                f"{folder} is in use by another agent. Stop it, or give each robot a state folder "
                "of its own"
            ) from error
        return None  # Some network file systems cannot lock.
    return file
