"""A line for each write: who, what, to which map, how many segments."""

import logging

from fastapi import Request

from service.api.state import State
from service.maps.writes.writer import WriteResult

logger = logging.getLogger("placecell.audit")


def tell_written(request: Request, state: State, operation: str, written: WriteResult) -> None:
    """Of a write to a map's segments."""
    what = f"{written.changed} segments changed, {written.removed} removed"
    tell(request, state, operation, written.stored.name, what, written.changed + written.removed)


def tell(
    request: Request, state: State, operation: str, name: str, what: str, segments: int = 0
) -> None:
    """Of any write.

    Args:
        request: that asked for it.
        state: of the service.
        operation: such as `put`.
        name: of the map.
        what: the operation did.
        segments: that were changed or removed.
    """
    facts = request.scope["state"]
    state.metrics.writes.labels(operation).inc()
    logger.info(
        "%s %s map %s, %s",
        *(facts["key"], operation, name, what),
        extra={
            "key": facts["key"],
            "operation": operation,
            "map": name,
            "segments": segments,
            "request_id": facts["request_id"],
        },
    )
