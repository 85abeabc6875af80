"""Upload: sends the edits of the spool, oldest first, and chooses the maps that receive them."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count

from robot.core.link import Link, LinkError, RefusedError
from robot.mapping.spool import SpoolEntry

NAME_BYTES = 64
"""Largest length of a map's name."""
NOT_OURS = frozenset({"other-frame", "other-model", "id-taken"})
"""Problems that show that a map is not the one that this robot began."""
MAY_PASS = frozenset({401, 403, 404, 408, 425, 429, 500, 502, 503, 504, 507})
"""Statuses that a person or time can cure: the edit is kept."""


@dataclass(frozen=True, slots=True)
class UploadResult:
    """Result of sending some edits.

    Attributes:
        sent: edits that the service has now, each with the map that received it.
        refused: edit that the service will never take, and why; None if there is none.
        error: why the rest was not sent; None if all were.
        retry_after: seconds that the service asks to wait; None if it does not.
        was_reached: whether the service answered the last call.
    """

    sent: tuple[tuple[SpoolEntry, str], ...]
    refused: tuple[SpoolEntry, str] | None = None
    error: str | None = None
    retry_after: float | None = None
    was_reached: bool = True


def names_for(name: str, robot: str) -> Iterator[str]:
    """Yield names for the robot's own map: NAME, NAME-ROBOT, NAME-ROBOT-2 and so on."""
    yield name
    own = re.sub(r"[^A-Za-z0-9._-]+", "_", robot)
    for number in count(1):
        suffix = f"-{own}"[: NAME_BYTES // 2] + (f"-{number}" if number > 1 else "")
        yield name[: NAME_BYTES - len(suffix)] + suffix


def send(
    link: Link,
    entries: Sequence[SpoolEntry],
    known: dict[tuple[str, int], str],
    name: str,
    robot: str,
) -> UploadResult:
    """Send edits in their order, until one fails.

    The first edit of a session creates its map. A map of that name that is another's is never
    changed: the robot's odometry frame is not that map's frame. The next free name is used.

    Args:
        link: link to the service.
        entries: the edits, oldest first.
        known: map of each part of a session, as far as it is chosen.
        name: wanted name of the map.
        robot: name of the robot.
    """
    sent: list[tuple[SpoolEntry, str]] = []
    chosen = dict(known)
    for entry in entries:
        key = (entry.session, entry.part)
        try:
            stored = send_one(link, entry, chosen.get(key), name, robot)
        except LinkError as error:
            return UploadResult(tuple(sent), None, str(error), error.retry_after, error.was_reached)
        except RefusedError as error:
            if error.status in MAY_PASS:
                return UploadResult(tuple(sent), None, str(error))
            return UploadResult(tuple(sent), (entry, str(error)))
        chosen[key] = stored
        sent.append((entry, stored))
    return UploadResult(tuple(sent))


def send_one(link: Link, entry: SpoolEntry, known: str | None, name: str, robot: str) -> str:
    """Send an edit; return the map that received it.

    Raises:
        LinkError, RefusedError: the edit was not stored.
    """
    if known is not None:
        try:
            link.upload(known, entry.content, robot, create=False)
            return known
        except RefusedError as error:
            # Somebody removed or replaced the map: begin another one.
            if error.kind not in NOT_OURS and error.status != 404:
                raise
    for candidate in names_for(name, robot):
        try:
            link.upload(candidate, entry.content, robot, create=True)
            return candidate
        except RefusedError as error:
            if error.kind not in NOT_OURS:
                raise
    raise AssertionError("names never end")
