"""Routes of `/maps/{map}/versions`: list, restore and compact the versions of a map."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response

from service.api.admission.admission import client_of
from service.api.body.body import JSON, render
from service.api.body.problem_json import documented
from service.api.dependencies import MapWriteOf, PrincipalOf, StateOf
from service.api.path_parameters import Name
from service.api.responses import outcome_of, version_of
from service.api.schemas.maps import CompactOut, VersionsResponse, WrittenOut
from service.api.state import State
from service.core.auth import Principal
from service.maps.history import commits_of
from service.maps.snapshot import MapSnapshot

router = APIRouter(tags=["versions"])


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


@router.post(
    "/maps/{map}/versions/{version}/restore",
    summary="Restore a version",
    responses=documented(400, 401, 403, 404, 410, 412, 422, 429, 500, 503, 504, 507),
)
async def restore_version(
    write: MapWriteOf,
    version: Annotated[
        int, Path(ge=1, le=1 << 53, description="Sequence of the version.", examples=[1])
    ],
    response: Response,
) -> WrittenOut:
    """Write the content of an earlier version as a new version; a restore can be undone too."""
    async with write.enter(write.state.lanes.edits):
        result = await write.commit("restore", write.writer.restore, write.name, version)
    response.headers["ETag"] = f'"{result.snapshot.tag}"'
    return outcome_of(result)


@router.post(
    "/maps/{map}/compact",
    summary="Drop old versions",
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504, 507),
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
