"""`/maps/{map}/align/{other}`: how the frames of two maps lie to each other."""

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request

from segments.localisation import LocalisationParameters
from segments.map_alignment import AlignmentParameters
from service.aligning import align_maps, check_same_model
from service.alignment_schemas import AlignmentOut
from service.bodies import JSON
from service.map_name import Name, OtherName
from service.models import Model
from service.problems import documented
from service.routes.laid import alignment_of
from service.state import HolderOf, StateOf, TimingOf
from service.stored_map import StoredMap

router = APIRouter(tags=["sharing"])

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
    async with state.alignments.admit(request, (JSON,), timing):
        one, another = state.maps.get(name), state.maps.get(other)
        check_same_model(one, another)
        model = state.models.named(one.model_id)
        answer = await state.store(_aligned, one, another, model, motion, pairs)
    timing.lap("verify")
    return answer


def _aligned(
    one: StoredMap, other: StoredMap, model: Model, motion: Literal["yaw", "se3"], pairs: bool
) -> AlignmentOut:
    parameters = AlignmentParameters(local=LocalisationParameters(model=motion))
    found, here, there = align_maps(one, other, model, parameters)
    return alignment_of(found, one, other, (here.ids, there.ids) if pairs else None)
