"""Routes of `/maps/{map}/segments`, `/age`, `/ids` and `/changes`: robots share a map."""

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from placecell_client import encode_delta
from placecell_client.maps.compact_map import TIME_LIMIT
from placecell_client.maps.delta_file import MEDIA_TYPE

from service.api.admission.admission import client_of
from service.api.body.body import OCTETS
from service.api.body.problem_json import documented
from service.api.dependencies import MapWriteOf, PrincipalOf, StateOf
from service.api.openapi import file_body
from service.api.path_parameters import Name
from service.api.responses import outcome_of
from service.api.schemas.maps import IdsOut, WrittenOut
from service.api.state import State
from service.core.auth import Principal
from service.maps.snapshot import MapSnapshot
from service.maps.sync import SyncPage
from service.maps.visibility import hide_names_in_delta
from service.maps.writes.writer import EditOptions

router = APIRouter(tags=["sharing"])

_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": WrittenOut, "description": "The map is new."}
}
_DELTA_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "A delta file with one part of the changes.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "headers": {
            "Placecell-Since": {
                "schema": {"type": "integer"},
                "description": "Sequence of the version at which the changes begin.",
            },
            "Placecell-Until": {
                "schema": {"type": "integer"},
                "description": "Sequence of the version to which the changes lead.",
            },
            "Placecell-Next": {
                "schema": {"type": "string"},
                "description": "Cursor of the next part; absent in the last part.",
            },
        },
    },
}


