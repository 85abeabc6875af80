"""`/maps`: the maps that robots put, get and remove."""

import re
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Path, Request, Response
from fastapi.responses import JSONResponse
from placecell_client.map_file import MEDIA_TYPE

from service.account import audit
from service.keys import Holder
from service.map_store import NAME_PATTERN
from service.maps import StoredMap
from service.openapi import file_body
from service.problems import Problem, documented
from service.schemas import MapOut, MapsResponse
from service.state import HolderOf, State, StateOf, TimingOf

OCTETS = "application/octet-stream"

router = APIRouter(tags=["maps"])

NAME_RULE = "1 to 64 letters, digits, dots, dashes, underscores; a letter or digit first"


async def checked_name(
    name: Annotated[
        str,
        Path(
            alias="map",
            description=f"The map's name: {NAME_RULE}.",
            json_schema_extra={"pattern": NAME_PATTERN},
            examples=["yard"],
        ),
    ],
) -> str:
    """The map's name in the path; 422 if none can be named so."""
    if not re.fullmatch(NAME_PATTERN, name):
        raise Problem(422, "invalid-map-name", f"{name!r:.200} is no map's name: {NAME_RULE}.")
    return name


Name = Annotated[str, Depends(checked_name)]

_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": MapOut, "description": "Stored under a new name."}
}
_FILE_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The map file.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    },
    304: {"description": "The client has this file already."},
}


@router.get("/maps", summary="The stored maps", responses=documented(401))
async def list_maps(state: StateOf, holder: HolderOf) -> MapsResponse:
    """By name, those that the key opens. Maps of a model that is not loaded are not searched."""
    stored = [_summary(stored) for stored in state.maps.all() if holder.opens(stored.name)]
    return MapsResponse(model_id=state.model_id, maps=stored)


@router.put(
    "/maps/{map}",
    summary="Store a map",
    response_model=MapOut,
    responses=_NEW_RESPONSE | documented(400, 401, 403, 408, 409, 413, 415, 422, 429, 504, 507),
    openapi_extra=file_body(MEDIA_TYPE, OCTETS),
)
async def put_map(
    name: Name, request: Request, state: StateOf, holder: HolderOf, timing: TimingOf
) -> Response:
    """In place of the one of that name, whole or not at all.

    When the answer comes, the map is on disk and survives a crash. The same file again changes
    nothing.
    """
    holder.check_write(name)
    async with state.uploads.admit(request, (MEDIA_TYPE, OCTETS), timing) as body:
        put = partial(state.maps.put, name, body.content, holder.check_content)
        stored, is_new = await state.compute(put)
    timing.lap("commit")
    _tell(request, state, holder, "put", name, len(stored.content))
    return JSONResponse(
        _summary(stored).model_dump(mode="json"),
        status_code=201 if is_new else 200,
        headers={"ETag": _etag(stored), "Location": f"/maps/{name}"},
    )


@router.get(
    "/maps/{map}",
    summary="A map's file",
    response_class=Response,
    responses=_FILE_RESPONSE | documented(401, 403, 404, 422),
)
async def get_map(
    name: Name,
    state: StateOf,
    holder: HolderOf,
    if_none_match: Annotated[str | None, Header()] = None,
) -> Response:
    """Byte by byte as it was put."""
    holder.check_map(name)
    stored = state.maps.get(name)
    if if_none_match is not None and _names_tag(if_none_match, _etag(stored)):
        return Response(status_code=304, headers={"ETag": _etag(stored)})
    stored, data = await state.compute(state.maps.file, name)
    return Response(data, media_type=MEDIA_TYPE, headers={"ETag": _etag(stored)})


@router.delete(
    "/maps/{map}",
    summary="Remove a map",
    status_code=204,
    responses=documented(401, 403, 404, 422),
)
async def delete_map(
    name: Name, request: Request, state: StateOf, holder: HolderOf, timing: TimingOf
) -> None:
    """When the answer comes, it is gone from the disk."""
    holder.check_write(name)
    segments = await state.compute(state.maps.delete, name, holder.check_content)
    timing.lap("commit")
    _tell(request, state, holder, "delete", name, segments)


def _tell(
    request: Request, state: State, holder: Holder, operation: str, name: str, segments: int
) -> None:
    """The audit: who wrote what."""
    state.metrics.writes.labels(operation).inc()
    audit.info(
        "%s %s map %s, %d segments",
        *(holder.name, operation, name, segments),
        extra={
            "key": holder.name,
            "operation": operation,
            "map": name,
            "segments": segments,
            "request_id": request.scope["state"]["request_id"],
        },
    )


def _summary(stored: StoredMap) -> MapOut:
    return MapOut(
        name=stored.name,
        segments=len(stored.content),
        bytes=stored.bytes,
        model_id=stored.content.model_id,
        robots=list(stored.content.robots),
        time_span=stored.content.time_span,
        etag=stored.etag,
        frame=stored.content.frame,
    )


def _etag(stored: StoredMap) -> str:
    return f'"{stored.etag}"'


def _names_tag(if_none_match: str, etag: str) -> bool:
    """Whether an If-None-Match header names this tag (RFC 9110, weak comparison)."""
    tags = {tag.strip().removeprefix("W/") for tag in if_none_match.split(",")}
    return bool(tags & {"*", etag})
