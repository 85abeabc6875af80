"""Routes of `/maps`: list, upload, download and delete maps."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from placecell_client import encode
from placecell_client.maps.map_file import MEDIA_TYPE

from placecell.core.segment_classes import ClassFilter
from service.api.admission.admission import client_of
from service.api.admission.byte_range import asked_range
from service.api.body.body import JSON, OCTETS, prefers, render
from service.api.body.problem_json import documented
from service.api.dependencies import ConditionsOf, MapWrite, MapWriteOf, PrincipalOf, StateOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.query_parsing import WantedClasses
from service.api.responses import detail_of, summary_of
from service.api.schemas.maps import MapDetailOut, MapOut, MapsResponse
from service.api.state import State
from service.core.auth import Principal
from service.maps.history import load_version, version_file, version_tag
from service.maps.layers import of_wanted
from service.maps.snapshot import MapSnapshot
from service.maps.visibility import hide_names, is_hidden_from
from service.maps.writes.writer import WriteResult

router = APIRouter(tags=["maps"])

NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": MapOut, "description": "The map is new."}
}
_FILE_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "model": MapDetailOut,
        "description": "The map file; facts about the map as JSON.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    },
    206: {
        "description": "The part of the map file that `Range` asks for.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "headers": {
            "Content-Range": {
                "schema": {"type": "string"},
                "description": "First and last byte of the part, and the size of the file.",
            }
        },
    },
    304: {"description": "The client already has this version."},
}


@router.get(
    "/maps",
    summary="List the maps",
    response_model=MapsResponse,
    responses=documented(400, 401, 429, 503, 504),
)
async def list_maps(request: Request, state: StateOf, principal: PrincipalOf) -> Response:
    """Return the maps in the scope of the key, by name.

    Maps of models that are not loaded are listed, but not searched.
    """
    async with state.lanes.reads.enter(request):
        content = await state.run(_listed, state, principal)
    return await state.answers.respond(content, client_of(request), JSON)


@router.put(
    "/maps/{map}",
    summary="Store a map",
    response_model=MapOut,
    responses=NEW_RESPONSE
    | documented(400, 401, 403, 408, 409, 412, 413, 415, 422, 428, 429, 500, 503, 504, 507),
    openapi_extra=file_body(MEDIA_TYPE, OCTETS),
)
async def put_map(write: MapWriteOf) -> Response:
    """Store the whole map file or nothing; a 2xx answer means that it survives a power failure.

    A file that is equal to the stored map changes nothing. To replace other content, state which
    version to replace: `If-Match: "ETAG"`, or `*` for any version. `If-None-Match: *` creates new
    maps only.
    """
    async with write.receive(write.state.lanes.uploads, (MEDIA_TYPE, OCTETS)) as file:
        result = await write.commit("put", write.writer.put, write.name, file)
        return await put_response(write, result)


@router.get(
    "/maps/{map}",
    summary="Download a map",
    response_class=Response,
    responses=_FILE_RESPONSE | documented(400, 401, 403, 404, 410, 416, 422, 429, 500, 503, 504),
)
async def get_map(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    conditions: ConditionsOf,
    wanted: WantedClasses,
    version: Annotated[
        int | None,
        Query(ge=1, le=1 << 53, description="Sequence of a version. Default: the newest version."),
    ] = None,
) -> Response:
    """Return the map in canonical form: equal maps are equal files, byte by byte.

    With `Accept: application/json`, return facts about the newest version: those of `GET /maps`,
    how far its own
    segments calibrate its match probabilities, and its place on the Earth.

    `Range: bytes=FIRST-LAST` asks for a part of the file (206). So a broken download continues
    (with `If-Range: "ETAG"`), and a client reads single columns of a large map. If several ranges
    are asked for, the answer is the whole file.

    `classes` and `ignore` leave out segments by their class. Such a file has an ETag of its own,
    with which it cannot replace the map by mistake.

    If a source map of the segments is outside the scope of the key, a pseudonym replaces its name.
    Writing the file to this map restores the name.
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    client = client_of(request)
    if version is None and wanted is None and prefers(request, JSON, MEDIA_TYPE):
        async with state.lanes.reads.enter(request):
            content = await state.run(_detail, state, principal, snapshot)
        return await state.answers.respond(content, client, JSON, {"Vary": "Accept"})
    if version is None and wanted is None and conditions.is_known(snapshot.tag):
        return Response(status_code=304, headers={"ETag": f'"{snapshot.tag}"'})
    sequence = snapshot.head.sequence if version is None else version
    async with state.lanes.reads.enter(request):
        tag = await state.run(version_tag, state.engine.maps.store, snapshot, sequence)
        tag += "" if wanted is None else f"-{wanted.label}"
        if conditions.is_known(tag):
            return Response(status_code=304, headers={"ETag": f'"{tag}"'})
        file_name, make = _file(state, principal, snapshot, sequence, tag, wanted)
        return await state.answers.respond_shared(
            file_name,
            make,
            state.run,
            client,
            MEDIA_TYPE,
            {"ETag": f'"{tag}"', "Accept-Ranges": "bytes"},
            asked_range(request, tag),
        )


