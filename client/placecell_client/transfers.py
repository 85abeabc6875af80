"""Transfers of several calls: upload of a map in parts, pull of a map in pages.

A transfer is a generator of calls. The client sends each call and passes its result, or its
`ServiceError`, back into the generator.
"""

import hashlib
from collections.abc import Generator
from typing import Any, TypeAlias, TypeVar

from placecell_client.http.errors import ServiceError
from placecell_client.http.requests import Call, Calls
from placecell_client.maps.map_file import CompactMap, encode
from placecell_client.replica import MapCopy
from placecell_client.results.core import Info, MapSummary

T = TypeVar("T")

Steps: TypeAlias = Generator[Call[Any], Any, T]
"""A transfer with a result of type T."""

PART_BYTES = 4 << 20
"""Size of an uploaded part, bytes; a slow link sends a part within the call's timeout."""

ASK_BYTES = 8 << 20
"""File size above which the client asks for the service's limits before it sends, bytes."""

ROUNDS = 2
"""Largest number of starts of an upload; another client may complete or remove it meanwhile."""

GONE = 410
"""HTTP status: the service has dropped the version or the cursor."""

TOO_LARGE = "urn:placecell:problem:body-too-large"
RESTARTABLE = frozenset(
    f"urn:placecell:problem:{kind}" for kind in ("unknown-upload", "upload-damaged", "wrong-offset")
)


def put_map(
    calls: Calls,
    name: str,
    compact_map: CompactMap | bytes,
    if_match: str | None,
    create_only: bool,
) -> Steps[MapSummary]:
    """Store a map, in parts if its file exceeds the service's request limit.

    Args:
        calls: Factory of the calls.
        name: Name of the map.
        compact_map: The map, or the content of its file.
        if_match: ETag of the version to replace, or `*` for any version.
        create_only: Refuse to replace a map.
    """
    data = encode(compact_map) if isinstance(compact_map, CompactMap) else compact_map
    info: Info | None = None
    if len(data) > ASK_BYTES:
        info = yield calls.info()
        if len(data) > info.limits.get("map_bytes", len(data)) and _takes_parts(info):
            return (yield from _in_parts(calls, name, data, if_match, create_only, info))
    try:
        stored: MapSummary = yield calls.put_map(name, data, if_match, create_only)
    except ServiceError as error:
        if error.type != TOO_LARGE:
            raise
        if info is None:
            info = yield calls.info()
        if not _takes_parts(info):
            raise
    else:
        return stored
    return (yield from _in_parts(calls, name, data, if_match, create_only, info))


def pull(calls: Calls, copy: MapCopy | str, limit: int) -> Steps[MapCopy]:
    """Update a copy of a map, page by page.

    Args:
        calls: Factory of the calls.
        copy: Copy to update, or the name of a map for a new copy.
        limit: Largest number of segments per page.
    """
    if isinstance(copy, str):
        copy = MapCopy(copy)
    while True:
        since, cursor = copy.request
        try:
            page = yield calls.changes(copy.name, since, cursor, limit, moved=True)
        except ServiceError as error:
            if error.status != GONE or not copy.restart():
                raise
        else:
            if copy.take(page):
                return copy


def _takes_parts(info: Info) -> bool:
    """Return whether the service supports uploads in parts."""
    return "upload_bytes" in info.limits


def _in_parts(
    calls: Calls, name: str, data: bytes, if_match: str | None, create_only: bool, info: Info
) -> Steps[MapSummary]:
    """Send the parts that the service has not received, and complete the upload."""
    digest = hashlib.sha256(data).hexdigest()
    size = min(PART_BYTES, int(info.limits["map_bytes"]))
    seconds = info.limits["upload_seconds"]
    starts = 0
    while True:
        starts += 1
        try:
            uploads = yield calls.uploads(name)
            at = next((each.bytes for each in uploads if each.digest == digest), 0)
            while at < len(data):
                at = yield calls.put_part(name, digest, at, data[at : at + size])
            completed: MapSummary = yield calls.complete_upload(
                name, digest, if_match, create_only, seconds
            )
        except ServiceError as error:
            if error.type not in RESTARTABLE or starts == ROUNDS:
                raise
        else:
            return completed
