"""Routes of `/maps/{map}/mirror`: marks of read-only copies of other services' maps."""

from fastapi import APIRouter

from service.annotations.writer import AnnotationWriter
from service.api.body.body import JSON, read_json_body
from service.api.body.problem_json import documented
from service.api.dependencies import MapWrite, MapWriteOf
from service.api.openapi import json_body
from service.api.responses import mirror_of
from service.api.schemas.maps import MirrorIn, MirrorOut

router = APIRouter(tags=["maps"])


@router.put(
    "/maps/{map}/mirror",
    summary="Mark a map as a mirror",
    responses=documented(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507),
    openapi_extra=json_body(MirrorIn),
)
async def put_mirror(write: MapWriteOf) -> MirrorOut:
    """Mark an empty map, or a mirror, as a copy of another service's map.

    All writes to a mirror are refused (409 `mirrored-map`), except those with the header
    `Placecell-Mirror` that names its source. `placecell maps mirror` does all this.
    """
    async with write.receive(write.state.lanes.edits, (JSON,)) as body:
        asked = read_json_body(MirrorIn, body)
        writer = _writer(write)
        mark = await write.run(writer.set_mirror, write.name, asked.source, asked.etag)
    write.record("mirror", f"mirror of {mark.source}")
    return mirror_of(mark)


@router.delete(
    "/maps/{map}/mirror",
    summary="End a mirror",
    status_code=204,
    responses=documented(400, 401, 403, 404, 412, 422, 429, 500, 503, 504, 507),
)
async def delete_mirror(write: MapWriteOf) -> None:
    """Make a mirror a map of this service, which takes writes and is no longer updated."""
    write.principal.check_write(write.name)
    async with write.state.lanes.edits.enter(write.request):
        await write.run(_writer(write).remove_mirror, write.name)
    write.record("mirror", "mirror ended")


def _writer(write: MapWrite) -> AnnotationWriter:
    return write.state.engine.annotation_writer(write.principal, write.writer.conditions)
