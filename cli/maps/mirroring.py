"""Mirror of one map: copies it from a remote service to a local one, and resumes after a cut."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from placecell_client import (
    ChangesPage,
    Client,
    CompactMap,
    MapCopy,
    MapFileError,
    ServiceError,
    decode_delta,
    encode_delta,
)
from placecell_client.maps.edit import delta_between, take

NOT_FOUND, GONE = 404, 410
"""HTTP statuses: no such map; the remote has dropped the version or the cursor."""

REFUSED = frozenset({404, 409, 412, 413, 422})
"""HTTP statuses of an edit that the local map does not take; it is sent as a whole then."""


class PageSpool:
    """Folder with the pages of a pull that is not complete, so that it survives a restart."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def load(self, copy: MapCopy) -> None:
        """Give the stored pages to a copy that is at the version where they begin."""
        for number, path in enumerate(sorted(self._folder.glob("*.page"))):
            try:
                header, _, data = path.read_bytes().partition(b"\n")
                facts = json.loads(header)
                page = ChangesPage(decode_delta(data), facts["etag"], facts["next"])
                fits = (facts["since"], facts["cursor"]) == (copy.request[0], copy.request[1])
            except (ValueError, KeyError):
                fits = False
            # The last page is never stored, so no page completes the copy here.
            if not fits or int(path.stem) != number or copy.take(page):
                self.clear()
                return

    def add(self, request: tuple[str, str | None], page: ChangesPage) -> None:
        """Store a page that is not the last."""
        self._folder.mkdir(parents=True, exist_ok=True)
        number = len(list(self._folder.glob("*.page")))
        facts = {"since": request[0], "cursor": request[1], "etag": page.etag, "next": page.next}
        unfinished = self._folder / "unfinished"
        unfinished.write_bytes(json.dumps(facts).encode() + b"\n" + encode_delta(page.delta))
        unfinished.replace(self._folder / f"{number:06d}.page")

    def clear(self) -> None:
        """Remove all pages."""
        for path in self._folder.glob("*.page"):
            path.unlink()


@dataclass(frozen=True, slots=True)
class MirrorRound:
    """Result of one round.

    Attributes:
        etag: ETag of the version that the remote map has.
        segments: number of its segments.
        is_new: whether the local copy was changed.
    """

    etag: str
    segments: int
    is_new: bool


