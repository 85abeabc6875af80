"""How a map is stored whole: in one request, or in parts where it is larger than one may be.

The steps are generators of calls: they take each call's result, or its ServiceError. Nothing here
sends.
"""

import hashlib
from collections.abc import Generator
from typing import Any, TypeAlias

from placecell_client.http.errors import ServiceError
from placecell_client.http.requests import Call, Calls
from placecell_client.maps.map_file import CompactMap, encode
from placecell_client.results.core import Info, MapSummary

Steps: TypeAlias = Generator[Call[Any], Any, MapSummary]

PART_BYTES = 4 << 20
"""Size of a part of an uploaded file, bytes; a slow link sends a part within the call's time."""

ASK_BYTES = 8 << 20
"""Before a larger file is sent, the service is asked whether it takes it in one request."""

ROUNDS = 2
"""How often an upload is begun, at most: another client may complete or remove it meanwhile."""

TOO_LARGE = "urn:placecell:problem:body-too-large"
BEGIN_ANEW = frozenset(
    f"urn:placecell:problem:{kind}" for kind in ("unknown-upload", "upload-damaged", "wrong-offset")
)


def put_map(
    calls: Calls,
    name: str,
    compact_map: CompactMap | bytes,
    if_match: str | None,
    create_only: bool,
) -> Steps:
    """Store a map, in parts if the service takes no such file in one request.

    Args:
        calls: makes the calls.
        name: of the map.
        compact_map: the map, or its file.
        if_match: ETag of the version to replace, or `*` for any.
        create_only: replace none.
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


def _takes_parts(info: Info) -> bool:
    """Whether the service is of a version that takes uploads in parts."""
    return "upload_bytes" in info.limits


def _in_parts(
    calls: Calls, name: str, data: bytes, if_match: str | None, create_only: bool, info: Info
) -> Steps:
    """Send what the service has not received, and complete the upload."""
    digest = hashlib.sha256(data).hexdigest()
    size = min(PART_BYTES, int(info.limits["map_bytes"]))
    seconds = info.limits["upload_seconds"]
    began = 0
    while True:
        began += 1
        try:
            uploads = yield calls.uploads(name)
            at = next((each.bytes for each in uploads if each.digest == digest), 0)
            while at < len(data):
                at = yield calls.put_part(name, digest, at, data[at : at + size])
            completed: MapSummary = yield calls.complete_upload(
                name, digest, if_match, create_only, seconds
            )
        except ServiceError as error:
            if error.type not in BEGIN_ANEW or began == ROUNDS:
                raise
        else:
            return completed
