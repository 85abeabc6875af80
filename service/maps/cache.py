"""Maps as they were when their layers were last folded, so that a start need not replay them.

A file a map, `DATA_DIR/cache/UID.cache`: a line that says which version, then the map's file.
Nothing depends on it: what is missing, damaged or of another history is made from the store.
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
    """The files of one data directory."""

    def __init__(self, data_dir: Path) -> None:
        self._folder = data_dir / "cache"

    def load(self, history: MapHistory) -> tuple[CompactMap, int] | None:
        """An earlier version of a map, and its sequence; None if there is none to be trusted."""
        head = history.head
        path = self._path(head.uid)
        try:
            line, _, file = path.read_bytes().partition(b"\n")
            stated = json.loads(line)
            sequence = int(stated["sequence"])
            if not head.oldest <= sequence <= head.sequence:
                raise ValueError(
                    f"of version {sequence}; the store has {head.oldest} to {head.sequence}"
                )
            if stated["mark"] != history.mark(sequence):
                raise ValueError(f"its version {sequence} is not the store's")
            return decode(file), sequence
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            logger.warning("map %r: its cache is left aside: %s", head.name, error)
            return None

    def save(self, head: MapHead, content: CompactMap) -> None:
        """Keep a version of a map; the file is whole, or as it was.

        Args:
            head: of the version.
            content: its segments.
        """
        self._folder.mkdir(exist_ok=True)
        line = json.dumps({"name": head.name, "sequence": head.sequence, "mark": head.mark})
        path = self._path(head.uid)
        unfinished = path.with_suffix(_UNFINISHED)
        with unfinished.open("wb") as written:
            written.write(line.encode() + b"\n")
            written.write(encode(content))
            written.flush()
            os.fsync(written.fileno())
        unfinished.replace(path)
        sync_folder(self._folder)

    def keep_only(self, uids: Collection[str]) -> None:
        """Remove the files of other maps, and what was not finished."""
        for path in self._folder.glob("*"):
            if path.suffix == _UNFINISHED or (path.suffix == _SUFFIX and path.stem not in uids):
                path.unlink(missing_ok=True)

    def _path(self, uid: str) -> Path:
        return self._folder / f"{uid}{_SUFFIX}"
