"""The maps that the service knows: stored, and searchable if the model that made them is loaded."""

import hashlib
import logging
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from threading import Lock

from placecell_client.map_file import CompactMap, MapFileError, decode

from service.map_index import MapIndex, index_of
from service.map_store import MapStore
from service.models import Models
from service.problems import Problem

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True)
class StoredMap:
    """A map in memory.

    Attributes:
        name: of the map.
        etag: SHA-256 of its file, in hex.
        bytes: of its file.
        content: its columns, sorted by id.
        index: over its descriptors; None if the model that made them is not loaded.
    """

    name: str
    etag: str
    bytes: int
    content: CompactMap
    index: MapIndex | None


class Maps:
    """All maps, by name. Safe to use from many threads: readers see a map whole, old or new."""

    def __init__(self, store: MapStore, models: Models) -> None:
        """Load what is stored; a damaged file is set aside with a line in the log."""
        self._store = store
        self._models = models
        self._writing = Lock()
        self._by_name: dict[str, StoredMap] = {}
        for name in store.names():
            data = store.read(name)
            etag = hashlib.sha256(data).hexdigest()
            try:
                self._by_name[name] = self._stored(name, etag, len(data), decode(data))
            except MapFileError as error:
                logger.error(
                    "map %r is damaged (%s); set aside as %s", name, error, store.set_aside(name)
                )
        self.index_all()

    def index_all(self) -> None:
        """Make those maps searchable whose models can be had by now."""
        with self._writing:
            self._models.want({stored.content.model_id for stored in self.all()})
            self._by_name = {
                name: replace(stored, index=stored.index or self._index(stored.content))
                for name, stored in self._by_name.items()
            }

    def __len__(self) -> int:
        return len(self._by_name)

    def writable(self) -> bool:
        """Whether a map can be stored."""
        return self._store.writable()

    def all(self) -> list[StoredMap]:
        """Sorted by name."""
        return sorted(self._by_name.values(), key=lambda stored: stored.name)

    def get(self, name: str) -> StoredMap:
        """One map; 404 if there is none."""
        stored = self._by_name.get(name)
        if stored is None:
            raise unknown(name)
        return stored

    def file(self, name: str) -> tuple[StoredMap, bytes]:
        """A map and its file, byte by byte; 404 if there is none."""
        with self._writing:
            stored = self.get(name)
            data = self._intact(stored)
        if data is None:
            logger.error("map %r was altered on disk", name)
            raise Problem(500, "map-damaged", f"The file of map {name!r} was altered on disk.")
        return stored, data

    def put(
        self, name: str, data: bytes, check: Callable[[CompactMap], None] = lambda _: None
    ) -> tuple[StoredMap, bool]:
        """Store a map; on return it is safely on disk. The same file again changes nothing.

        Args:
            check: raises if whoever sends the map may not store such a one, or replace what is
                there.

        Returns:
            The map, and whether the name is new.
        """
        known = self._by_name.get(name)
        etag = hashlib.sha256(data).hexdigest()
        if known is not None and known.etag == etag and self._intact(known) is not None:
            check(known.content)
            return known, False
        try:
            content = decode(data)
        except MapFileError as error:
            raise Problem(422, "invalid-map-file", f"Not a whole map file: {error}.") from error
        model = self._models.find(content.model_id)
        if model is None:
            raise self._models.unknown(content.model_id)
        manifest = model.manifest
        if content.code_bytes != manifest.code_bytes:
            raise Problem(
                422,
                "invalid-map-file",
                f"The map's codes have {content.code_bytes} bytes a segment; "
                f"the model's have {manifest.code_bytes}.",
            )
        if content.preprocessing != manifest.preprocessing["version"]:
            raise Problem(
                422,
                "invalid-map-file",
                f"The map's segments were prepared by version {content.preprocessing}; "
                f"the model's are by version {manifest.preprocessing['version']}.",
            )
        check(content)
        stored = self._stored(name, etag, len(data), content)
        with self._writing:
            old = self._by_name.get(name)
            is_new = old is None
            if old is not None:
                check(old.content)
            self._store.write(name, data)
            # A new dictionary, so that a reader in the midst of the old one is not disturbed.
            self._by_name = self._by_name | {name: stored}
        return stored, is_new

    def delete(self, name: str, check: Callable[[CompactMap], None] = lambda _: None) -> int:
        """Remove a map; on return it is gone from the disk. 404 if there is none.

        Args:
            check: raises if whoever asks may not remove such a map.

        Returns:
            How many segments it had.
        """
        with self._writing:
            old = self.get(name)
            check(old.content)
            with suppress(KeyError):  # someone removed the file by hand; so it is gone
                self._store.delete(name)
            self._by_name = {key: kept for key, kept in self._by_name.items() if key != name}
        return len(old.content)

    def _intact(self, stored: StoredMap) -> bytes | None:
        """The map's file, or None if the disk no longer holds what was put."""
        try:
            data = self._store.read(stored.name)
        except KeyError:
            return None
        return data if hashlib.sha256(data).hexdigest() == stored.etag else None

    def _stored(self, name: str, etag: str, size: int, content: CompactMap) -> StoredMap:
        return StoredMap(name, etag, size, content, self._index(content))

    def _index(self, content: CompactMap) -> MapIndex | None:
        model = self._models.find(content.model_id)
        if model is None or content.code_bytes != model.manifest.code_bytes:
            return None
        return index_of(content.codes, model.manifest.quantiser)


def unknown(name: str) -> Problem:
    """The problem of a name that no map has."""
    return Problem(404, "unknown-map", f"No map is named {name!r:.80}.")
