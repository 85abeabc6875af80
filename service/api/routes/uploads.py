"""`/maps/{map}/uploads`: map files that are larger than one request may be, in parts."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from placecell_client.maps.map_file import MEDIA_TYPE

from service.api.audit import tell, tell_written
from service.api.body.body import OCTETS
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf, TimingOf, WriterOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.routes.maps import NEW_RESPONSE, put_response
from service.api.schemas.maps import MapOut, PartOut, UploadOut, UploadsResponse
from service.api.state import State
from service.maps.writes.writer import MapWriter, WriteResult

router = APIRouter(tags=["maps"])

Digest = Annotated[
    str,
    Path(
        pattern=r"^[0-9a-f]{64}$",
        description="SHA-256 of the whole map file, 64 hex digits in lower case.",
        examples=["9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"],
    ),
]


@router.get(
    "/maps/{map}/uploads",
    summary="Uploads that are not complete",
    responses=documented(400, 401, 403, 422, 429, 500, 503, 504),
)
async def list_uploads(
    name: Name, request: Request, state: StateOf, holder: HolderOf
) -> UploadsResponse:
    """Those of this key for this map, and how much of each was received."""
    holder.check_write(name)
    async with state.lanes.reads.enter(request):
        found = await state.run(state.engine.partial_uploads.of, holder.name, name)
    uploads = [UploadOut(digest=each.digest, bytes=each.bytes, time=each.time) for each in found]
    return UploadsResponse(map=name, uploads=uploads)


@router.put(
    "/maps/{map}/uploads/{digest}",
    summary="Upload a part of a map file",
    responses=documented(
        *(400, 401, 403, 408, 409, 413, 415, 422, 429, 500, 503, 504, 507),
    ),
    openapi_extra=file_body(OCTETS),
)
async def put_part(
    name: Name,
    digest: Digest,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    timing: TimingOf,
    offset: Annotated[
        int, Query(ge=0, le=1 << 53, description="Where in the file the part begins.")
    ],
) -> PartOut:
    """For a file larger than `limits.map_bytes`, up to `limits.upload_bytes`.

    Parts come in order, each of at most `limits.map_bytes`. A part that was received may be sent
    again. When the answer comes, the part is on disk; the map is unchanged until the upload is
    completed with `POST`. A day after its last part an upload is removed.
    """
    holder.check_write(name)
    async with state.lanes.uploads.admit(request, (OCTETS, MEDIA_TYPE), timing) as body:
        add = state.engine.partial_uploads.add
        received = await state.run(add, holder.name, name, digest, offset, body.content)
    return PartOut(digest=digest, bytes=received)


@router.post(
    "/maps/{map}/uploads/{digest}",
    summary="Store a map that was uploaded in parts",
    response_model=MapOut,
    responses=NEW_RESPONSE
    | documented(
        *(400, 401, 403, 404, 409, 412, 422, 428, 429, 500, 503, 504, 507),
    ),
)
async def complete_upload(
    name: Name,
    digest: Digest,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
) -> Response:
    """Do what `PUT /maps/{map}` does with the whole file, under the same conditions.

    The map is written whole or not at all. If it is refused, the parts stay, and the upload can be
    completed later; what is no map file is removed.
    """
    holder.check_write(name)
    async with state.lanes.uploads.enter(request):
        written = await state.run(_completed, state, writer, name, digest)
        timing.lap("commit")
        tell_written(request, state, "put", written)
        return await put_response(state, holder, written)


@router.delete(
    "/maps/{map}/uploads/{digest}",
    summary="Remove an upload that is not complete",
    status_code=204,
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504),
)
async def delete_upload(
    name: Name, digest: Digest, request: Request, state: StateOf, holder: HolderOf
) -> None:
    """The parts that were received are removed; the map is unchanged."""
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        await state.run(state.engine.partial_uploads.remove, holder.name, name, digest)
    tell(request, state, "delete upload", name, f"upload {digest[:16]}")


def _completed(state: State, writer: MapWriter, name: str, digest: str) -> WriteResult:
    """Write an upload to its map."""
    with state.engine.partial_uploads.whole(writer.holder.name, name, digest) as content:
        return writer.put(name, content)