@router.post(
    "/maps/{map}/segments",
    summary="Add, replace and remove segments",
    response_model=WrittenOut,
    responses=_NEW_RESPONSE
    | documented(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507),
    openapi_extra=file_body(MEDIA_TYPE, OCTETS),
)
async def edit_segments(
    write: MapWriteOf,
    robot: Annotated[
        str | None,
        Query(
            max_length=200,
            description="Robot whose segments may be removed, besides the key's own robot and the "
            "robots of the changed segments.",
        ),
    ] = None,
    create: Annotated[bool, Query(description="Create the map if it does not exist.")] = False,
    deduplicate: Annotated[
        bool,
        Query(
            description="Do not store segments that were seen before. If a stored segment lies "
            "within half a meter and looks the same, or the map has enough views of the object, "
            "the service only updates when it was last seen (`seen`). It stores other views of "
            "the object, which share its `views`."
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
    """Add, replace and remove segments, all or none; a 2xx answer means that they are on disk.

    The body is a delta file whose `since` and `until` are 0. Sending it again changes nothing. An
    edit that replaces or removes another robot's segment, or uses an id that another key wrote or
    reserved, is refused with a 409 that lists the ids. To confirm such an edit, send
    `If-Match: "ETAG"`. A key without administration rights writes new ids up to 1,048,576 above
    the highest id in use; it must reserve higher ids.
    """
    options = EditOptions(robot=robot, create=create, deduplicate=deduplicate, only_new=only_new)
    async with write.receive(write.state.lanes.edits, (MEDIA_TYPE, OCTETS)) as file:
        result = await write.commit("edit", write.writer.edit, write.name, file, options)
    return JSONResponse(
        outcome_of(result).model_dump(mode="json"),
        status_code=201 if result.is_new else 200,
        headers={"ETag": f'"{result.snapshot.tag}"'},
    )


@router.post(
    "/maps/{map}/age",
    summary="Remove segments that were not seen again",
    responses=documented(400, 401, 403, 404, 409, 412, 422, 429, 500, 503, 504, 507),
)
async def prune_segments(
    write: MapWriteOf,
    unseen_since: Annotated[
        float,
        Query(
            allow_inf_nan=False,
            ge=-TIME_LIMIT,
            le=TIME_LIMIT,
            description="Time in seconds of the frames' clock. Segments that were last seen "
            "(`seen`, or the time of their frame) before it are removed.",
        ),
    ],
    dry_run: Annotated[bool, Query(description="Only count the segments.")] = False,
) -> WrittenOut:
    """Remove segments last seen before a time, in a version that can be undone as any other."""
    async with write.enter(write.state.lanes.edits):
        prune = write.writer.prune
        if dry_run:
            return outcome_of(await write.run(prune, write.name, unseen_since, dry_run=True))
        result = await write.commit("age", prune, write.name, unseen_since, dry_run=False)
    return outcome_of(result)


@router.post(
    "/maps/{map}/ids",
    summary="Reserve ids for new segments",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504, 507),
)
async def reserve_ids(
    write: MapWriteOf,
    count: Annotated[int, Query(ge=1, le=1_000_000, description="Number of ids to reserve.")],
) -> IdsOut:
    """Reserve ids that no segment of the map ever had and that no other key can reserve.

    A key may hold at most `limits.reserved_ids` ids of a map that it reserved within the last week
    and has not written.
    """
    most = write.state.settings.limits.reserved_ids
    async with write.enter(write.state.lanes.edits):
        first = await write.run(write.writer.reserve, write.name, count, most)
    write.record("ids", f"{count} ids from {first} on")
    return IdsOut(first=first, count=count)


@router.post(
    "/maps/{map}/ids/reset",
    summary="Free unused ids",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504, 507),
)
async def reset_ids(write: MapWriteOf) -> IdsOut:
    """Free the ids that no kept version of the map has; for administrators.

    The answer contains the first free id and the number of free ids from there on. Reservations
    are deleted: robots that still hold reserved ids may then write ids that are given to others.
    To free the ids of removed segments, compact the map first.
    """
    async with write.enter(write.state.lanes.edits):
        head = await write.run(write.writer.reset_ids, write.name)
    count = head.end_id - head.next_id
    write.record("ids reset", f"{count} ids from {head.next_id} on are free")
    return IdsOut(first=head.next_id, count=count)


@router.get(
    "/maps/{map}/changes",
    summary="Download the changes since a version",
    response_class=Response,
    responses=_DELTA_RESPONSE | documented(400, 401, 403, 404, 410, 422, 429, 500, 503, 504),
)
async def changes(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    since: Annotated[
        str,
        Query(
            max_length=40,
            description="Version that the client has: its ETag without quotes, or its sequence. "
            "0: the client has none and requests a full sync.",
            examples=["0"],
        ),
    ] = "0",
    cursor: Annotated[
        str | None,
        Query(
            max_length=100,
            description="Cursor of the next part, from the header `Placecell-Next`.",
        ),
    ] = None,
    limit: Annotated[
        int, Query(ge=1, le=100_000, description="Largest number of segments in a part.")
    ] = 20_000,
    moved: Annotated[
        bool,
        Query(
            description="Tell captures that moved (columns `moved_...` of the delta file) instead "
            "of all their segments. Readers of earlier releases do not know these columns. A "
            "cursor keeps the choice of the first part."
        ),
    ] = False,
) -> Response:
    """Return the changes as one or more delta files: parts of the way to one newer version.

    Apply the parts when all have arrived. If the connection breaks, continue with the last cursor.
    410 means that the changes since this version are no longer known; request a full sync
    (`since=0`).
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        page, content = await state.run(
            _page, state, principal, snapshot, since, cursor, limit, moved
        )
    headers = {
        "ETag": f'"{page.tag}"',
        "Placecell-Since": str(page.delta.since),
        "Placecell-Until": str(page.delta.until),
    }
    if page.next is not None:
        headers["Placecell-Next"] = page.next
    return await state.answers.respond(content, client_of(request), MEDIA_TYPE, headers)


def _page(
    state: State,
    principal: Principal,
    snapshot: MapSnapshot,
    since: str,
    cursor: str | None,
    limit: int,
    moved: bool,
) -> tuple[SyncPage, bytes]:
    """Return one page of the changes, and its delta file."""
    if cursor is None:
        page = state.engine.sync.first_page(snapshot, since, limit, moved)
    else:
        page = state.engine.sync.next_page(snapshot, cursor, limit)
    return page, encode_delta(hide_names_in_delta(principal, snapshot.head.uid, page.delta))
