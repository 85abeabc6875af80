"""The API's description, with the bodies' schemas.

FastAPI does not see them: the routes parse bodies themselves, off the event loop.
"""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel

from service.problems import ProblemBody
from service.schemas import DescribeRequest, MatchRequest

_REFERENCE = "#/components/schemas/{model}"


def json_body(schema: type[BaseModel]) -> dict[str, Any]:
    """The description of a JSON body, for a route's `openapi_extra`."""
    reference = {"$ref": _REFERENCE.format(model=schema.__name__)}
    return {
        "requestBody": {"required": True, "content": {"application/json": {"schema": reference}}}
    }


def file_body(*media_types: str) -> dict[str, Any]:
    """The description of a file as a body, for a route's `openapi_extra`."""
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
            for schema in (DescribeRequest, MatchRequest, ProblemBody):
                content = schema.model_json_schema(ref_template=_REFERENCE)
                components.update(content.pop("$defs", {}))
                components[schema.__name__] = content
            app.openapi_schema = document
        return app.openapi_schema

    # FastAPI's documented way to extend the description.
    app.openapi = described  # type: ignore[method-assign]
