"""Disk reserve: space kept for deletions, so that a full disk can be freed."""

import errno
import os
from pathlib import Path

RESERVE_BYTES = 8 << 20
"""Size of the reserve on disks that are large enough, bytes."""

DISK_SHARE = 16
"""Divisor of a small disk's size that gives its reserve."""

FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


class DiskReserve:
    """Reserve file `DATA_DIR/reserve`, which is cut while a full disk is being freed.

    Attributes:
        size: bytes that are kept.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / "reserve"
        disk = os.statvfs(folder)
        self.size = min(RESERVE_BYTES, disk.f_blocks * disk.f_frsize // DISK_SHARE)

    def is_held(self) -> bool:
        """Return whether the whole reserve is on the disk."""
        try:
            return self._path.stat().st_size >= self.size
        except OSError:
            return False

    def hold(self) -> bool:
        """Allocate the reserve unless it is held; return whether it is held now."""
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
        """Free the reserve except for `bytes_left`."""
        try:
            if self._path.stat().st_size > bytes_left:
                os.truncate(self._path, bytes_left)
        except OSError:
            return

    def free_bytes(self) -> int:
        """Return the free bytes of the disk for this process."""
        disk = os.statvfs(self._path.parent)
        return disk.f_bavail * disk.f_frsize


def _allocate(descriptor: int, size: int) -> None:
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(descriptor, 0, size)
        return
    os.pwrite(descriptor, bytes(size), 0)  # a system that has no such call