@router.delete(
    "/maps/{map}",
    summary="Delete a map",
    status_code=204,
    responses=documented(400, 401, 403, 404, 409, 412, 422, 429, 500, 503, 504, 507),
)
async def delete_map(write: MapWriteOf) -> None:
    """Delete the map with all its versions; a 2xx answer means that it is gone from the disk."""
    async with write.enter(write.state.lanes.edits):
        segments = await write.run(write.writer.delete, write.name)
    write.record("delete", f"{segments} segments", segments)


async def put_response(write: MapWrite, result: WriteResult) -> Response:
    """Return the answer to a map that was stored whole."""
    snapshot = result.snapshot
    summary = await write.state.run(
        summary_of, snapshot, write.principal, write.state.engine.annotations.tags(snapshot)
    )
    return JSONResponse(
        summary.model_dump(mode="json"),
        status_code=201 if result.is_new else 200,
        headers={
            "ETag": f'"{snapshot.tag}"',
            "Location": f"{write.state.settings.root_path}/maps/{snapshot.name}",
        },
    )


def _detail(state: State, principal: Principal, snapshot: MapSnapshot) -> bytes:
    site = state.engine.calibration(snapshot)
    model = state.engine.models.find(snapshot.model_id)
    return render(
        detail_of(
            snapshot,
            principal,
            site,
            state.engine.annotations.of(snapshot),
            shapes=model is not None and model.has_shapes,
        ),
        JSON,
    )


def _file(
    state: State,
    principal: Principal,
    snapshot: MapSnapshot,
    sequence: int,
    tag: str,
    wanted: ClassFilter | None,
) -> tuple[str, Callable[[], bytes]]:
    """Return a name for a version's file and its maker; keys that see the same share the name."""
    store, uid = state.engine.maps.store, snapshot.head.uid
    name = f"{uid} {tag}"
    newest = sequence == snapshot.head.sequence
    sees_all = principal.covers_all or (newest and not is_hidden_from(principal, snapshot.layers))
    if sees_all and wanted is None:
        return name, lambda: version_file(store, snapshot, sequence)[0]

    def make() -> bytes:
        layers, _ = load_version(store, snapshot, sequence)
        content = layers.content()
        if not sees_all:
            content = hide_names(principal, uid, content)
        return encode(of_wanted(content, wanted))

    return name if sees_all else f"{name} {' '.join(principal.key.maps)}", make


def _listed(state: State, principal: Principal) -> bytes:
    response = MapsResponse(
        model_id=state.model_id,
        maps=[
            summary_of(each, principal, state.engine.annotations.tags(each))
            for each in state.engine.maps.entries()
            if principal.covers(each.name)
        ],
        damaged=[name for name in state.engine.maps.damaged() if principal.covers(name)],
    )
    return render(response, JSON)
