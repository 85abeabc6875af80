"""Versions of maps that a client has written or read, for services that share a database."""

import re
from collections import OrderedDict
from collections.abc import Mapping
from threading import Lock

SEEN_HEADER = "Placecell-Seen"
"""Header by which a service loads these versions before it answers."""

GONE = "-"
"""Tag of a map that the client deleted."""

MOST = 16
"""Largest number of maps in the header: those that the client used last."""

MAP_NAME = "[A-Za-z0-9][A-Za-z0-9._-]{0,63}"
"""Pattern of the name of a map."""

_MAP = re.compile(rf"/maps/({MAP_NAME})(/changes)?(\?.*)?")
_WRITTEN = re.compile(rf"/maps/({MAP_NAME})(/[a-z/0-9]*)?(\?.*)?")
_TAG = re.compile(r"(?:W/)?\"([0-9a-f]{16}-([0-9]{1,16}))\"")


class SeenVersions:
    """Newest version of each map that the client knows. Safe to use from many threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._tags: OrderedDict[str, str] = OrderedDict()

    def headers(self) -> dict[str, str]:
        """Return the header of the next request; none if the client knows no version."""
        with self._lock:
            pairs = [f"{name} {tag}" for name, tag in self._tags.items()]
        return {SEEN_HEADER: ", ".join(pairs)} if pairs else {}

    def note(self, method: str, path: str, headers: Mapping[str, str]) -> None:
        """Note the version that an answer states.

        Args:
            method: Method of the request.
            path: Path of the request, with its query.
            headers: Headers of the answer.
        """
        is_read = method == "GET"
        match = (_MAP if is_read else _WRITTEN).fullmatch(path)
        if match is None or (is_read and "version=" in (match[3] or "")):
            return  # an earlier version says nothing about the newest one
        if method == "DELETE" and match[2] is None:
            self._put(match[1], GONE)
            return
        tag = _TAG.fullmatch(headers.get("ETag", ""))
        if tag is not None and not (is_read and self._is_older(match[1], int(tag[2]))):
            self._put(match[1], tag[1])

    def _is_older(self, name: str, sequence: int) -> bool:
        """Return whether the client knows a later version; answers can arrive out of order."""
        with self._lock:
            known = self._tags.get(name, GONE).rpartition("-")[2]
        return known != "" and int(known) > sequence

    def _put(self, name: str, tag: str) -> None:
        with self._lock:
            self._tags[name] = tag
            self._tags.move_to_end(name)
            while len(self._tags) > MOST:
                self._tags.popitem(last=False)
