"""Cache of map versions, so that a start need not replay whole histories.

Each map has a file `DATA_DIR/cache/UID.cache`: a line that names the version, then its map file.
The service replaces files that are missing, damaged or of another history from the store.
"""

import json
import logging
import os
from collections.abc import Collection
from pathlib import Path

from placecell_client import CompactMap, decode, encode

from service.core.files import sync_folder
from service.maps.store import MapHead, MapHistory

_SUFFIX = ".cache"
_UNFINISHED = ".unfinished"

logger = logging.getLogger("placecell")


class MapCache:
    """Cache files of one data directory.

    Attributes:
        folder: the folder, which may not exist yet. Others may keep files `UID.*` in it.
    """

    def __init__(self, data_dir: Path) -> None:
        self.folder = data_dir / "cache"

    def load(self, history: MapHistory) -> tuple[CompactMap, int] | None:
        """Return the cached version of a map and its sequence; None if no valid one is cached."""
        head = history.head
        path = self._path(head.uid)
        try:
            line, _, file = path.read_bytes().partition(b"\n")
            stated = json.loads(line)
            sequence = int(stated["sequence"])
            if not head.oldest <= sequence <= head.sequence:
                raise ValueError(
                    f"it has version {sequence}; the store has {head.oldest} to {head.sequence}"
                )
            if stated["mark"] != history.mark(sequence):
                raise ValueError(f"its version {sequence} differs from the store's")
            return decode(file), sequence
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            logger.warning("map %r: its cache file is ignored: %s", head.name, error)
            return None

    def save(self, head: MapHead, content: CompactMap) -> None:
        """Replace a map's cached version atomically.

        Args:
            head: head of the map at that version.
            content: segments of that version.
        """
        line = json.dumps({"name": head.name, "sequence": head.sequence, "mark": head.mark})
        write_whole(self._path(head.uid), line.encode() + b"\n", encode(content))

    def keep_only(self, uids: Collection[str]) -> None:
        """Remove the files of all other maps, and unfinished files."""
        for path in self.folder.glob("*"):
            if path.suffix == _UNFINISHED or path.stem not in uids:
                path.unlink(missing_ok=True)

    def _path(self, uid: str) -> Path:
        return self.folder / f"{uid}{_SUFFIX}"


def write_whole(path: Path, *parts: bytes) -> None:
    """Write a file of the cache whole or not at all; `MapCache.keep_only` removes unfinished ones.

    Raises:
        OSError: the file could not be written; an earlier one stays.
    """
    path.parent.mkdir(exist_ok=True)
    unfinished = path.with_name(path.name + _UNFINISHED)
    with unfinished.open("wb") as written:
        for part in parts:
            written.write(part)
        written.flush()
        os.fsync(written.fileno())
    unfinished.replace(path)
    sync_folder(path.parent)
