"""Backup in a folder."""

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

import filelock

from service.backup.format import MANIFEST, BackupError
from service.core.files import sync_folder

OBJECTS, LOCK, UNFINISHED = "objects", "lock", ".unfinished"


class FolderTarget:
    """Folder with a backup: `backup.json`, and `objects/AB/ABCDEF...`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __str__(self) -> str:
        return str(self._folder)

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Create and lock the folder; BackupError if it has other contents or is locked."""
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
        except FileExistsError as error:
            raise BackupError(f"{self} is a file. Name a folder.") from error
        found = {path.name for path in self._folder.iterdir()}
        if MANIFEST not in found and (other := sorted(found - {OBJECTS, LOCK})):
            raise BackupError(
                f"{self} is not empty and holds no backup: found {other[0]!r}. Name a new folder."
            )
        try:
            with filelock.FileLock(self._folder / LOCK, timeout=0):
                yield
        except filelock.Timeout as error:
            raise BackupError(f"Another backup to {self} runs. Wait until it ends.") from error

    def manifest(self) -> bytes | None:
        """Return the bytes of the manifest; None if there is none."""
        try:
            return (self._folder / MANIFEST).read_bytes()
        except FileNotFoundError:
            return None

    def objects(self) -> dict[str, int]:
        """Return the bytes of each object that is there, by its name."""
        found = (self._folder / OBJECTS).glob("??/*")
        return {path.name: path.stat().st_size for path in found}

    def read(self, name: str) -> bytes:
        """Return an object; BackupError if it is missing."""
        try:
            return self._path(name).read_bytes()
        except FileNotFoundError as error:
            raise BackupError(f"{self._path(name)} is missing. Use another backup.") from error

    def is_whole(self, name: str, data: bytes) -> bool:
        """Return whether an object that is there has these bytes; a disk can alter them."""
        return self._path(name).read_bytes() == data

    def write(self, name: str, data: bytes) -> None:
        """Write an object."""
        path = self._path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        self._replace(path, data)

    def replace_manifest(self, data: bytes) -> None:
        """Write the manifest, which makes the backup valid."""
        objects = self._folder / OBJECTS
        for folder in (*objects.glob("??"), *([objects] if objects.exists() else [])):
            sync_folder(folder)
        self._replace(self._folder / MANIFEST, data)
        sync_folder(self._folder)

    def remove_others(self, kept: Collection[str]) -> None:
        """Remove all objects but these, and files of killed backups."""
        for path in (self._folder / OBJECTS).glob("??/*"):
            if path.name not in kept:
                path.unlink()

    def _path(self, name: str) -> Path:
        return self._folder / OBJECTS / name[:2] / name

    def _replace(self, path: Path, data: bytes) -> None:
        """Write a file beside its place, and rename it when it is on disk."""
        unfinished = path.with_name(path.name + UNFINISHED)
        try:
            with unfinished.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            error.filename = error.filename or str(self)
            raise
        unfinished.replace(path)
