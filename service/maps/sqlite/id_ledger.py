"""Id ledger: records which ids were given out, in the file `DATA_DIR/ids` beside the database.

A database that is restored from a backup does not know which ids were given out since the backup.
The ledger knows: the service writes it before it gives out ids, and it stays in place when the
database is replaced. A ledger that is missing or was copied from elsewhere is not trusted.

The first line has the database's token and the time of the last change of `DATA_DIR/ids.place`,
which a copy cannot reproduce. Each further line has a map's uid, an id and a checksum: all ids of
that map below this id may have been given out.
"""

import errno
import logging
import os
import zlib
from collections.abc import Mapping
from pathlib import Path

from service.core.files import sync_folder
from service.maps.sqlite.disk_reserve import FULL
from service.maps.store import StoreError

LEASE = 4_096
"""Number of ids that are recorded in advance, so that few writes need an fsync."""

SKIPPED = 1 << 22
"""Number of ids of each map that are skipped if the ledger cannot be trusted."""

logger = logging.getLogger("placecell")


class IdLedger:
    """Ledger file of one data directory. Calls come one at a time.

    Attributes:
        limits: end of the ids that may have been given out, by the uid of the map.
        is_trusted: whether the file is the one last written here for this database.
    """

    def __init__(self, path: Path, token: str) -> None:
        self._path = path
        self._place = path.with_name(path.name + ".place")
        self._token = token
        self.limits: dict[str, int] = {}
        self.is_trusted = self._read()

    @property
    def is_there(self) -> bool:
        """Return whether the ledger file exists, even if it is invalid."""
        return self._path.exists()

    def rewrite(self, limits: Mapping[str, int]) -> None:
        """Replace the ledger's content atomically.

        Raises:
            OSError: the file could not be written; it is unchanged.
        """
        unfinished = self._path.with_name(self._path.name + ".unfinished")
        # Makes copies of the previous file distinguishable, too.
        place = _touch(self._place)
        with unfinished.open("wb") as file:
            lines = [f"{self._token} {place}", *(f"{uid} {end}" for uid, end in limits.items())]
            file.write("".join(map(_line, lines)).encode())
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(self._path)
        sync_folder(self._path.parent)
        self.limits = dict(limits)
        self.is_trusted = True

    def raise_to(self, uid: str, end: int) -> None:
        """Record that ids below `end` may be given out.

        Raises:
            StoreError: the disk is full or failing.
        """
        if self.limits.get(uid, 0) >= end:
            return
        line = _line(f"{uid} {end + LEASE}").encode()
        try:
            if not self.is_trusted:
                self.rewrite(self.limits | {uid: end + LEASE})
                return
            _append(self._path, line)
        except OSError as error:
            full = error.errno in FULL
            raise StoreError("full" if full else "failing", f"{self._path}: {error}") from error
        self.limits[uid] = end + LEASE

    def forget(self, uid: str) -> None:
        """Forget a map's ids; the next call rewrites the file."""
        self.limits.pop(uid, None)
        self.is_trusted = False

    def _read(self) -> bool:
        try:
            place = _place_of(self._place.stat())
            first, *lines = self._path.read_bytes().decode().split("\n")
            stated = _text(first).split(" ")
            for line in lines[:-1]:  # the last is empty, or incomplete and never relied on
                uid, end = _text(line).split(" ")
                self.limits[uid] = max(int(end), self.limits.get(uid, 0))
        except FileNotFoundError:
            return False
        except (OSError, ValueError) as error:
            logger.warning("%s is ignored: %s", self._path, error)
            return False
        return stated == [self._token, place]


def _touch(path: Path) -> str:
    """Create a file, or update its modification time; return that time."""
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_CLOEXEC, 0o644)
    try:
        os.utime(descriptor)
        os.fsync(descriptor)
        return _place_of(os.fstat(descriptor))
    finally:
        os.close(descriptor)


def _place_of(status: os.stat_result) -> str:
    return f"{status.st_ino}.{status.st_ctime_ns}"


def _append(path: Path, line: bytes) -> None:
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_CLOEXEC, 0o644)
    try:
        before = os.fstat(descriptor).st_size
        try:
            if os.pwrite(descriptor, line, before) < len(line):
                raise OSError(errno.ENOSPC, "only a part was written")
            os.fsync(descriptor)
        except OSError:
            os.ftruncate(descriptor, before)
            raise
    finally:
        os.close(descriptor)


def _line(text: str) -> str:
    return f"{text} {zlib.crc32(text.encode()):08x}\n"


def _text(line: str) -> str:
    text, _, checksum = line.rpartition(" ")
    if checksum != f"{zlib.crc32(text.encode()):08x}":
        raise ValueError(f"a line was altered: {line:.60}")
    return text
