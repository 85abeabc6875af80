"""Routes of `/maps/{map}/versions`: list, restore and compact the versions of a map."""

from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request, Response
from placecell_client import decode_delta, encode_delta
from placecell_client.maps.delta_file import MEDIA_TYPE

from service.api.admission.admission import client_of
from service.api.admission.byte_range import asked_range
from service.api.body.body import JSON, render
from service.api.body.problem_json import documented
from service.api.dependencies import ConditionsOf, MapWriteOf, PrincipalOf, StateOf
from service.api.path_parameters import Name
from service.api.responses import outcome_of, version_of
from service.api.schemas.maps import CompactOut, VersionsResponse, WrittenOut
from service.api.state import State
from service.core.auth import Principal
from service.maps.history import commits_of, version_changes, version_tag
from service.maps.snapshot import MapSnapshot
from service.maps.visibility import hide_names_in_delta

router = APIRouter(tags=["versions"])

Version = Annotated[
    int, Path(ge=1, le=1 << 53, description="Sequence of the version.", examples=[1])
]
_CHANGES_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The delta file.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    },
    304: {"description": "The client already has these changes."},
}


@router.get(
    "/maps/{map}/versions",
    summary="List the versions of a map",
    response_model=VersionsResponse,
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504),
)
async def list_versions(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    limit: Annotated[
        int, Query(ge=1, le=10_000, description="Largest number of versions in the answer.")
    ] = 100,
) -> Response:
    """Return the versions, newest first: author, time, operation, and number of changes."""
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        content = await state.run(_listed, state, principal, snapshot, limit)
    return await state.answers.respond(content, client_of(request), JSON)


@router.get(
    "/maps/{map}/versions/{version}/changes",
    summary="Download the changes of one version",
    response_class=Response,
    responses=_CHANGES_RESPONSE | documented(400, 401, 403, 404, 410, 416, 422, 429, 500, 503, 504),
)
async def version_delta(
    name: Name,
    version: Version,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    conditions: ConditionsOf,
) -> Response:
    """Return the delta file from the version before this one to this one; it never changes.

    The first version of a map has all its segments. 410: the version was compacted, or is the
    oldest that is left. `Range` works as for `GET /maps/{map}`.
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    store = state.engine.maps.store
    async with state.lanes.reads.enter(request):
        tag = await state.run(version_tag, store, snapshot, version)
        if conditions.is_known(tag):
            return Response(status_code=304, headers={"ETag": f'"{tag}"'})

        def make() -> bytes:
            file = version_changes(store, snapshot, version)
            if principal.covers_all:
                return file
            uid = snapshot.head.uid
            return encode_delta(hide_names_in_delta(principal, uid, decode_delta(file)))

        seen_by = "" if principal.covers_all else " ".join(principal.key.maps)
        return await state.answers.respond_shared(
            f"changes {snapshot.head.uid} {tag} {seen_by}",
            make,
            state.run,
            client_of(request),
            MEDIA_TYPE,
            {"ETag": f'"{tag}"', "Accept-Ranges": "bytes"},
            asked_range(request, tag),
        )


@router.post(
    "/maps/{map}/versions/{version}/restore",
    summary="Restore a version",
    responses=documented(400, 401, 403, 404, 409, 410, 412, 422, 429, 500, 503, 504, 507),
)
async def restore_version(
    write: MapWriteOf,
    version: Version,
    response: Response,
    dry_run: Annotated[
        bool, Query(description="Only count the segments that would change.")
    ] = False,
) -> WrittenOut:
    """Write the content of an earlier version as a new version; a restore can be undone too.

    With `dry_run`, `changed` and `removed` count the segments that a restore would add or replace,
    and remove.
    """
    async with write.enter(write.state.lanes.edits):
        restore = write.writer.restore
        if dry_run:
            result = await write.run(restore, write.name, version, dry_run=True)
        else:
            result = await write.commit("restore", restore, write.name, version)
    response.headers["ETag"] = f'"{result.snapshot.tag}"'
    return outcome_of(result)


@router.post(
    "/maps/{map}/compact",
    summary="Drop old versions",
    responses=documented(400, 401, 403, 404, 409, 422, 429, 500, 503, 504, 507),
)
async def compact_map(
    write: MapWriteOf,
    keep: Annotated[
        int, Query(ge=1, le=1 << 53, description="Number of newest versions to keep.")
    ] = 1,
) -> CompactOut:
    """Drop old versions and free their disk space.

    The service also drops the oldest versions of a long history by itself.
    """
    async with write.enter(write.state.lanes.edits):
        snapshot = await write.run(write.writer.compact, write.name, keep)
    head = snapshot.head
    write.record("compact", f"versions from {head.oldest} on are kept")
    return CompactOut(oldest=head.oldest, sequence=head.sequence, bytes=head.bytes)


def _listed(state: State, principal: Principal, snapshot: MapSnapshot, limit: int) -> bytes:
    commits = commits_of(state.engine.maps.store, snapshot)
    response = VersionsResponse(
        map=snapshot.name,
        oldest=commits[0].sequence,
        versions=[version_of(commit, principal) for commit in commits[: -limit - 1 : -1]],
    )
    return render(response, JSON)
