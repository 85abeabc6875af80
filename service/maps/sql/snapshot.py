"""Snapshot of a database: all maps at one moment."""

from service.maps.sql.annotations import read_annotations
from service.maps.sql.history import SqlHistory
from service.maps.sql.owners import Owners
from service.maps.sql.rows import Rows
from service.maps.sql.tables import HEAD, head_from, head_of, numbered_head_of, row_of
from service.maps.store import Annotation, MapHead, OwnedIds, StoreError


class SqlSnapshot:
    """All maps at one moment, within a read transaction."""

    def __init__(self, rows: Rows) -> None:
        self._rows = rows

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name; StoreError if one was altered."""
        found = self._rows.execute(f"{HEAD} ORDER BY name").fetchall()
        return [head_of(self._rows, head_from(row).uid) for row in found]

    def history(self, uid: str) -> SqlHistory:
        """Return a map's log, valid as long as the snapshot; KeyError if there is no such map."""
        return SqlHistory(self._rows, *numbered_head_of(self._rows, uid))

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Return the ascending runs of owned ids; KeyError if there is no such map."""
        return Owners(self._rows, row_of(self._rows, uid)).all()

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; StoreError if one was altered."""
        found, errors = read_annotations(self._rows)
        if errors:
            raise StoreError("damaged", errors[0])
        return found


def check_map(rows: Rows, uid: str) -> None:
    """Read all of a map; StoreError if a part was altered or lost."""
    snapshot = SqlSnapshot(rows)
    history = snapshot.history(uid)
    history.commits()
    history.base()
    for _ in history.blobs(history.head.oldest, history.head.sequence):
        pass
    snapshot.owned_ids(uid)
