"""Map files that are uploaded in parts: kept on disk until they are whole, and then written.

A part of a file is not a map: no reader sees it. An upload is named by the key that sends it, the
map that it is for and the SHA-256 of the whole file, so the same file sent again goes on where it
was cut.
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
"""After its last part an upload that was not completed is removed."""

KEY_UPLOADS = 64
"""Largest number of incomplete uploads of one key."""

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True)
class PartialUpload:
    """An upload that is not completed.

    Attributes:
        digest: SHA-256 of the whole file, 64 hex digits.
        bytes: that were received and are on the disk.
        time: of the last part, Unix seconds of the service's clock.
    """

    digest: str
    bytes: int
    time: float


class PartialUploads:
    """The uploads of all keys, in a folder of the data directory. For use from many threads.

    Args:
        data_dir: the data directory.
        limits: of the settings.
        clock: Unix seconds, as the disk has them.
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
        """Keep a part of a file; on return it is safely on disk.

        What was received before is not written again, so a part may be sent twice.

        Args:
            author: name of the key.
            name: of the map.
            digest: SHA-256 of the whole file.
            offset: where in the file the part begins.
            part: its bytes.

        Returns:
            How many bytes of the file are there.

        Raises:
            Problem: 409 if the bytes before the part are missing, 413 if the file is too large, 507
                if the uploads take too much room.
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
        """The file of an upload, while it is written to the map; at the end of it the upload goes.

        One at a time, for each is held in memory. If the block raises, the upload stays, unless it
        is no map file.

        Raises:
            Problem: 404 if there is no such upload, 422 if its bytes are not those of the digest;
                these are removed then.
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
                    f"The {len(content)} bytes that were received have another SHA-256 than "
                    f"{digest}. They were removed; send the file again from offset=0.",
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
        """Remove uploads whose last part came a day ago."""
        for path, size, changed in self._listed():
            if self._clock() - changed > KEEP_SECONDS:
                path.unlink(missing_ok=True)
                logger.info("an upload of %d bytes was not completed and is removed", size)

    def _check_room(self, author: str, path: Path, size: int, added: int) -> None:
        limits = self._limits
        if size > limits.upload_bytes:
            raise Problem(
                413,
                "upload-too-large",
                f"The file has more than {limits.upload_bytes} bytes, the limit; see /info.",
            )
        listed = self._listed()
        own = [each for each in listed if each[0].name.startswith(_hash(author))]
        cure = "Complete them or delete them (GET and DELETE /maps/MAP/uploads); they go by"
        cure += " themselves a day after their last part."
        if not path.exists() and len(own) >= KEY_UPLOADS:
            raise OverQuotaError(
                f"This key has {KEY_UPLOADS} uploads that are not complete, the limit. {cure}"
            )
        most = limits.unfinished_bytes
        if sum(each[1] for each in own) + added > most // 2:
            raise OverQuotaError(
                f"This key's uploads that are not complete would have more than {most // 2} "
                f"bytes, the limit. {cure}"
            )
        if sum(each[1] for each in listed) + added > most:
            raise OverQuotaError(
                f"All uploads that are not complete would have more than {most} bytes, the "
                f"limit. {cure}"
            )

    def _append(self, path: Path, there: int, rest: bytes) -> None:
        """Write at the end of a file; it is as it was if that fails."""
        if not self._folder.exists():
            try:
                # Without parents: no other data directory is made in its place.
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
        """All files with their size and their last change, sorted."""
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
    """The problem of an upload that is not there."""
    return Problem(
        404,
        "unknown-upload",
        f"This key has no upload {digest:.64} for map {name!r:.80}. It was completed or deleted, "
        "or its last part came a day ago. Send the file again from offset=0.",
    )


def _prefix(author: str, name: str) -> str:
    return f"{_hash(author)}-{_hash(name)}-"


def _hash(text: str) -> str:
    """Return a hash that stands for a name in a file name."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
