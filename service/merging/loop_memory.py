"""Memory of the loops that the last optimization of each map found, also after a restart.

Each map has a file `DATA_DIR/cache/UID.loops`. A file that is damaged, or that another version of
the format, another model or other parameters made, is ignored and replaced.
"""

import logging
from collections import OrderedDict
from io import BytesIO
from pathlib import Path
from threading import Lock
from typing import Any
from zipfile import BadZipFile

import numpy as np

from placecell.pose_graph.known_loops import KnownLoops
from service.maps.cache import write_whole

MOST = 32
"""Largest number of maps whose loops are in memory; the least recently optimized leaves it."""

VERSION = 1
"""Version of the files."""

_SUFFIX = ".loops"

logger = logging.getLogger("placecell")


class LoopMemory:
    """Loops by map, and by the model and the parameters that found them."""

    def __init__(self, folder: Path | None = None, most: int = MOST) -> None:
        """Create it.

        Args:
            folder: folder of the files, which may not exist yet; None: loops are in memory only.
            most: largest number of maps whose loops are in memory.
        """
        self._folder = folder
        self._most = most
        self._known: OrderedDict[tuple[str, str], KnownLoops] = OrderedDict()
        self._lock = Lock()

    def get(self, uid: str, finder: str) -> KnownLoops | None:
        """Return the known loops of a map; None if there are none.

        Args:
            uid: unique id of the map.
            finder: model and parameters of the search.
        """
        with self._lock:
            known = self._known.get((uid, finder))
        return self._read(uid, finder) if known is None else known

    def put(self, uid: str, finder: str, known: KnownLoops) -> None:
        """Remember the loops of a map in place of earlier ones."""
        with self._lock:
            self._known[uid, finder] = known
            self._known.move_to_end((uid, finder))
            while len(self._known) > self._most:
                self._known.popitem(last=False)
        self._write(uid, finder, known)

    def _read(self, uid: str, finder: str) -> KnownLoops | None:
        if self._folder is None:
            return None
        path = self._folder / f"{uid}{_SUFFIX}"
        try:
            with np.load(BytesIO(path.read_bytes()), allow_pickle=False) as file:
                if str(file["finder"]) != _stamp(finder):
                    return None
                return KnownLoops.of_arrays({name: file[name] for name in file.files})
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
            logger.warning("the loops in %s are ignored: %s", path, error)
            return None

    def _write(self, uid: str, finder: str, known: KnownLoops) -> None:
        if self._folder is None:
            return
        path = self._folder / f"{uid}{_SUFFIX}"
        file, arrays = BytesIO(), dict[str, Any](known.arrays())
        np.savez(file, finder=np.array(_stamp(finder)), **arrays)
        try:
            write_whole(path, file.getvalue())
        except OSError as error:  # the next optimization searches all loops again
            logger.warning("the loops of %s cannot be kept: %s", path, error)


def _stamp(finder: str) -> str:
    return f"{VERSION} {finder}"
