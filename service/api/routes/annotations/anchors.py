"""Routes of `/maps/{map}/tags`, `/maps/{map}/anchor` and `/maps/{map}/anchors`."""

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from scipy.spatial.transform import Rotation

from placecell.core.geodesy import GeoAnchor
from placecell.localization import Pose
from service.annotations.annotations import NamedAnchor, StoredGeoAnchor
from service.annotations.fitting import AnchorFit, FitError, GnssFixes, fit_anchor
from service.annotations.writer import AnnotationWriter, no_anchor, unknown_anchor
from service.api.admission.admission import client_of
from service.api.body.body import JSON, read_json_body, render
from service.api.body.problem_json import documented
from service.api.dependencies import MapWrite, MapWriteOf, PrincipalOf, StateOf
from service.api.openapi import json_body
from service.api.path_parameters import AnchorName, Name
from service.api.responses import geo_anchor_of
from service.api.schemas.anchors import (
    FitOut,
    FitRequest,
    GeoAnchorIn,
    GeoAnchorOut,
    NamedAnchorIn,
    NamedAnchorOut,
    NamedAnchorsResponse,
    ResidualOut,
    TagsIn,
    TagsOut,
)
from service.core.auth import Principal
from service.core.problems import Problem
from service.maps.snapshot import MapSnapshot
from service.maps.visibility import author_for

router = APIRouter(tags=["anchors"])

_WRITE = documented(400, 401, 403, 404, 408, 409, 412, 413, 415, 422, 429, 500, 503, 504, 507)
_REMOVE = documented(400, 401, 403, 404, 409, 412, 422, 429, 500, 503, 504, 507)
_READ = documented(400, 401, 403, 404, 422, 429, 500, 503, 504)


@router.get("/maps/{map}/tags", summary="List the tags of a map", responses=_READ)
async def get_tags(name: Name, request: Request, state: StateOf, principal: PrincipalOf) -> TagsOut:
    """Return the tags of a map, sorted."""
    principal.check_map(name)
    async with state.lanes.reads.enter(request):
        snapshot = state.engine.maps.get(name)
        return TagsOut(map=name, tags=[*state.engine.annotations.tags(snapshot)])


@router.put(
    "/maps/{map}/tags",
    summary="Replace the tags of a map",
    responses=_WRITE,
    openapi_extra=json_body(TagsIn),
)
async def put_tags(write: MapWriteOf) -> TagsOut:
    """Replace all tags of a map. Requests for recognition select maps by them (`tags`).

    Tags, anchors and named anchors belong to the map and not to a version: edits, restores and
    replacements keep them, and they make no version. A 2xx answer survives a power failure.
    """
    async with write.receive(write.state.lanes.edits, (JSON,)) as body:
        asked = read_json_body(TagsIn, body)
        after = await write.run(_writer(write).set_tags, write.name, asked.tags)
    write.record("tags", f"{len(after.tags)} tags")
    return TagsOut(map=write.name, tags=[*after.tags])


@router.get("/maps/{map}/anchor", summary="Read the place of a map on the Earth", responses=_READ)
async def get_anchor(
    name: Name, request: Request, state: StateOf, principal: PrincipalOf
) -> GeoAnchorOut:
    """Return the WGS 84 anchor of a map."""
    principal.check_map(name)
    async with state.lanes.reads.enter(request):
        snapshot = state.engine.maps.get(name)
        found = state.engine.annotations.of(snapshot).geo
        if found is None:
            raise no_anchor(name)
        return geo_anchor_of(snapshot, found, principal)


@router.put(
    "/maps/{map}/anchor",
    summary="Set the place of a map on the Earth",
    responses=_WRITE,
    openapi_extra=json_body(GeoAnchorIn),
)
async def put_anchor(write: MapWriteOf) -> GeoAnchorOut:
    """Set the WGS 84 anchor of a map: where one point of it is on the Earth, and its direction.

    Answers of `/localize` then have a `geopose`, and the hint `geo` narrows this map. A merge
    carries the anchor into the merged map. A key that is bound to a robot replaces only an anchor
    that it wrote itself.
    """
    async with write.receive(write.state.lanes.edits, (JSON,)) as body:
        asked = read_json_body(GeoAnchorIn, body)
        anchor = GeoAnchor(**asked.model_dump())
        snapshot, stored = await write.run(_writer(write).set_geo, write.name, anchor)
    write.record("anchor", "WGS 84 anchor set")
    return geo_anchor_of(snapshot, stored, write.principal)


@router.delete(
    "/maps/{map}/anchor",
    summary="Remove the place of a map on the Earth",
    status_code=204,
    responses=_REMOVE,
)
async def delete_anchor(write: MapWriteOf) -> None:
    """Remove the WGS 84 anchor of a map."""
    async with write.enter(write.state.lanes.edits):
        await write.run(_writer(write).remove_geo, write.name)
    write.record("anchor", "WGS 84 anchor removed")


