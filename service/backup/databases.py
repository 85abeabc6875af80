"""Stores by their name: the data directory of a service, or the URL of a PostgreSQL database."""

import re
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from pydantic import SecretStr

from service.core.settings import DATABASE_URL, Settings
from service.maps.sqlite.data_lock import locked
from service.maps.sqlite.snapshot import snapshot_of
from service.maps.sqlite.store import FILE, LAYOUT
from service.maps.store import MapStore, StoreSnapshot
from service.maps.stores import open_store

OTHER_ADDRESS = re.compile(
    r"[A-Za-z][A-Za-z0-9+.-]+:/|\s*(dbname|host|hostaddr|password|port|service|user)\s*="
)
"""Beginning of what is neither a folder nor the URL of a database: another URL, or `host=...`."""


def database_of(settings: Settings) -> str:
    """Return the name of the store that some settings select."""
    return settings.database.get_secret_value() or str(settings.data_dir)


def shown(database: str) -> str:
    """Return the name of a store without user, password and parameters."""
    scheme, separator, rest = database.partition("://")
    if not separator:
        return database
    return f"{scheme}{separator}{rest.rpartition('@')[2].partition('?')[0]}"


def check_name(database: str) -> None:
    """Check that a name is that of a store; ValueError, which shows no password, if it is not."""
    if not database.strip():
        raise ValueError(
            "The name of the database is empty; maybe a variable of the shell is not set. Name the "
            "data directory of a service, or postgresql://HOST/DATABASE."
        )
    found = OTHER_ADDRESS.match(database)
    if found and not DATABASE_URL.match(database):
        raise ValueError(
            f"Invalid database: found a name that begins with {database[: found.end()]!r}. "
            "Expected the data directory of a service, or "
            "postgresql://USER:PASSWORD@HOST:PORT/DATABASE."
        )


@contextmanager
def reading(database: str, owns: bool = False) -> Iterator[StoreSnapshot]:
    """Read all maps of a store at one moment.

    Args:
        database: URL of a PostgreSQL database, data directory, or file of SQLite.
        owns: whether no service may use a data directory meanwhile.

    Raises:
        ValueError: the name is not that of a store.
        FileNotFoundError: the data directory has no database.
        StoreLockedError: a service uses the data directory.
        StoreError: the store cannot be used; the message says what to do.
    """
    check_name(database)
    with ExitStack() as opened:
        if DATABASE_URL.match(database):
            store = opened.enter_context(_postgres(database))
            yield opened.enter_context(store.snapshot())
            return
        file = _file_of(database)
        if not file.is_file():
            raise FileNotFoundError(
                f"{database} holds no {FILE}. Name the data directory of a service, or the URL of "
                "a PostgreSQL database."
            )
        if owns:
            opened.enter_context(locked(file.parent))
        yield opened.enter_context(snapshot_of(file, LAYOUT))


@contextmanager
def writing(database: str) -> Iterator[MapStore]:
    """Open a store for an import.

    Args:
        database: URL of a PostgreSQL database, or data directory; the directory is created.

    Raises:
        ValueError: the name is not that of a store, or a file has another name than that of a
            data directory's database.
        StoreLockedError: a service uses the data directory.
        StoreError: the store cannot be used; the message says what to do.
    """
    check_name(database)
    if DATABASE_URL.match(database):
        with _postgres(database) as store:
            yield store
        return
    file = _file_of(database)
    if file.name != FILE:
        raise ValueError(
            f"{database} is a file. Name the folder that will hold {FILE}, or the URL of a "
            "PostgreSQL database."
        )
    with open_store(Settings(database=SecretStr(""), data_dir=file.parent)) as store:
        yield store


def is_same(one: str, other: str) -> bool:
    """Return whether two names are of one store."""
    if DATABASE_URL.match(one) or DATABASE_URL.match(other):
        return shown(one) == shown(other)
    return _file_of(one).resolve() == _file_of(other).resolve()


@contextmanager
def _postgres(url: str) -> Iterator[MapStore]:
    """Open a store on PostgreSQL, beside a service that owns the data directory."""
    with (
        tempfile.TemporaryDirectory(prefix="placecell-") as folder,
        open_store(Settings(database=SecretStr(url), data_dir=Path(folder))) as store,
    ):
        yield store


def _file_of(database: str) -> Path:
    path = Path(database)
    return path if path.is_file() else path / FILE
