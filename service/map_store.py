"""Where maps are kept: what was written is there after a crash."""

import hashlib
import logging
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

import filelock

NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$"
_SUFFIX = ".safetensors"
_UNFINISHED = ".unfinished"

logger = logging.getLogger("placecell")


class MapStore(Protocol):
    """Map files by name. A write or a removal that has returned survives SIGKILL and power loss."""

    def names(self) -> list[str]:
        """Of the maps, sorted."""

    def read(self, name: str) -> bytes:
        """The map's file; KeyError if there is none."""

    def write(self, name: str, data: bytes) -> None:
        """Put a map's file, in place of the one before: all of it, or nothing."""

    def delete(self, name: str) -> None:
        """Remove a map's file; KeyError if there is none."""

    def set_aside(self, name: str) -> str:
        """Take a damaged file out of the maps, without destroying it; where it is now."""

    def writable(self) -> bool:
        """Whether the store can take a map."""


class StoreLockedError(Exception):
    """Another service owns the data directory."""


class FolderMapStore:
    """A file a map, in `DATA_DIR/maps`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @classmethod
    @contextmanager
    def open(cls, data_dir: Path) -> "Iterator[FolderMapStore]":
        """The store of a data directory, owned until the context ends.

        Raises:
            StoreLockedError: another process owns it.
            OSError: it cannot be made or written.
        """
        folder = data_dir / "maps"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            lock = filelock.FileLock(data_dir / "lock").acquire(timeout=0)
        except filelock.Timeout as error:
            raise StoreLockedError(f"{data_dir} is in use by another service") from error
        with lock:
            _sync_folder(data_dir)
            for unfinished in folder.glob(f".*{_UNFINISHED}"):
                unfinished.unlink()
            yield cls(folder)

    def names(self) -> list[str]:
        """Of the maps, sorted."""
        found = (path.name.removesuffix(_SUFFIX) for path in self._folder.glob(f"*{_SUFFIX}"))
        return sorted(name for name in found if re.fullmatch(NAME_PATTERN, name))

    def read(self, name: str) -> bytes:
        """The map's file; KeyError if there is none."""
        try:
            return self._path(name).read_bytes()
        except FileNotFoundError as error:
            raise KeyError(name) from error

    def write(self, name: str, data: bytes) -> None:
        """Put a map's file, in place of the one before: all of it, or nothing."""
        path = self._path(name)
        descriptor, unfinished = tempfile.mkstemp(_UNFINISHED, ".", self._folder)
        try:
            with os.fdopen(descriptor, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            Path(unfinished).replace(path)
        except BaseException:
            Path(unfinished).unlink(missing_ok=True)
            raise
        _sync_folder(self._folder)

    def delete(self, name: str) -> None:
        """Remove a map's file; KeyError if there is none."""
        try:
            self._path(name).unlink()
        except FileNotFoundError as error:
            raise KeyError(name) from error
        _sync_folder(self._folder)

    def set_aside(self, name: str) -> str:
        """Take a damaged file out of the maps, without destroying it; where it is now."""
        path = self._path(name)
        # The hash keeps apart two damaged files of one name.
        mark = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
        aside = path.with_name(f"{path.name}.{mark}.broken")
        path.replace(aside)
        _sync_folder(self._folder)
        return str(aside)

    def writable(self) -> bool:
        """Whether the store can take a map."""
        return self._folder.is_dir() and os.access(self._folder, os.W_OK)

    def _path(self, name: str) -> Path:
        # Routes have checked the name; this is the last line before the disk.
        if not re.fullmatch(NAME_PATTERN, name):
            raise ValueError(f"{name!r} is no map's name")
        return self._folder / f"{name}{_SUFFIX}"


def _sync_folder(folder: Path) -> None:
    """Make renames and removals in a folder last."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
