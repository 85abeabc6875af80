"""Disk reserve: space kept for deletions, so that a full disk can be freed."""

import errno
import os
from pathlib import Path

RESERVE_BYTES = 8 << 20
"""Size of the reserve on disks that are large enough, bytes."""

DISK_SHARE = 16
"""Divisor of a small disk's size that gives its reserve."""

STEP = 1 << 18
"""Step in which the space for the log grows, bytes."""

FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


class DiskReserve:
    """Reserve file `DATA_DIR/reserve`, which shrinks while a full disk is being freed.

    Attributes:
        size: bytes that are kept for deletions.
        log_bytes: further bytes that are kept for moving the log into the database. A log that
            cannot be moved grows with each write and is never overwritten.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / "reserve"
        disk = os.statvfs(folder)
        self.size = min(RESERVE_BYTES, disk.f_blocks * disk.f_frsize // DISK_SHARE)
        self.log_bytes = 0

    def is_held(self) -> bool:
        """Return whether the whole reserve is on the disk."""
        try:
            return self._path.stat().st_size >= self._wanted
        except OSError:
            return False

    def hold(self) -> bool:
        """Allocate the reserve, or a part if the disk is full; return whether all of it is held."""
        if self.is_held():
            return True
        try:
            descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError:
            return False
        try:
            before = os.fstat(descriptor).st_size
            missing = self._wanted - before
            for part in (missing, missing // 2, missing // 4):
                try:
                    _allocate(descriptor, before + part)
                    return part == missing
                except OSError:
                    # A file of the full size must hold allocated space.
                    os.ftruncate(descriptor, before)
            return False
        except OSError:
            return False
        finally:
            os.close(descriptor)

    def hold_for_log(self, log_bytes: int) -> bool:
        """Keep exactly so many bytes for the log, too; return whether all is held."""
        self.log_bytes = -(-max(log_bytes, 0) // STEP) * STEP
        if not self.hold():
            return False
        self.release(self._wanted)
        return True

    @property
    def _wanted(self) -> int:
        return self.size + self.log_bytes

    def release(self, bytes_left: int = 0) -> None:
        """Free the reserve except for `bytes_left`."""
        try:
            if self._path.stat().st_size > bytes_left:
                os.truncate(self._path, bytes_left)
        except OSError:
            return

    def release_share(self, share: float) -> int:
        """Free a share of the reserve and all bytes for the log; return the bytes left."""
        try:
            held = self._path.stat().st_size
        except OSError:
            return 0
        left = int(min(held, self.size) * (1.0 - share))
        self.release(left)
        return left

    def lend(self, bytes_: int) -> None:
        """Free a number of bytes of the reserve."""
        try:
            self.release(max(self._path.stat().st_size - bytes_, 0))
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
    os.pwrite(descriptor, bytes(size), 0)  # a system without posix_fallocate
