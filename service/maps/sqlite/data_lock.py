"""Lock of a data directory: one service owns it, even if the lock file is removed."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import filelock

from placecell.core.files import lock_at_once
from service.maps.store import StoreLockedError

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True)
class DataLock:
    """Lock on the file `DATA_DIR/lock` and on the directory itself.

    If the locked file is removed, another process can create and lock a new one. The lock on the
    directory itself still excludes other services.

    Attributes:
        file: path of the lock file.
        inode: device and inode of the lock file.
    """

    file: Path
    inode: tuple[int, int]

    def trouble(self) -> str | None:
        """Return what is wrong with the lock; None if nothing is."""
        try:
            found = _inode_of(self.file)
        except OSError:
            found = None
        if found == self.inode:
            return None
        return (
            f"The file {self.file.name} in the data directory was removed or replaced while the "
            "service ran, so another service may use the directory. Restart this service."
        )


@contextmanager
def locked(data_dir: Path) -> Iterator[DataLock]:
    """Hold the locks of a data directory until the context ends.

    Raises:
        StoreLockedError: another process holds one of them.
        OSError: the lock file cannot be created.
    """
    in_use = f"{data_dir} is in use by another service. Stop it, or use another data directory"
    folder = os.open(data_dir, os.O_RDONLY | os.O_CLOEXEC)
    try:
        try:
            lock_at_once(folder)
        except BlockingIOError as error:
            raise StoreLockedError(in_use) from error
        except OSError as error:
            # Some network file systems cannot lock directories.
            logger.info("the directory %s cannot be locked: %s", data_dir, error)
        try:
            lock = filelock.FileLock(data_dir / "lock").acquire(timeout=0)
        except filelock.Timeout as error:
            raise StoreLockedError(in_use) from error
        with lock:
            yield DataLock(data_dir / "lock", _inode_of(data_dir / "lock"))
    finally:
        os.close(folder)


def _inode_of(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_dev, status.st_ino
