"""Opens the store that the settings name: SQLite in the data directory, or PostgreSQL."""

from collections.abc import Iterator
from contextlib import contextmanager

from service.core.settings import Settings
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import MapStore, StoreError


@contextmanager
def open_store(settings: Settings) -> Iterator[MapStore]:
    """Open the store of some settings until the context ends.

    Raises:
        StoreLockedError: another service uses the data directory.
        StoreError: the store cannot be used; the message says what to do.
        OSError: the data directory cannot be created or written.
    """
    if settings.database.get_secret_value():
        raise StoreError("failing", "this version has no store on PostgreSQL yet")
    with SqliteMapStore.owned(settings.data_dir) as store:
        yield store
