"""A robot's copy of a shared map, and what is still missing from it. Nothing here sends."""

from dataclasses import dataclass

from placecell_client.maps.compact_map import CompactMap, MapFileError
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.edit import apply, join

PAGE_SEGMENTS = 20_000
"""In a part, at most: about a megabyte."""

LOST_AT_MOST = 5
"""Times that a pull is begun anew."""

GONE = 410
"""Status of a version that the service no longer knows."""


@dataclass(frozen=True, slots=True, eq=False)
class ChangesPage:
    """A part of what changed in a map.

    Attributes:
        delta: of the segments of this part; `since` and `until` are those of all parts together.
        etag: of the version that all parts lead to.
        next: cursor of the next part; None: this is the last.
    """

    delta: Delta
    etag: str
    next: str | None


class MapCopy:
    """A copy that `Client.pull` brings up to date.

    It always is one version of the map, whole: parts that have come are kept apart until all are
    there. Should the link be cut before, the next pull goes on where that one ended.

    Attributes:
        name: of the map.
        content: its segments; None before the first pull.
        etag: of the version; None before the first pull.
    """

    def __init__(
        self, name: str, content: CompactMap | None = None, etag: str | None = None
    ) -> None:
        """A copy.

        Args:
            name: of the map.
            content: what is known of it, as it was pulled, perhaps by an earlier run; with
            etag: of that version.

        Raises:
            ValueError: one is given without the other.
        """
        if (content is None) != (etag is None):
            raise ValueError("give both, content and etag, or none")
        self.name = name
        self.content = content
        self.etag = etag
        self._parts: list[Delta] = []
        self._cursor: str | None = None
        self._whole = content is None
        self._lost = 0

    @property
    def sequence(self) -> int:
        """Of the version; 0 before the first pull."""
        return int(self.etag.rpartition("-")[2]) if self.etag is not None else 0

    @property
    def request(self) -> tuple[str, str | None]:
        """What to ask for next: since which version, and the cursor of a part, if some are here."""
        return "0" if self._whole or self.etag is None else self.etag, self._cursor

    def take(self, page: ChangesPage) -> bool:
        """Put a part to the others; whether all are there, and the copy is the new version.

        Raises:
            MapFileError: the part is not of what was asked for.
        """
        if page.delta.since not in {0, self.sequence}:
            raise MapFileError(f"changes since {page.delta.since}; the copy is at {self.sequence}")
        parts = [*self._parts, page.delta]
        if page.next is not None:
            self._parts, self._cursor = parts, page.next
            return False
        delta = join(parts)
        # One from nothing is the map itself.
        base = delta.changed if self.content is None else self.content
        self.content, self.etag = apply(base, delta), page.etag
        self._begin_anew(whole=False)
        self._lost = 0
        return True

    def lose_way(self) -> bool:
        """The service no longer knows the version, or the cursor: begin anew, or with nothing.

        Returns:
            False if there is no point in it now; a later pull may have more luck.
        """
        self._lost += 1
        if self.request == ("0", None) or self._lost > LOST_AT_MOST:
            self._lost = 0
            return False
        self._begin_anew(whole=self._whole or self._cursor is None)
        return True

    def _begin_anew(self, whole: bool) -> None:
        self._parts, self._cursor, self._whole = [], None, whole
