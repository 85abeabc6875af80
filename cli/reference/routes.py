"""HTTP API reference: parameters and responses of each route, and all schemas, from OpenAPI."""

from collections.abc import Iterator
from functools import cache
from typing import Any

from cli.reference.markdown import code, paragraphs, table

JSON, MSGPACK = "application/json", "application/msgpack"
PROBLEM = "application/problem+json"


@cache
def openapi() -> dict[str, Any]:
    """Return the OpenAPI document of the service with its default settings."""
    from service.app import create_app
    from service.core.settings import Settings

    document: dict[str, Any] = create_app(Settings()).openapi()
    return document


def route_pages() -> dict[str, str]:
    """Return the generated parts of the page on routes: one per route, and the schemas."""
    document = openapi()
    parts = {name: _route(route) for name, route in routes_of(document)}
    schemas = document["components"]["schemas"]
    shown = [name for name in schemas if not name.startswith("Packed")]
    parts["schemas"] = "\n".join(_schema(name, schemas[name]) for name in sorted(shown))
    return parts


def routes_of(document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each route, such as `POST /match`, with its description."""
    for path, methods in document["paths"].items():
        for method, route in methods.items():
            yield f"{method.upper()} {path}", route


def _route(route: dict[str, Any]) -> str:
    parts = [f"**{route['summary']}.**\n\n"]
    if route.get("description"):
        parts.append(paragraphs(route["description"]) + "\n")
    rows = [
        [
            code(each["name"]) + (" (required)" if each.get("required") else ""),
            each["in"],
            _type(each["schema"]),
            each.get("description", "") + _default(each["schema"]),
        ]
        for each in route.get("parameters", [])
    ]
    if rows:
        parts.append(table(["Parameter", "In", "Type", "Meaning"], rows) + "\n")
    body = route.get("requestBody")
    if body:
        parts.append(f"Body: {_content(body['content'])}.\n\n")
    good, refused = [], []
    for status, answer in route["responses"].items():
        content = answer.get("content", {})
        if PROBLEM in content:
            refused.append(status)
        else:
            shown = _content(content)
            good.append(f"{status} {shown}".strip())
    parts.append(f"Answer: {'; '.join(good)}.\n")
    if refused:
        parts.append(f"\nProblems: {', '.join(sorted(refused))} ([errors](errors.md)).\n")
    return "".join(parts)


def _content(content: dict[str, Any]) -> str:
    """Return the schemas and media types of a body; msgpack variants share the JSON schema."""
    shown = []
    for media, each in content.items():
        schema = each.get("schema", {})
        named = schema.get("$ref", "").rpartition("/")[2]
        if named.startswith("Packed") or (media == MSGPACK and JSON in content):
            shown.append(f"[msgpack](msgpack.md) (`{media}`)")
        elif named:
            shown.append(f"{_link(named)} (`{media}`)")
        else:
            shown.append(code(media))
    return " or ".join(dict.fromkeys(shown))


def _schema(name: str, schema: dict[str, Any]) -> str:
    parts = [f"### {name}\n\n", paragraphs(schema.get("description", "")) + "\n"]
    required = schema.get("required", [])
    rows = (
        [
            code(key),
            _type(value),
            value.get("description", "") + ("" if key in required else _default(value)),
        ]
        for key, value in schema.get("properties", {}).items()
    )
    return "".join(parts) + table(["Key", "Type", "Meaning"], rows)


def _default(value: dict[str, Any]) -> str:
    default = value.get("default")
    return "" if default in (None, [], {}, "") else f" Default: {code(_json(default))}."


def _json(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _type(schema: dict[str, Any]) -> str:
    """Return the type of a value in words, with links to schemas."""
    if "$ref" in schema:
        return _link(schema["$ref"].rpartition("/")[2])
    choices = schema.get("anyOf", schema.get("oneOf"))
    if choices:
        return " or ".join(dict.fromkeys(map(_type, choices)))
    constants = schema.get("enum", [schema["const"]] if "const" in schema else [])
    if constants:
        return " or ".join(map(code, constants))
    kind = str(schema.get("type", "any"))
    if kind == "array":
        return _list(schema)
    values = schema.get("additionalProperties")
    if kind == "object" and isinstance(values, dict):
        return f"object of {_type(values)}"
    return {"string": "text", "boolean": "true or false"}.get(kind, kind)


def _list(schema: dict[str, Any]) -> str:
    first = schema.get("prefixItems")
    if first:
        return f"list of {len(first)} {_type(first[0])}s"
    least, most = schema.get("minItems"), schema.get("maxItems")
    count = f"{least} " if least == most and least is not None else ""
    return f"list of {count}{_type(schema.get('items', {}))}"


def _link(name: str) -> str:
    return f"[{name}](#{name.lower()})"
