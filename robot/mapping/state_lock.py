"""Lock of a state folder: one agent uses it at a time."""

from pathlib import Path
from typing import TextIO

from placecell.core.files import lock_at_once

FILE = "agent.lock"
"""Name of the locked file in the state folder."""


def lock_state(folder: Path) -> TextIO:
    """Lock a state folder until the returned file is closed, or the process ends.

    A file system that cannot lock, as some of networks, locks nothing.

    Args:
        folder: state folder; it exists.

    Returns:
        The locked file.

    Raises:
        OSError: another agent uses the folder, or the lock's file cannot be created.
    """
    file = (folder / FILE).open("a", encoding="utf-8")
    try:
        lock_at_once(file.fileno())
    except BlockingIOError as error:
        file.close()
        raise OSError(
            f"{folder} is in use by another agent. Stop it, or give each robot a state folder of "
            "its own"
        ) from error
    except OSError:
        pass  # Some network file systems cannot lock.
    return file
