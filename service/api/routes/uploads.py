"""Routes of `/maps/{map}/uploads`: upload a map file in parts, if it exceeds one request."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from placecell_client.maps.map_file import MEDIA_TYPE

from service.api.body.body import OCTETS
from service.api.body.problem_json import documented
from service.api.dependencies import MapWriteOf, PrincipalOf, StateOf, UploadWriteOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.routes.maps import NEW_RESPONSE, put_response
from service.api.schemas.maps import MapOut, PartOut, UploadOut, UploadsResponse
from service.maps.writes.partial_uploads import PartialUploads
from service.maps.writes.writer import MapWriter, WriteResult

router = APIRouter(tags=["maps"])

Digest = Annotated[
    str,
    Path(
        pattern=r"^[0-9a-f]{64}$",
        description="SHA-256 of the whole map file, 64 lower-case hex digits.",
        examples=["9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"],
    ),
]


@router.get(
    "/maps/{map}/uploads",
    summary="List incomplete uploads",
    responses=documented(400, 401, 403, 422, 429, 500, 503, 504),
)
async def list_uploads(
    name: Name, request: Request, state: StateOf, principal: PrincipalOf
) -> UploadsResponse:
    """Return this key's incomplete uploads for this map, each with the bytes received."""
    principal.check_write(name)
    async with state.lanes.reads.enter(request):
        found = await state.run(state.engine.partial_uploads.of, principal.name, name)
    uploads = [UploadOut(digest=each.digest, bytes=each.bytes, time=each.time) for each in found]
    return UploadsResponse(map=name, uploads=uploads)


@router.put(
    "/maps/{map}/uploads/{digest}",
    summary="Upload a part of a map file",
    responses=documented(400, 401, 403, 408, 409, 413, 415, 422, 429, 500, 503, 504, 507),
    openapi_extra=file_body(OCTETS),
)
async def put_part(
    write: UploadWriteOf,
    digest: Digest,
    offset: Annotated[
        int, Query(ge=0, le=1 << 53, description="Byte of the file at which the part begins.")
    ],
) -> PartOut:
    """Upload a part of a file larger than `limits.map_bytes`, up to `limits.upload_bytes`.

    Send the parts in order, each of at most `limits.map_bytes`. A part that was received may be
    sent again. A 2xx answer means that the part is on disk; the map is unchanged until `POST`
    completes the upload. The service removes an incomplete upload a day after its last part.
    """
    async with write.receive(write.state.lanes.uploads, (OCTETS, MEDIA_TYPE)) as part:
        add = write.state.engine.partial_uploads.add
        received = await write.state.run(
            add, write.principal.name, write.name, digest, offset, part
        )
    return PartOut(digest=digest, bytes=received)


@router.post(
    "/maps/{map}/uploads/{digest}",
    summary="Complete an upload",
    response_model=MapOut,
    responses=NEW_RESPONSE
    | documented(400, 401, 403, 404, 409, 412, 422, 428, 429, 500, 503, 504, 507),
)
async def complete_upload(write: MapWriteOf, digest: Digest) -> Response:
    """Store the uploaded file as `PUT /maps/{map}` would, under the same preconditions.

    The service writes the whole map or nothing. If it refuses the map, the parts stay and the
    upload can be completed later; a file that is no valid map file is removed.
    """
    async with write.enter(write.state.lanes.uploads):
        uploads = write.state.engine.partial_uploads
        result = await write.commit("put", _completed, uploads, write.writer, write.name, digest)
        return await put_response(write, result)


@router.delete(
    "/maps/{map}/uploads/{digest}",
    summary="Delete an incomplete upload",
    status_code=204,
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504),
)
async def delete_upload(write: UploadWriteOf, digest: Digest) -> None:
    """Delete the received parts; the map is unchanged."""
    async with write.enter(write.state.lanes.edits):
        remove = write.state.engine.partial_uploads.remove
        await write.state.run(remove, write.principal.name, write.name, digest)
    write.record("delete upload", f"upload {digest[:16]}")


def _completed(uploads: PartialUploads, writer: MapWriter, name: str, digest: str) -> WriteResult:
    """Write an upload to its map."""
    with uploads.whole(writer.principal.name, name, digest) as file:
        return writer.put(name, file)
