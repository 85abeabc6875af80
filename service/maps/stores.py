"""Opens the store that the settings name: SQLite in the data directory, or PostgreSQL."""

from collections.abc import Iterator
from contextlib import contextmanager

from service.core.settings import Settings
from service.maps.sqlite.data_lock import locked
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import MapStore, StoreError

OTHER_CONNECTIONS = 14
"""Connections of a service to PostgreSQL beside those of uploads and alignments."""


@contextmanager
def open_store(settings: Settings) -> Iterator[MapStore]:
    """Open the store of some settings until the context ends.

    Raises:
        StoreLockedError: another service uses the data directory.
        StoreError: the store cannot be used; the message says what to do.
        OSError: the data directory cannot be created or written.
    """
    url = settings.database.get_secret_value()
    if not url:
        with SqliteMapStore.owned(settings.data_dir) as store:
            yield store
        return
    try:
        from service.maps.postgres.store import PostgresStore
    except ModuleNotFoundError as error:
        raise StoreError(
            "failing",
            f"The Python package {error.name} is missing, which a database on PostgreSQL needs. "
            "Install it: pip install 'placecell[postgres]'",
        ) from error
    limits = settings.limits
    # Each thread that writes may hold one; further ones read.
    connections = limits.uploads + limits.alignments + OTHER_CONNECTIONS
    settings.data_dir.mkdir(parents=True, exist_ok=True)
    # It has the cache and unfinished uploads of one service.
    with locked(settings.data_dir), PostgresStore.opened(url, connections) as store:
        yield store
