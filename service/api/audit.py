"""Audit log: one line per write, with key, operation, map and number of segments."""

import logging

from fastapi import Request

from service.api.state import State
from service.maps.writes.writer import WriteResult

logger = logging.getLogger("placecell.audit")


def tell_written(request: Request, state: State, operation: str, written: WriteResult) -> None:
    """Log and count a write of a map's segments."""
    what = f"{written.changed} segments changed, {written.removed} removed"
    tell(request, state, operation, written.stored.name, what, written.changed + written.removed)


def tell(
    request: Request, state: State, operation: str, name: str, what: str, segments: int = 0
) -> None:
    """Log and count a write.

    Args:
        request: request of the write.
        state: state of the service.
        operation: operation, such as `put`.
        name: name of the map.
        what: result of the operation in words.
        segments: number of segments that were changed or removed.
    """
    facts = request.scope["state"]
    state.metrics.writes.labels(operation).inc()
    logger.info(
        "%s %s map %s, %s",
        facts["key"],
        operation,
        name,
        what,
        extra={
            "key": facts["key"],
            "operation": operation,
            "map": name,
            "segments": segments,
            "request_id": facts["request_id"],
        },
    )
