"""API description: adds the schemas of the bodies.

FastAPI does not know these schemas, since the routes parse bodies themselves, off the event loop.
"""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel

from service.api.body.body import JSON, MSGPACK
from service.api.body.problem_json import ProblemBody
from service.api.schemas.alignment import MergeRequest
from service.api.schemas.anchors import (
    FitRequest,
    GeoAnchorIn,
    GeoPose,
    NamedAnchorIn,
    TagsIn,
)
from service.api.schemas.localization import LocalizeRequest
from service.api.schemas.maps import MirrorIn
from service.api.schemas.msgpack import (
    PackedDescribeRequest,
    PackedDescribeResponse,
    PackedLocalizeRequest,
    PackedMatchRequest,
)
from service.api.schemas.pose_graph import OptimizeRequest
from service.api.schemas.recognition import DescribeRequest, MatchRequest
from service.api.schemas.robots import RobotReportIn
from service.api.schemas.scans import PackedScanResponse

_REFERENCE = "#/components/schemas/{model}"
_SCHEMAS: tuple[type[BaseModel], ...] = (
    DescribeRequest,
    FitRequest,
    GeoAnchorIn,
    GeoPose,
    LocalizeRequest,
    MatchRequest,
    MergeRequest,
    MirrorIn,
    NamedAnchorIn,
    OptimizeRequest,
    PackedDescribeRequest,
    PackedDescribeResponse,
    PackedLocalizeRequest,
    PackedMatchRequest,
    PackedScanResponse,
    ProblemBody,
    RobotReportIn,
    TagsIn,
)


def body_of(schema: type[BaseModel], packed: type[BaseModel]) -> dict[str, Any]:
    """Describe a body in JSON or msgpack, for a route's `openapi_extra`."""
    return {
        "requestBody": {
            "required": True,
            "content": {
                JSON: {"schema": _reference(schema)},
                MSGPACK: {"schema": _reference(packed)},
            },
        }
    }


def json_body(schema: type[BaseModel], required: bool = True) -> dict[str, Any]:
    """Describe a body in JSON only, for a route's `openapi_extra`."""
    content = {JSON: {"schema": _reference(schema)}}
    return {"requestBody": {"required": required, "content": content}}


def packed_response(
    schema: type[BaseModel], media_type: str | None = None, other: type[BaseModel] | None = None
) -> dict[int | str, dict[str, Any]]:
    """Describe a response in msgpack, in addition to the JSON that FastAPI describes.

    Args:
        schema: schema of the response.
        media_type: another media type that the response may have.
        other: its schema.
    """
    content = {MSGPACK: {"schema": _reference(schema)}}
    if media_type is not None and other is not None:
        content[media_type] = {"schema": _reference(other)}
    return {200: {"content": content}}


def file_body(*media_types: str) -> dict[str, Any]:
    """Describe a file as a body, for a route's `openapi_extra`."""
    file = {"schema": {"type": "string", "format": "binary"}}
    return {"requestBody": {"required": True, "content": dict.fromkeys(media_types, file)}}


def install(app: FastAPI) -> None:
    """Complete the description that `/docs` and `/openapi.json` show."""

    def described() -> dict[str, Any]:
        if app.openapi_schema is None:
            document = get_openapi(
                title=app.title, version=app.version, description=app.description, routes=app.routes
            )
            components = document.setdefault("components", {}).setdefault("schemas", {})
            for schema in _SCHEMAS:
                content = schema.model_json_schema(ref_template=_REFERENCE)
                components.update(content.pop("$defs", {}))
                components[schema.__name__] = content
            app.openapi_schema = document
        return app.openapi_schema

    # FastAPI's documented way to extend the description.
    app.openapi = described  # type: ignore[method-assign]


def _reference(schema: type[BaseModel]) -> dict[str, str]:
    return {"$ref": _REFERENCE.format(model=schema.__name__)}