class Mirror:
    """Copier of one map; each round transfers only the changes."""

    def __init__(
        self, remote: Client, local: Client, name: str, target: str, source: str, spool: Path
    ) -> None:
        """Prepare; nothing is sent yet.

        Args:
            remote: client of the remote service.
            local: client of the local service, which writes mirrors of this source.
            name: name of the map at the remote service.
            target: name of the local copy.
            source: URL of the remote map.
            spool: folder of incomplete pulls; each mirror has its own in it.
        """
        self._remote = remote
        self._local = local
        self._name = name
        self._target = target
        self._source = source
        digest = hashlib.sha256(f"{source} {target}".encode()).hexdigest()
        self._spool = PageSpool(spool / digest[:16])
        self._copy: MapCopy | None = None
        self._stored: str | None = None
        self._written: tuple[CompactMap, str] | None = None

    def step(self) -> MirrorRound:
        """Copy what has changed since the last round.

        Raises:
            ServiceError: one of the services refused.
            TransportError: one of the services cannot be reached; the next round goes on.
            ValueError: the local map is not a mirror of this source.
        """
        copy = self._copy = self._copy or self._opened()
        is_resumed = copy.request[1] is not None
        is_new = self._update(copy)
        if is_resumed:
            # The stored pages led to the version of their time.
            is_new |= self._update(copy)
        self._copy_annotations()
        assert copy.content is not None
        assert copy.etag is not None
        return MirrorRound(copy.etag, len(copy.content), is_new)

    def _update(self, copy: MapCopy) -> bool:
        """Pull the newest version and store it; return whether it was not stored before."""
        self._pull(copy)
        assert copy.content is not None
        assert copy.etag is not None
        if copy.etag == self._stored:
            return False
        self._store(copy.content, copy.etag)
        self._stored = copy.etag
        self._spool.clear()
        return True

    def _opened(self) -> MapCopy:
        """Return the copy that the local service has; an empty one if it has none."""
        try:
            mark = self._local.mirror(self._target)
        except ServiceError as error:
            if error.status != NOT_FOUND:
                raise
            mark = None
        if mark is not None and mark.source != self._source:
            raise ValueError(
                f"Map {self._target!r} is a mirror of {mark.source}. Name another local map with "
                "--as."
            )
        if mark is None or not mark.etag:
            copy = MapCopy(self._name)
        else:
            # It may be newer than the mark; the same changes again make no difference.
            copy = MapCopy(self._name, self._local.get_map(self._target), mark.etag)
            self._stored = mark.etag
        self._spool.load(copy)
        return copy

    def _pull(self, copy: MapCopy) -> None:
        while True:
            request = copy.request
            try:
                page = self._remote.changes(self._name, *request, moved=True)
            except ServiceError as error:
                if error.status != GONE or not copy.restart():
                    raise
                self._spool.clear()
                continue
            if page.next is not None:
                self._spool.add(request, page)
            if copy.take(page):
                return

    def _store(self, content: CompactMap, etag: str) -> None:
        if self._local_mark_is_missing():
            empty = take(content, np.zeros(0, np.int64))
            try:
                self._local.put_map(self._target, empty, create_only=True)
            except ServiceError as error:
                if error.status != 412:  # it is there, and must be empty
                    raise
            self._local.set_mirror(self._target, self._source)
        if not self._edit(content):
            written = self._local.put_map(self._target, content, if_match="*")
            self._written = content, written.etag
        self._local.set_mirror(self._target, self._source, etag)

    def _edit(self, content: CompactMap) -> bool:
        """Send only the changes since the last write of this process; False if that is impossible.

        The local service applies them to the version that this write led to, or refuses.
        """
        written, self._written = self._written, None
        if written is None or content.has_odometry:  # such a map may hold moved captures
            return False
        before, etag = written
        try:
            delta = delta_between(before, content, 0, 0)
        except MapFileError:  # the remote map was replaced by one with other columns
            return False
        if delta.is_whole or delta.moved is not None:
            return False
        try:
            after = self._local.edit_map(self._target, delta, if_match=etag)
        except ServiceError as error:
            if error.status not in REFUSED:
                raise
            return False
        self._written = content, after.etag
        return True

    def _local_mark_is_missing(self) -> bool:
        try:
            return self._local.mirror(self._target) is None
        except ServiceError as error:
            if error.status != NOT_FOUND:
                raise
            return True

    def _copy_annotations(self) -> None:
        """Copy tags, anchor and named anchors, which belong to no version."""
        remote, local = self._remote, self._local
        tags = remote.tags(self._name)
        if tags != local.tags(self._target):
            local.set_tags(self._target, tags)
        anchors = [_anchor_of(client, name) for client, name in self._both()]
        if anchors[0] is None and anchors[1] is not None:
            local.delete_anchor(self._target)
        elif anchors[0] is not None and anchors[0] != anchors[1]:
            lat, lon, height, yaw_deg, accuracy, position = anchors[0]
            local.set_anchor(
                self._target,
                lat,
                lon,
                height=height,
                yaw_deg=yaw_deg,
                accuracy=accuracy,
                position=position,
            )
        wanted, found = (_poses_of(client, name) for client, name in self._both())
        for name in found.keys() - wanted.keys():
            local.delete_named_anchor(self._target, name)
        for name, (position, orientation) in wanted.items():
            if found.get(name) != (position, orientation):
                local.set_named_anchor(self._target, name, position, orientation)

    def _both(self) -> tuple[tuple[Client, str], tuple[Client, str]]:
        return (self._remote, self._name), (self._local, self._target)


Position = tuple[float, ...]


def _anchor_of(
    client: Client, name: str
) -> tuple[float, float, float, float, float, Position] | None:
    try:
        found = client.anchor(name)
    except ServiceError as error:
        if error.status != NOT_FOUND:
            raise
        return None
    return found.lat, found.lon, found.height, found.yaw_deg, found.accuracy, found.position


def _poses_of(client: Client, name: str) -> dict[str, tuple[Position, Position]]:
    return {
        each.name: (tuple(each.position.tolist()), tuple(each.orientation.tolist()))
        for each in client.anchors(name)
    }
