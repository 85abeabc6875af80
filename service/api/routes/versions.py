"""`/maps/{map}/versions`: what a map was, and back to it."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response

from service.api.admission.admission import client_of
from service.api.audit import tell, tell_written
from service.api.body.body import JSON, render
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf, TimingOf, WriterOf
from service.api.path_parameters import Name
from service.api.responses import outcome_of, version_of
from service.api.schemas.maps import CompactOut, VersionsResponse, WrittenOut
from service.api.state import State
from service.core.auth import Holder
from service.maps.history import commits_of
from service.maps.snapshot import MapSnapshot

router = APIRouter(tags=["versions"])


@router.get(
    "/maps/{map}/versions",
    summary="The versions of a map",
    response_model=VersionsResponse,
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504),
)
async def list_versions(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    limit: Annotated[int, Query(ge=1, le=10_000, description="So many, at most.")] = 100,
) -> Response:
    """The newest first: who made it when, by what, and how much it changed."""
    holder.check_map(name)
    stored = state.engine.maps.get(name)
    async with state.lanes.reads.enter(request):
        content = await state.run(_listed, state, holder, stored, limit)
    return await state.answers.respond(content, client_of(request), JSON)


@router.post(
    "/maps/{map}/versions/{version}/restore",
    summary="Make a map again what it was",
    responses=documented(400, 401, 403, 404, 410, 412, 422, 429, 500, 503, 504, 507),
)
async def restore_version(
    name: Name,
    version: Annotated[int, Path(ge=1, le=1 << 53, description="Its sequence.", examples=[1])],
    request: Request,
    response: Response,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
) -> WrittenOut:
    """A new version with the content of an old one; so this can be undone too."""
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        written = await state.run(writer.restore, name, version)
    timing.lap("commit")
    tell_written(request, state, "restore", written)
    response.headers["ETag"] = f'"{written.stored.tag}"'
    return outcome_of(written)


@router.post(
    "/maps/{map}/compact",
    summary="Let go of old versions",
    responses=documented(400, 401, 403, 404, 422, 429, 500, 503, 504, 507),
)
async def compact_map(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
    keep: Annotated[int, Query(ge=1, le=1 << 53, description="Of the newest, so many.")] = 1,
) -> CompactOut:
    """What they alone hold is given back to the disk. The service does so by itself, in time."""
    holder.check_write(name)
    async with state.lanes.edits.enter(request):
        stored = await state.run(writer.compact, name, keep)
    timing.lap("commit")
    head = stored.head
    tell(request, state, "compact", name, f"versions from {head.oldest} on are kept")
    return CompactOut(oldest=head.oldest, sequence=head.sequence, bytes=head.bytes)


def _listed(state: State, holder: Holder, stored: MapSnapshot, limit: int) -> bytes:
    commits = commits_of(state.engine.maps.store, stored)
    response = VersionsResponse(
        map=stored.name,
        oldest=commits[0].sequence,
        versions=[version_of(commit, holder) for commit in commits[: -limit - 1 : -1]],
    )
    return render(response, JSON)
