"""Compiled loops: a decorator and an optional cache on disk."""

# mypy: allow-untyped-calls

import hashlib
import logging
import pickle
from collections.abc import Callable
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile

Function = TypeVar("Function", bound=Callable[..., Any])

CACHE_VERSION = f"{numba.__version__}+placecell-1"
"""Version of the cache, unlike Numba's own, so that neither reads the other's files."""

DIGEST_SIZE = hashlib.sha256().digest_size

logger = logging.getLogger("placecell")

_logged: set[str] = set()
_log_lock = Lock()


def compiled(function: Function) -> Function:
    """Compile a function at its first call and keep the machine code on disk.

    Other threads run while it computes. The cache is optional. If no folder is writable
    (`NUMBA_CACHE_DIR`, beside the source, the user's cache), each process compiles again. A
    truncated, damaged or foreign file is replaced. On a full disk nothing is written. The cache
    does not notice a change in another file: a compiled function calls only functions of its file.
    """
    dispatcher: Any = numba.njit(nogil=True)(function)
    try:
        dispatcher._cache = OptionalCache(function)
    except (RuntimeError, OSError) as error:  # RuntimeError: Numba finds no folder
        logger.debug("no cache of compiled code for %s: %s", function.__qualname__, error)
    result: Function = dispatcher
    return result


def compiled_part(function: Function) -> Function:
    """Compile a function that only compiled functions of its file call.

    Its machine code is part of theirs, so it needs no cache of its own.
    """
    dispatcher: Any = numba.njit(nogil=True)(function)
    result: Function = dispatcher
    return result


class CheckedCacheFile(IndexDataCacheFile):
    """Numba cache files with a checksum: damaged machine code would crash the process."""

    def __init__(self, cache_path: str, filename_base: str, source_stamp: object) -> None:
        super().__init__(cache_path, filename_base, source_stamp)
        self._version = CACHE_VERSION

    def _load_index(self) -> dict[Any, str]:
        """Return the index; an empty one if the file cannot be read."""
        try:
            index = super()._load_index()
        # Unpickling damaged bytes raises nearly anything.
        except Exception as error:
            log_once("unreadable", f"{self._index_path}: {error!r:.200}")
            return {}
        if not isinstance(index, dict):
            log_once("unreadable", f"{self._index_path}: not an index")
            return {}
        return index

    def _load_data(self, name: str) -> Any:
        content = Path(self._data_path(name)).read_bytes()
        stated, data = content[:DIGEST_SIZE], content[DIGEST_SIZE:]
        if hashlib.sha256(data).digest() != stated:
            raise ValueError(f"{name}: its checksum is wrong")
        return pickle.loads(data)

    def _save_data(self, name: str, data: Any) -> None:
        dumped = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(hashlib.sha256(dumped).digest())
            file.write(dumped)


class OptionalCache(FunctionCache):
    """Cache of compiled code that loads what it can and otherwise compiles anew."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._cache_file = CheckedCacheFile(
            self._cache_path, self._impl.filename_base, self._impl.locator.get_source_stamp()
        )

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled code; None if it must be compiled."""
        try:
            return super().load_overload(sig, target_context)
        # The code can be compiled whatever is wrong with the files.
        except Exception as error:
            log_once("unreadable", f"{self._name} in {self._cache_path}: {error!r:.200}")
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store compiled code if possible."""
        try:
            super().save_overload(sig, data)
        # For example: a full disk, a read-only folder, or a folder in place of the file.
        except Exception as error:
            log_once("unwritable", f"{self._name} in {self._cache_path}: {error!r:.200}")


def log_once(kind: str, detail: str) -> None:
    """Log each kind of problem once, however many files have it."""
    with _log_lock:
        first = kind not in _logged
        _logged.add(kind)
    logger.log(
        logging.WARNING if first else logging.DEBUG,
        "the cache of compiled code is %s; the code is compiled again: %s",
        kind,
        detail,
    )
