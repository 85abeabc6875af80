"""`/maps/{map}/export`: a map as a file of another program."""

from functools import partial
from typing import Annotated, Any
from zlib import crc32

from fastapi import APIRouter, Query, Request, Response
from placecell_client import CompactMap

from placecell.core.geodesy import GeoAnchor
from placecell.core.segment_classes import ClassFilter
from placecell.export.geo import parse_anchor
from placecell.export.targets import ColorBy, Target
from service.api.admission.admission import client_of
from service.api.body.problem_json import documented
from service.api.dependencies import ConditionsOf, PrincipalOf, StateOf
from service.api.path_parameters import Name
from service.api.query_parsing import WantedClasses
from service.api.state import State
from service.clouds.map_export import MEDIA_TYPES, check_exportable, exported
from service.core.problems import invalid_value
from service.maps.history import load_version, version_tag
from service.maps.layers import of_wanted
from service.maps.snapshot import MapSnapshot

router = APIRouter(tags=["maps"])

_RESPONSE: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The file.",
        "content": {
            kind: {"schema": {"type": "string", "format": "binary"}}
            for kind in dict.fromkeys(MEDIA_TYPES.values())
        },
    },
    304: {"description": "The client already has this file."},
}


@router.get(
    "/maps/{map}/export",
    summary="Download a map for another program",
    response_class=Response,
    responses=_RESPONSE | documented(400, 401, 403, 404, 410, 413, 422, 429, 500, 503, 504),
)
async def export_map(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    conditions: ConditionsOf,
    wanted: WantedClasses,
    to: Annotated[Target, Query(description="Format of the file.")],
    color: Annotated[
        ColorBy, Query(description="Number of a segment that decides its color.")
    ] = "id",
    anchor: Annotated[
        str | None,
        Query(
            max_length=100,
            description="Place of the map's origin, LAT,LON or LAT,LON,YAW_DEG in degrees, for "
            "`geojson`. Default: the anchor of the map.",
        ),
    ] = None,
    version: Annotated[
        int | None,
        Query(ge=1, le=1 << 53, description="Sequence of a version. Default: the newest version."),
    ] = None,
) -> Response:
    """Return the map as `placecell export` writes it, for CloudCompare, QGIS, Foxglove and others.

    `ply`, `las`, `pcd` and `mcap` have one point for each segment, in colors; `geojson` has their
    places on the Earth; `tum` and `g2o` have the poses of the captures. `classes` and `ignore`
    leave out segments by their class, but no captures.
    """
    principal.check_map(name)
    snapshot = state.engine.maps.get(name)
    place = _place(state, snapshot, anchor) if to == "geojson" else None
    sequence = snapshot.head.sequence if version is None else version
    async with state.lanes.reads.enter(request):
        tag = await state.run(version_tag, state.engine.maps.store, snapshot, sequence)
        # Weak: the same version may be written in other bytes, such as another date.
        tag = f"{tag}-{to}-{color}-{crc32(repr(place).encode()):08x}"
        tag += "" if wanted is None else f"-{wanted.label}"
        headers = {"ETag": f'W/"{tag}"'}
        if conditions.is_known(tag):
            return Response(status_code=304, headers=headers)
        check_exportable(len(snapshot), to, place)
        load = partial(_content, state, snapshot, sequence, wanted)
        return await state.answers.respond_shared(
            f"export {snapshot.head.uid} {tag}",
            lambda: exported(load, to, color, place, state.settings.data_dir),
            state.run,
            client_of(request),
            MEDIA_TYPES[to],
            headers
            | {
                # A map's name has letters, digits, dots, dashes and underscores only.
                "Content-Disposition": f'attachment; filename="{name}.{to}"',
                "X-Content-Type-Options": "nosniff",
            },
        )


def _content(
    state: State, snapshot: MapSnapshot, sequence: int, wanted: ClassFilter | None
) -> CompactMap:
    content = load_version(state.engine.maps.store, snapshot, sequence)[0].content()
    return of_wanted(content, wanted)


def _place(state: State, snapshot: MapSnapshot, text: str | None) -> GeoAnchor | None:
    """Return the place of a map: as the request says, or as its anchor does."""
    if text is None:
        return state.engine.annotations.geo_anchor(snapshot)
    try:
        return parse_anchor(text)
    except ValueError as error:
        raise invalid_value("/query/anchor", f"{error}".replace("--anchor", "anchor")) from error
