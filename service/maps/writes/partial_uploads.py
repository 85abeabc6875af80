"""Partial uploads: map files that arrive in parts and stay on disk until they are complete.

Readers do not see an incomplete upload. Its name consists of the key that sends it, the map that it
is for and the SHA-256 of the whole file, so a client that sends the same file again continues where
it stopped.
"""

import hashlib
import logging
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from placecell.core.cancellation import holding
from service.core.files import sync_folder
from service.core.problems import Problem
from service.core.settings import Limits
from service.maps.quotas import OverQuotaError
from service.maps.store import StoreError

FOLDER = "uploads"

KEEP_SECONDS = 86_400.0
"""Seconds after its last part when an incomplete upload is removed."""

KEY_UPLOADS = 64
"""Largest number of incomplete uploads of one key."""

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True)
class PartialUpload:
    """Incomplete upload.

    Attributes:
        digest: SHA-256 of the whole file, 64 hex digits.
        bytes: number of bytes received and on disk.
        time: time of the last part, Unix seconds of the service's clock.
    """

    digest: str
    bytes: int
    time: float


class PartialUploads:
    """Incomplete uploads of all keys, in a folder of the data directory. Safe for many threads.

    Args:
        data_dir: the data directory.
        limits: limits of the settings.
        clock: returns Unix seconds of the disk's clock.
    """

    def __init__(
        self, data_dir: Path, limits: Limits, clock: Callable[[], float] = time.time
    ) -> None:
        self._folder = data_dir / FOLDER
        self._limits = limits
        self._clock = clock
        self._files = Lock()
        self._completing = Lock()

    def of(self, author: str, name: str) -> list[PartialUpload]:
        """Return a key's uploads for one map, sorted by digest."""
        prefix = _prefix(author, name)
        return [
            PartialUpload(path.name.removeprefix(prefix), size, changed)
            for path, size, changed in self._listed()
            if path.name.startswith(prefix)
        ]

    def add(self, author: str, name: str, digest: str, offset: int, part: bytes) -> int:
        """Store a part of a file; on return it is durable.

        Bytes that were received before are not written again, so a client may repeat a part.

        Args:
            author: name of the key.
            name: name of the map.
            digest: SHA-256 of the whole file.
            offset: byte of the file at which the part begins.
            part: bytes of the part.

        Returns:
            Number of bytes of the file on disk.

        Raises:
            Problem: 409 if bytes before the part are missing, 413 if the file is too large, 507 if
                the uploads exceed a quota.
        """
        path = self._path(author, name, digest)
        with holding(self._files):
            there = path.stat().st_size if path.exists() else 0
            if offset > there:
                raise Problem(
                    409,
                    "wrong-offset",
                    f"The part begins at byte {offset}, but {there} bytes of this upload were "
                    f"received. Send the part with offset={there}.",
                )
            rest = part[there - offset :]
            if rest or not path.exists():
                self._check_room(author, path, there + len(rest), len(rest))
                self._append(path, there, rest)
            return there + len(rest)

    @contextmanager
    def whole(self, author: str, name: str, digest: str) -> Iterator[bytes]:
        """Read the file of an upload for a block that writes it to the map, then remove the upload.

        One upload at a time, because each is held in memory. If the block raises, the upload stays,
        unless it is not a valid map file.

        Raises:
            Problem: 404 if there is no such upload, 422 if its bytes have another digest; the
                upload is removed then.
        """
        path = self._path(author, name, digest)
        with holding(self._completing):
            try:
                content = path.read_bytes()
            except FileNotFoundError as error:
                raise unknown_upload(name, digest) from error
            if hashlib.sha256(content).hexdigest() != digest:
                path.unlink(missing_ok=True)
                raise Problem(
                    422,
                    "upload-damaged",
                    f"The {len(content)} received bytes do not have SHA-256 {digest}. The service "
                    "removed them. Send the file again from offset=0.",
                )
            try:
                yield content
            except Problem as problem:
                if problem.kind == "invalid-map-file":
                    path.unlink(missing_ok=True)
                raise
            path.unlink(missing_ok=True)

    def remove(self, author: str, name: str, digest: str) -> None:
        """Remove an upload; 404 if there is none."""
        try:
            self._path(author, name, digest).unlink()
        except FileNotFoundError as error:
            raise unknown_upload(name, digest) from error

    def forget_old(self) -> None:
        """Remove uploads whose last part arrived more than a day ago."""
        for path, size, changed in self._listed():
            if self._clock() - changed > KEEP_SECONDS:
                path.unlink(missing_ok=True)
                logger.info("removed an incomplete upload of %d bytes", size)

    def _check_room(self, author: str, path: Path, size: int, added: int) -> None:
        limits = self._limits
        if size > limits.upload_bytes:
            raise Problem(
                413,
                "upload-too-large",
                f"The file has more than {limits.upload_bytes} bytes, the limit in GET /info. "
                "Split the map into several maps.",
            )
        listed = self._listed()
        own = [each for each in listed if each[0].name.startswith(_hash(author))]
        advice = (
            "Complete or delete them (GET and DELETE /maps/MAP/uploads). The service removes an "
            "upload a day after its last part."
        )
        if not path.exists() and len(own) >= KEY_UPLOADS:
            raise OverQuotaError(
                f"This key has {KEY_UPLOADS} uploads that are incomplete; the limit is "
                f"{KEY_UPLOADS}. {advice}"
            )
        most = limits.unfinished_bytes
        if sum(each[1] for each in own) + added > most // 2:
            raise OverQuotaError(
                f"This key's incomplete uploads would have more than {most // 2} bytes, the limit. "
                f"{advice}"
            )
        if sum(each[1] for each in listed) + added > most:
            raise OverQuotaError(
                f"All incomplete uploads would have more than {most} bytes, the limit. {advice}"
            )

    def _append(self, path: Path, there: int, rest: bytes) -> None:
        """Append to a file durably; restore its length if that fails."""
        if not self._folder.exists():
            try:
                # Without parents, so that no new data directory replaces one that was moved.
                self._folder.mkdir(mode=0o700)
            except FileNotFoundError as error:
                folder = self._folder.parent
                raise StoreError("moved", f"{folder} was moved or removed.") from error
            sync_folder(self._folder.parent)
        is_new = not path.exists()
        with path.open("ab") as written:
            try:
                written.write(rest)
                written.flush()
                os.fsync(written.fileno())
            except OSError:
                os.ftruncate(written.fileno(), there)
                raise
        if is_new:
            sync_folder(self._folder)

    def _listed(self) -> list[tuple[Path, int, float]]:
        """Return all files with their size and the time of their last change, sorted."""
        found = []
        for path in sorted(self._folder.glob("*")):
            try:
                status = path.stat()
            except FileNotFoundError:
                continue
            found.append((path, status.st_size, status.st_mtime))
        return found

    def _path(self, author: str, name: str, digest: str) -> Path:
        return self._folder / f"{_prefix(author, name)}{digest}"


def unknown_upload(name: str, digest: str) -> Problem:
    """Return the problem of an upload that does not exist."""
    return Problem(
        404,
        "unknown-upload",
        f"This key has no upload {digest:.64} for map {name!r:.80}. It was completed, deleted, or "
        "removed a day after its last part. Send the file again from offset=0.",
    )


def _prefix(author: str, name: str) -> str:
    return f"{_hash(author)}-{_hash(name)}-"


def _hash(text: str) -> str:
    """Return a hash that represents a name in a file name."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
