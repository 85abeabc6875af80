"""`/maps`: the maps that robots put, get and remove."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from placecell_client import encode
from placecell_client.maps.map_file import MEDIA_TYPE

from service.api.admission.admission import client_of
from service.api.audit import tell, tell_written
from service.api.body.body import JSON, OCTETS, render
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf, TimingOf, WriterOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.responses import summary_of
from service.api.schemas.maps import MapOut, MapsResponse
from service.api.state import State
from service.core.auth import Holder
from service.maps.history import load_version, version_file, version_tag
from service.maps.snapshot import MapSnapshot
from service.maps.visibility import content_for, is_hidden_from
from service.maps.writes.writer import WriteResult

router = APIRouter(tags=["maps"])

NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": MapOut, "description": "Stored under a new name."}
}
_FILE_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The map file.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    },
    304: {"description": "The client has this version already."},
}


@router.get(
    "/maps",
    summary="The stored maps",
    response_model=MapsResponse,
    responses=documented(400, 401, 429, 503, 504),
)
async def list_maps(request: Request, state: StateOf, holder: HolderOf) -> Response:
    """By name, those that the key opens. Maps of a model that is not loaded are not searched."""
    async with state.lanes.reads.enter(request):
        content = await state.run(_listed, state, holder)
    return await state.answers.respond(content, client_of(request), JSON)


@router.put(
    "/maps/{map}",
    summary="Store a map",
    response_model=MapOut,
    responses=NEW_RESPONSE
    | documented(
        *(400, 401, 403, 408, 409, 412, 413, 415, 422, 428, 429, 500, 503, 504, 507),
    ),
    openapi_extra=file_body(MEDIA_TYPE, OCTETS),
)
async def put_map(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
) -> Response:
    """Whole or not at all; when the answer comes, it is on disk and survives a power cut.

    The same content again changes nothing. To replace other content say which version you mean to
    replace: `If-Match: "ETAG"`, or `*` for any. `If-None-Match: *` only makes new maps.
    """
    holder.check_write(name)
    async with state.lanes.uploads.admit(request, (MEDIA_TYPE, OCTETS), timing) as body:
        written = await state.run(writer.put, name, body.content)
        timing.lap("commit")
        tell_written(request, state, "put", written)
        return await put_response(state, holder, written)


@router.get(
    "/maps/{map}",
    summary="A map's file",
    response_class=Response,
    responses=_FILE_RESPONSE | documented(400, 401, 403, 404, 410, 422, 429, 500, 503, 504),
)
async def get_map(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    version: Annotated[
        int | None,
        Query(ge=1, le=1 << 53, description="Sequence of a version; the newest unless said."),
    ] = None,
) -> Response:
    """Return the map in canonical form: equal maps are equal files, byte by byte.

    If the key does not open a source map of the segments, a pseudonym replaces that map's name.
    Writing the file to this map restores the name.
    """
    holder.check_map(name)
    stored = state.engine.maps.get(name)
    if version is None and writer.conditions.is_known(stored.tag):
        return Response(status_code=304, headers={"ETag": f'"{stored.tag}"'})
    sequence = stored.head.sequence if version is None else version
    client = client_of(request)
    async with state.lanes.reads.enter(request):
        tag = await state.run(version_tag, state.engine.maps.store, stored, sequence)
        name, make = _file(state, holder, stored, sequence, tag)
        return await state.answers.respond_shared(
            name,
            make,
            state.run,
            client,
            MEDIA_TYPE,
            {"ETag": f'"{tag}"'},
        )


@router.delete(
    "/maps/{map}",
    summary="Remove a map",
    status_code=204,
    responses=documented(400, 401, 403, 404, 412, 422, 429, 500, 503, 504, 507),
)
async def delete_map(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
) -> None:
    """With all its versions. When the answer comes, it is gone from the disk."""
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        segments = await state.run(writer.delete, name)
    timing.lap("commit")
    tell(request, state, "delete", name, f"{segments} segments", segments)


async def put_response(state: State, holder: Holder, written: WriteResult) -> Response:
    """The answer to a map that was stored whole."""
    summary = await state.run(summary_of, written.stored, holder)
    return JSONResponse(
        summary.model_dump(mode="json"),
        status_code=201 if written.is_new else 200,
        headers={
            "ETag": f'"{written.stored.tag}"',
            "Location": f"{state.settings.root_path}/maps/{written.stored.name}",
        },
    )


def _file(
    state: State, holder: Holder, stored: MapSnapshot, sequence: int, tag: str
) -> tuple[str, Callable[[], bytes]]:
    """Return a name for a version's file, equal for keys that see the same, and its maker."""
    name, store, uid = f"{stored.head.uid} {tag}", state.engine.maps.store, stored.head.uid
    newest = sequence == stored.head.sequence
    if holder.opens_all or (newest and not is_hidden_from(holder, stored.layers)):
        return name, lambda: version_file(store, stored, sequence)[0]

    def made() -> bytes:
        layers, _ = load_version(store, stored, sequence)
        return encode(content_for(holder, uid, layers.content()))

    return f"{name} {' '.join(holder.key.maps)}", made


def _listed(state: State, holder: Holder) -> bytes:
    response = MapsResponse(
        model_id=state.model_id,
        maps=[
            summary_of(stored, holder)
            for stored in state.engine.maps.all()
            if holder.opens(stored.name)
        ],
        damaged=[name for name in state.engine.maps.damaged() if holder.opens(name)],
    )
    return render(response, JSON)
