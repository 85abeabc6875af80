"""Disk space that is kept for deletions, so that a full disk can be freed."""

import errno
import os
from pathlib import Path

RESERVE_BYTES = 8 << 20
"""Kept on disks that are large enough."""

DISK_SHARE = 16
"""A small disk keeps one part in so many."""

FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


class DiskReserve:
    """A file, `DATA_DIR/reserve`, that is cut while something is deleted from a full disk.

    Attributes:
        size: bytes that are kept.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / "reserve"
        disk = os.statvfs(folder)
        self.size = min(RESERVE_BYTES, disk.f_blocks * disk.f_frsize // DISK_SHARE)

    def is_held(self) -> bool:
        """Whether all of it is on the disk."""
        try:
            return self._path.stat().st_size >= self.size
        except OSError:
            return False

    def hold(self) -> bool:
        """Take the space, unless it is held; whether it is now."""
        if self.is_held():
            return True
        try:
            descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError:
            return False
        try:
            _allocate(descriptor, self.size)
        except OSError:
            # Half of a reserve would look like all of it.
            os.ftruncate(descriptor, 0)
            return False
        finally:
            os.close(descriptor)
        return True

    def release(self, bytes_left: int = 0) -> None:
        """Give the space back to the disk, all but so many bytes."""
        try:
            if self._path.stat().st_size > bytes_left:
                os.truncate(self._path, bytes_left)
        except OSError:
            return

    def free_bytes(self) -> int:
        """How much the disk has free for this process."""
        disk = os.statvfs(self._path.parent)
        return disk.f_bavail * disk.f_frsize


def _allocate(descriptor: int, size: int) -> None:
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(descriptor, 0, size)
        return
    os.pwrite(descriptor, bytes(size), 0)  # a system that has no such call
