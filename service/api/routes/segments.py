"""`/maps/{map}/segments` and what robots need to share a map: ids of their own, and changes."""

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from placecell_client import encode_delta
from placecell_client.maps.delta_file import MEDIA_TYPE

from service.api.admission.admission import client_of
from service.api.audit import tell, tell_written
from service.api.body.body import OCTETS
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf, TimingOf, WriterOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.responses import outcome_of
from service.api.schemas.maps import IdsOut, WrittenOut
from service.api.state import State
from service.core.auth import Holder
from service.maps.snapshot import MapSnapshot
from service.maps.sync import SyncPage
from service.maps.visibility import delta_for

router = APIRouter(tags=["sharing"])

_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": WrittenOut, "description": "There was no such map, and now there is."}
}
_DELTA_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "A delta file, of a part of what changed.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "headers": {
            "Placecell-Since": {"schema": {"type": "integer"}, "description": "Where it begins."},
            "Placecell-Until": {"schema": {"type": "integer"}, "description": "Where it leads."},
            "Placecell-Next": {
                "schema": {"type": "string"},
                "description": "Cursor of the next part; not there: this is the last.",
            },
        },
    },
}


@router.post(
    "/maps/{map}/segments",
    summary="Add, replace and remove segments",
    response_model=WrittenOut,
    responses=_NEW_RESPONSE
    | documented(
        *(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507),
    ),
    openapi_extra=file_body(MEDIA_TYPE, OCTETS),
)
async def edit_segments(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
    robot: Annotated[
        str | None,
        Query(
            max_length=200,
            description="Whose segments are removed; those of the key's robot and of the robots of "
            "the changed segments may be anyway.",
        ),
    ] = None,
    create: Annotated[bool, Query(description="Make the map if there is none.")] = False,
    deduplicate: Annotated[
        bool,
        Query(
            description="Do not store a segment again that was seen before: where one is within "
            "half a metre and looks the same, or there are enough views of it, only note when it "
            "was last seen (`seen`). Other views of it are stored, and share its `views`."
        ),
    ] = False,
    only_new: Annotated[
        bool,
        Query(
            description="Refuse to replace any segment (409), for a robot whose ids are all new. "
            "Segments that the map already holds unchanged do not count."
        ),
    ] = False,
) -> Response:
    """Add, replace and remove segments, all or none; the answer confirms that they are on disk.

    The body is a delta file whose `since` and `until` are 0. Sending it again changes nothing. An
    edit that replaces or removes another robot's segment, or uses an id that another key wrote or
    reserved, is refused with a 409 that lists the ids. To confirm such an edit, send
    `If-Match: "ETAG"`. A key without administration rights writes new ids up to 1,048,576 above
    the highest id in use; it must reserve higher ids.
    """
    holder.check_write(name)
    async with state.lanes.edits.admit(request, (MEDIA_TYPE, OCTETS), timing) as body:
        written = await state.run(
            writer.edit, name, body.content, robot, create, deduplicate, only_new
        )
    timing.lap("commit")
    tell_written(request, state, "edit", written)
    return JSONResponse(
        outcome_of(written).model_dump(mode="json"),
        status_code=201 if written.is_new else 200,
        headers={"ETag": f'"{written.stored.tag}"'},
    )


@router.post(
    "/maps/{map}/age",
    summary="Remove segments that were not seen again",
    responses=documented(400, 401, 403, 404, 412, 422, 429, 500, 503, 504, 507),
)
async def age_segments(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
    unseen_since: Annotated[
        float,
        Query(
            allow_inf_nan=False,
            description="Seconds, of the clock of the frames: what was seen then or later stays. "
            "That is its `seen`, or its frame's time.",
        ),
    ],
    dry_run: Annotated[bool, Query(description="Only tell how many they are.")] = False,
) -> WrittenOut:
    """A version of its own, that can be undone as any other."""
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        written = await state.run(writer.prune, name, unseen_since, dry_run)
    timing.lap("commit")
    if not dry_run:
        tell_written(request, state, "age", written)
    return outcome_of(written)


@router.post(
    "/maps/{map}/ids",
    summary="Ids for new segments",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504, 507),
)
async def reserve_ids(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    count: Annotated[int, Query(ge=1, le=1_000_000, description="How many.")],
) -> IdsOut:
    """Reserve ids that no segment of the map ever had; no other key is given them.

    A key may hold at most `limits.reserved_ids` ids of a map that it reserved within the last week
    and has not written.
    """
    holder.check_write(name)
    most = state.settings.limits.reserved_ids
    async with state.lanes.edits.enter(request):
        first = await state.run(writer.reserve, name, count, most)
    tell(request, state, "ids", name, f"{count} ids from {first} on")
    return IdsOut(first=first, count=count)


@router.post(
    "/maps/{map}/ids/reset",
    summary="Make unused ids free again",
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504, 507),
)
async def reset_ids(
    name: Name, request: Request, state: StateOf, holder: HolderOf, writer: WriterOf
) -> IdsOut:
    """Free the ids that no kept version of the map has; for administrators.

    The answer contains the first free id and the number of free ids from there on. Reservations
    are deleted: robots that still hold reserved ids may then write ids that are given to others.
    To free the ids of removed segments, compact the map first.
    """
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        head = await state.run(writer.reset_ids, name)
    count = head.end_id - head.next_id
    tell(request, state, "ids reset", name, f"{count} ids from {head.next_id} on are free")
    return IdsOut(first=head.next_id, count=count)


@router.get(
    "/maps/{map}/changes",
    summary="What changed since a version",
    response_class=Response,
    responses=_DELTA_RESPONSE | documented(400, 401, 403, 404, 410, 422, 429, 500, 503, 504),
)
async def changes(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    since: Annotated[
        str,
        Query(
            max_length=40,
            description="The version that you have: its ETag, without quotes, or its sequence; "
            "0: none, send all.",
            examples=["0"],
        ),
    ] = "0",
    cursor: Annotated[
        str | None,
        Query(max_length=100, description="Of the next part, from `Placecell-Next`."),
    ] = None,
    limit: Annotated[
        int, Query(ge=1, le=100_000, description="Segments in a part, at most.")
    ] = 20_000,
) -> Response:
    """As a delta file, or several: parts that lead to the version that was newest at the first.

    Apply them when you have them all; so you see the map whole. Where a link is cut, go on at the
    cursor that you have. A 410 says that the way from your version is not known any more: begin
    with `since=0`.
    """
    holder.check_map(name)
    stored = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        page, content = await state.run(_page, state, holder, stored, since, cursor, limit)
    headers = {
        "ETag": f'"{page.tag}"',
        "Placecell-Since": str(page.delta.since),
        "Placecell-Until": str(page.delta.until),
    }
    if page.next is not None:
        headers["Placecell-Next"] = page.next
    return await state.answers.respond(content, client_of(request), MEDIA_TYPE, headers)


def _page(
    state: State, holder: Holder, stored: MapSnapshot, since: str, cursor: str | None, limit: int
) -> tuple[SyncPage, bytes]:
    """A page, and its file."""
    if cursor is None:
        page = state.engine.sync.first_page(stored, since, limit)
    else:
        page = state.engine.sync.next_page(stored, cursor, limit)
    return page, encode_delta(delta_for(holder, stored.head.uid, page.delta))