@router.post(
    "/maps/{map}/anchor/fit",
    summary="Fit the place of a map on the Earth to GNSS fixes",
    responses=_WRITE,
    openapi_extra=json_body(FitRequest),
)
async def fit_map_anchor(write: MapWriteOf) -> FitOut:
    """Fit the WGS 84 anchor of a map to GNSS fixes of robots that were localized in it.

    The fit is robust least squares: fixes that contradict the others are left out. Fixes that do
    not determine the yaw, or of which most contradict each other, are refused (422). Three fixes or
    more at different places are needed; fixes within 10 m count as one.
    """
    async with write.receive(write.state.lanes.edits, (JSON,)) as body:
        asked = await write.run(read_json_body, FitRequest, body)
        fit = await write.run(_fitted, asked)
        if asked.dry_run:
            snapshot = write.state.engine.maps.get(write.name)
            stored = StoredGeoAnchor(fit.anchor, snapshot.frame, write.principal.name, 0.0)
        else:
            snapshot, stored = await write.run(_writer(write).set_geo, write.name, fit.anchor)
    if not asked.dry_run:
        write.record("anchor", f"WGS 84 anchor fitted to {len(asked.fixes)} fixes")
    return FitOut(
        dry_run=asked.dry_run,
        anchor=geo_anchor_of(snapshot, stored, write.principal),
        yaw_deviation_deg=fit.yaw_deviation_deg,
        inliers=int(np.count_nonzero(fit.is_inlier)),
        residuals=[
            ResidualOut(meters=meters, inlier=inlier)
            for meters, inlier in zip(fit.residuals.tolist(), fit.is_inlier.tolist(), strict=True)
        ],
    )


@router.get(
    "/maps/{map}/anchors",
    summary="List the named anchors of a map",
    response_model=NamedAnchorsResponse,
    responses=_READ,
)
async def list_anchors(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    limit: Annotated[
        int, Query(ge=1, le=1_000, description="Largest number of anchors in the answer.")
    ] = 1_000,
    after: Annotated[
        str, Query(max_length=64, description="Name after which the answer begins.")
    ] = "",
) -> Response:
    """Return the named anchors of a map, by name."""
    principal.check_map(name)
    async with state.lanes.reads.enter(request):
        snapshot = state.engine.maps.get(name)
        named = state.engine.annotations.of(snapshot).named
        found = [each for key, each in sorted(named.items()) if key > after]
        content: dict[str, Any] = {
            "map": name,
            "anchors": [
                _named_of(snapshot, each, principal).model_dump() for each in found[:limit]
            ],
            "next": found[limit - 1].name if len(found) > limit else None,
        }
        return await state.answers.respond(render(content, JSON), client_of(request), JSON)


@router.get("/maps/{map}/anchors/{anchor}", summary="Read a named anchor", responses=_READ)
async def get_named(
    name: Name, anchor: AnchorName, request: Request, state: StateOf, principal: PrincipalOf
) -> NamedAnchorOut:
    """Return a named pose in a map."""
    principal.check_map(name)
    async with state.lanes.reads.enter(request):
        snapshot = state.engine.maps.get(name)
        found = state.engine.annotations.of(snapshot).named.get(anchor)
        if found is None:
            raise unknown_anchor(name, anchor)
        return _named_of(snapshot, found, principal)


@router.put(
    "/maps/{map}/anchors/{anchor}",
    summary="Set a named anchor",
    responses=_WRITE,
    openapi_extra=json_body(NamedAnchorIn),
)
async def put_named(write: MapWriteOf, anchor: AnchorName) -> NamedAnchorOut:
    """Add or replace a named pose in a map, such as a dock.

    It survives edits, restores and replacements; a merge carries it into the merged map. A key that
    is bound to a robot replaces only anchors that it wrote itself.
    """
    async with write.receive(write.state.lanes.edits, (JSON,)) as body:
        asked = read_json_body(NamedAnchorIn, body)
        pose = Pose(
            Rotation.from_quat(asked.orientation).as_matrix(), np.array(asked.position, np.float64)
        )
        snapshot, stored = await write.run(_writer(write).set_named, write.name, anchor, pose)
    write.record("anchor", f"named anchor {anchor} set")
    return _named_of(snapshot, stored, write.principal)


@router.delete(
    "/maps/{map}/anchors/{anchor}",
    summary="Remove a named anchor",
    status_code=204,
    responses=_REMOVE,
)
async def delete_named(write: MapWriteOf, anchor: AnchorName) -> None:
    """Remove a named pose of a map."""
    async with write.enter(write.state.lanes.edits):
        await write.run(_writer(write).remove_named, write.name, anchor)
    write.record("anchor", f"named anchor {anchor} removed")


def _writer(write: MapWrite) -> AnnotationWriter:
    return write.state.engine.annotation_writer(write.principal, write.writer.conditions)


def _fitted(asked: FitRequest) -> AnchorFit:
    """Fit an anchor; 422 if the fixes do not determine it."""
    places = [
        (each.lat, each.lon, np.nan if each.height is None else each.height) for each in asked.fixes
    ]
    fixes = GnssFixes(
        positions=np.array([each.position for each in asked.fixes], np.float64),
        places=np.array(places, np.float64),
        accuracies=np.array([each.accuracy for each in asked.fixes], np.float64),
    )
    try:
        return fit_anchor(fixes)
    except FitError as error:
        raise Problem(422, "anchor-not-determined", f"{error}") from error


def _named_of(snapshot: MapSnapshot, stored: NamedAnchor, principal: Principal) -> NamedAnchorOut:
    x, y, z = stored.pose.translation.tolist()
    i, j, k, w = Rotation.from_matrix(stored.pose.rotation).as_quat(canonical=True).tolist()
    return NamedAnchorOut(
        name=stored.name,
        position=(x, y, z),
        orientation=(i, j, k, w),
        frame=stored.frame,
        applies=stored.frame == snapshot.frame,
        author=author_for(principal, stored.author),
        time=stored.time,
    )
