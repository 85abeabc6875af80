"""Local copy of a shared map, updated page by page; no input or output."""

from dataclasses import dataclass

from placecell_client.maps.compact_map import CompactMap, MapFileError
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.edit import apply, join

PAGE_SEGMENTS = 20_000
"""Largest number of segments per page; a page is about a megabyte."""

RESTARTS = 5
"""Largest number of restarts of a pull."""


@dataclass(frozen=True, slots=True, eq=False)
class ChangesPage:
    """One page of the changes of a map.

    Attributes:
        delta: Changes of this page; `since` and `until` are those of all pages together.
        etag: ETag of the version after all pages.
        next: Cursor of the next page; None for the last page.
    """

    delta: Delta
    etag: str
    next: str | None


class MapCopy:
    """Local copy of a map; `Client.pull` updates it.

    The copy always holds one complete version of the map. Received pages are kept apart until all
    have arrived. If the connection breaks before, the next pull continues with the missing page.

    Attributes:
        name: Name of the map.
        content: The map; None before the first pull.
        etag: ETag of the version; None before the first pull.
    """

    def __init__(
        self, name: str, content: CompactMap | None = None, etag: str | None = None
    ) -> None:
        """Create a copy, empty or from an earlier pull.

        Args:
            name: Name of the map.
            content: The map from an earlier pull.
            etag: ETag of that version.

        Raises:
            ValueError: Only one of `content` and `etag` is given.
        """
        if (content is None) != (etag is None):
            raise ValueError("Give both content and etag, or neither.")
        self.name = name
        self.content = content
        self.etag = etag
        self._parts: list[Delta] = []
        self._cursor: str | None = None
        self._whole = content is None
        self._lost = 0

    @property
    def sequence(self) -> int:
        """Sequence number of the version; 0 before the first pull."""
        return int(self.etag.rpartition("-")[2]) if self.etag is not None else 0

    @property
    def request(self) -> tuple[str, str | None]:
        """The next page to request: the version to start from, and the page's cursor or None."""
        return "0" if self._whole or self.etag is None else self.etag, self._cursor

    def take(self, page: ChangesPage) -> bool:
        """Add a page; return whether it was the last and the copy is updated.

        Raises:
            MapFileError: The page does not fit the copy.
        """
        if page.delta.since not in {0, self.sequence}:
            raise MapFileError(
                f"the page starts at version {page.delta.since}, "
                f"but the copy is at version {self.sequence}"
            )
        parts = [*self._parts, page.delta]
        if page.next is not None:
            self._parts, self._cursor = parts, page.next
            return False
        delta = join(parts)
        # The changes since version 0 are the whole map.
        base = delta.changed if self.content is None else self.content
        self.content, self.etag = apply(base, delta), page.etag
        self._reset(whole=False)
        self._lost = 0
        return True

    def restart(self) -> bool:
        """Restart after the service has dropped the version or the cursor.

        A dropped cursor restarts the pull from the copy's version; a dropped version restarts it
        with the whole map.

        Returns:
            False if the pull must fail, because it has restarted too often or has nothing to drop.
        """
        self._lost += 1
        if self.request == ("0", None) or self._lost > RESTARTS:
            self._lost = 0
            return False
        self._reset(whole=self._whole or self._cursor is None)
        return True

    def _reset(self, whole: bool) -> None:
        self._parts, self._cursor, self._whole = [], None, whole
