"""`/maps/{map}/align/{other}` and `/maps/{map}/merge`: how maps lie, and a site of them all."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from fastapi.responses import JSONResponse
from pydantic import ValidationError

from placecell.core.cancellation import current
from placecell.localization import LocalizationParameters
from placecell.map_alignment import AlignmentParameters
from service.api.alignment_responses import alignment_of, merged_of
from service.api.audit import tell_written
from service.api.body.body import JSON
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf, TimingOf, WriterOf
from service.api.openapi import json_body
from service.api.path_parameters import Name, OtherName
from service.api.schemas.alignment import AlignmentOut, MergedOut, MergeRequest
from service.api.state import State
from service.core.auth import Holder
from service.core.cost import check_cost, cost_of_aligning
from service.core.problems import invalid, invalid_value
from service.inference.model_registry import Model
from service.maps.snapshot import MapSnapshot
from service.merging.alignment import K, MapSide, align_maps, check_same_model
from service.merging.merge import Merger

router = APIRouter(tags=["sharing"])

_NEW_RESPONSE: dict[int | str, dict[str, Any]] = {
    201: {"model": MergedOut, "description": "There was no such site, and now there is."}
}

PARAMETERS = AlignmentParameters()

SMALLER = "Align smaller maps, such as parts of these."

Motion = Annotated[
    Literal["yaw", "se3"],
    Query(description="Yaw and translation, for both frames are level; or all six degrees."),
]


@router.post(
    "/maps/{map}/align/{other}",
    summary="How another map lies to this one",
    responses=documented(400, 401, 403, 404, 408, 409, 413, 415, 422, 429, 500, 503, 504),
)
async def align(
    name: Name,
    other: OtherName,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    timing: TimingOf,
    motion: Motion = "yaw",
    pairs: Annotated[bool, Query(description="Tell the segments that agree, too.")] = False,
) -> AlignmentOut:
    """The transform between their frames, or why none is told.

    From descriptors and centroids alone: parts of the other map are localised in this one; where
    many put all of it in the same place, that is held against everything that both robots should
    have seen. Nothing is written.
    """
    for each in (name, other):
        holder.check_map(each)
    async with state.lanes.alignments.admit(request, (JSON,), timing) as body:
        if body.content:  # options, as `merge` takes them there; they would be ignored
            raise invalid_value(
                "", "align takes its options in the query: ?motion=se3, not a body."
            )
        one, another = state.engine.maps.get(name), state.engine.maps.get(other)
        check_same_model(one, another)
        model = state.engine.models.named(one.model_id)
        check_cost(
            cost_of_aligning([len(one), len(another)], K, PARAMETERS),
            state.settings.limits.alignment_seconds,
            SMALLER,
        )
        answer = await state.run(_aligned, one, another, model, motion, pairs)
    timing.lap("verify")
    return answer


def _aligned(
    one: MapSnapshot, other: MapSnapshot, model: Model, motion: Literal["yaw", "se3"], pairs: bool
) -> AlignmentOut:
    parameters = AlignmentParameters(local=LocalizationParameters(model=motion))
    here, there = MapSide.of(one), MapSide.of(other)
    found = align_maps(here, there, here.index(model), model, parameters, current().check)
    ids = (here.content.ids, there.content.ids) if pairs else None
    return alignment_of(found, one, other, ids)


@router.post(
    "/maps/{map}/merge",
    summary="Merge maps into a site",
    response_model=MergedOut,
    responses=_NEW_RESPONSE
    | documented(*(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507)),
    openapi_extra=json_body(MergeRequest),
)
async def merge(
    name: Name,
    request: Request,
    state: StateOf,
    holder: HolderOf,
    writer: WriterOf,
    timing: TimingOf,
) -> JSONResponse:
    """Lay stored maps on each other and put their segments into one map, with where they come from.

    All pairs are aligned, and alignments that do not close a loop are rejected. Maps that cannot be
    laid on the site are left out. Each segment keeps its robot, its moment, and the map and id that
    it had. The site is written in one version: `dry_run` tells before what it would be, and
    restoring the version before undoes it. A map that has grown can be merged again.
    """
    holder.check_write(name)
    async with state.lanes.alignments.admit(request, (JSON,), timing) as body:
        asked = await state.run(_read, body.content, name, state, holder)
        parameters = AlignmentParameters(local=LocalizationParameters(model=asked.motion))
        check = current().check
        check_cost(
            cost_of_aligning(_sizes(name, asked, state), K, PARAMETERS),
            state.settings.limits.alignment_seconds,
            "Merge fewer or smaller maps at once.",
        )
        merger = Merger(writer, parameters, asked.deduplicate, asked.dry_run, check)
        merged = await state.run(merger.merge, name, asked.maps)
    timing.lap("commit")
    if merged.written is not None:
        tell_written(request, state, "merge", merged.written)
    answer = merged_of(merged, name, asked.maps)
    return JSONResponse(
        answer.model_dump(mode="json"),
        status_code=201 if merged.written is not None and merged.written.is_new else 200,
        headers={"ETag": f'"{answer.etag}"'} if answer.etag is not None else None,
    )


def _sizes(name: str, asked: MergeRequest, state: State) -> list[int]:
    """Return the numbers of segments of a merge's maps, in the order of their alignment."""
    stored = [state.engine.maps.find(name), *map(state.engine.maps.get, asked.maps)]
    return [len(each) for each in stored if each is not None]


def _read(content: bytes, name: str, state: State, holder: Holder) -> MergeRequest:
    """What is asked, if it can be done."""
    try:
        asked = MergeRequest.model_validate_json(content)
    except ValidationError as error:
        raise invalid(error) from error
    most = state.settings.limits.merged_maps
    if len(asked.maps) > most:
        raise invalid_value("/maps", f"{len(asked.maps)} of them; the limit is {most}.")
    for index, each in enumerate(asked.maps):
        if each == name or each in asked.maps[:index]:
            raise invalid_value(f"/maps/{index}", f"{each!r} is the site, or stands twice.")
        holder.check_map(each)
    if len(asked.maps) < 2 and state.engine.maps.find(name) is None:
        raise invalid_value("/maps", f"{name!r} is a new site; it takes two maps or more.")
    return asked
