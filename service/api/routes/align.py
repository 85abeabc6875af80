"""Routes of `/maps/{map}/align/{other}` and `/maps/{map}/merge`: align and merge maps."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from fastapi.responses import JSONResponse
from pydantic import ValidationError

from placecell.localization import LocalizationParameters
from placecell.map_alignment import AlignmentParameters
from service.api.alignment_responses import alignment_of, merged_of
from service.api.body.body import JSON
from service.api.body.problem_json import documented
from service.api.dependencies import MapWriteOf, PrincipalOf, StateOf, TimingOf
from service.api.openapi import json_body
from service.api.path_parameters import Name, OtherName
from service.api.schemas.alignment import AlignmentOut, MergedOut, MergeRequest
from service.api.state import State
from service.core.auth import Principal
from service.core.problems import invalid, invalid_value
from service.engine import ALIGN_SMALLER, MERGE_FEWER

router = APIRouter(tags=["sharing"])

_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": MergedOut, "description": "The merged map is new."}
}

Motion = Annotated[
    Literal["yaw", "se3"],
    Query(
        description="Degrees of freedom of the transform: `yaw` (yaw and translation, for level "
        "frames) or `se3` (all six)."
    ),
]


@router.post(
    "/maps/{map}/align/{other}",
    summary="Align another map with this one",
    responses=documented(400, 401, 403, 404, 408, 409, 413, 415, 422, 429, 500, 503, 504),
)
async def align(
    name: Name,
    other: OtherName,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    timing: TimingOf,
    motion: Motion = "yaw",
    pairs: Annotated[
        bool, Query(description="Also return the pairs of segments that agree.")
    ] = False,
) -> AlignmentOut:
    """Return the transform from the other map's frame into this one's, or why there is none.

    The service uses descriptors and centroids only. It localizes parts of the other map in this
    one. If many parts agree on a transform, it checks the transform against all segments that both
    robots should have seen. Nothing is written.
    """
    for each in (name, other):
        principal.check_map(each)
    async with state.lanes.alignments.admit(request, (JSON,), timing) as body:
        if body.content:  # merge takes options in its body; here they would be ignored
            detail = "Align takes its options in the query (?motion=se3), not in a body."
            raise invalid_value("", detail)
        state.engine.check_alignments([name, other], ALIGN_SMALLER)
        answer = await state.run(_aligned, state, name, other, motion, pairs)
    timing.lap("verify")
    return answer


def _aligned(
    state: State, name: str, other: str, motion: Literal["yaw", "se3"], pairs: bool
) -> AlignmentOut:
    aligned = state.engine.align(name, other, _parameters(motion))
    ids = (aligned.a.content.ids, aligned.b.content.ids) if pairs else None
    return alignment_of(aligned.found, aligned.a.snapshot, aligned.b.snapshot, ids)


def _parameters(motion: Literal["yaw", "se3"]) -> AlignmentParameters:
    return AlignmentParameters(local=LocalizationParameters(model=motion))


@router.post(
    "/maps/{map}/merge",
    summary="Merge maps",
    response_model=MergedOut,
    responses=_NEW_RESPONSE
    | documented(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 501, 503, 504, 507),
    openapi_extra=json_body(MergeRequest),
)
async def merge(write: MapWriteOf) -> JSONResponse:
    """Align stored maps and merge their segments into this map, the merged map.

    The service aligns every pair of maps and rejects alignments that do not close a loop. It leaves
    out maps that it cannot align with the merged map. Each segment keeps its robot and its time,
    and the name of the map and the id that it comes from. The merge is written as one version:
    `dry_run` returns what it would change, and restoring the version before undoes it. A map that
    has grown can be merged again. With `deduplicate`, the captures of the maps also confirm older
    segments or miss them, if the maps state `extents`.
    """
    state = write.state
    async with write.receive(state.lanes.alignments, (JSON,)) as body:
        asked = await state.run(_read, body, write.name, state, write.principal)
        # Before the work waits for a thread: the deadline may pass there.
        for each in asked.maps:
            state.engine.maps.named(each)
        state.engine.check_alignments([write.name, *asked.maps], MERGE_FEWER)
        merged = await write.run(
            state.engine.merge_maps,
            write.name,
            asked.maps,
            parameters=_parameters(asked.motion),
            deduplicate=asked.deduplicate,
            dry_run=asked.dry_run,
            rigid=asked.rigid,
            principal=write.principal,
            conditions=write.writer.conditions,
        )
    if merged.written is not None:
        write.record_result("merge", merged.written)
    answer = merged_of(merged, write.name, asked.maps)
    return JSONResponse(
        answer.model_dump(mode="json"),
        status_code=201 if merged.written is not None and merged.written.is_new else 200,
        headers={"ETag": f'"{answer.etag}"'} if answer.etag is not None else None,
    )


def _read(content: bytes, name: str, state: State, principal: Principal) -> MergeRequest:
    """Parse a merge request and check that it can be carried out."""
    try:
        asked = MergeRequest.model_validate_json(content)
    except ValidationError as error:
        raise invalid(error) from error
    most = state.settings.limits.merged_maps
    if len(asked.maps) > most:
        raise invalid_value(
            "/maps", f"The request names {len(asked.maps)} maps; the limit is {most}."
        )
    for index, each in enumerate(asked.maps):
        if each == name:
            raise invalid_value(
                f"/maps/{index}", f"{each!r} is the merged map itself. Name the other maps only."
            )
        if each in asked.maps[:index]:
            raise invalid_value(f"/maps/{index}", f"{each!r} is named twice. Name each map once.")
        principal.check_map(each)
    if len(asked.maps) < 2 and state.engine.maps.entry(name) is None:
        raise invalid_value(
            "/maps", f"Map {name!r} does not exist yet; a new merged map needs two maps or more."
        )
    return asked
