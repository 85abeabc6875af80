"""Audit log: one line for each write, with key, operation, map and number of segments."""

import logging

from fastapi import Request

from service.api.state import State
from service.live.events import Kind
from service.maps.writes.writer import WriteResult

logger = logging.getLogger("placecell.audit")

KINDS: dict[str, Kind] = {"put": "upload", "merge": "merge"}
"""Kinds of the events of some operations; all others are `write`."""


def record_write(request: Request, state: State, operation: str, result: WriteResult) -> None:
    """Record a write to a map's segments."""
    effect = f"{result.changed} segments changed, {result.removed} removed"
    segments = result.changed + result.removed
    record(request, state, operation, result.snapshot.name, effect, segments)


def record(
    request: Request, state: State, operation: str, name: str, effect: str, segments: int = 0
) -> None:
    """Record a write.

    Args:
        request: the HTTP request.
        state: state of the service.
        operation: name of the operation, such as `put`.
        name: name of the map.
        effect: what the operation did.
        segments: number of segments changed or removed.
    """
    facts = request.scope["state"]
    state.metrics.writes.labels(operation).inc()
    state.engine.events.publish(
        KINDS.get(operation, "write"),
        {"operation": operation, "effect": effect, "segments": segments},
        name,
        facts["key"],
    )
    logger.info(
        "%s %s map %s, %s",
        facts["key"],
        operation,
        name,
        effect,
        extra={
            "key": facts["key"],
            "operation": operation,
            "map": name,
            "segments": segments,
            "request_id": facts["request_id"],
        },
    )
