"""Parsing of request bodies and rendering of responses, as JSON or msgpack."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, cast

from fastapi import Request
from pydantic import BaseModel, ValidationError
from pydantic_core import to_json

from service.api.body import msgpack_codec
from service.api.body.json_requests import read_json
from service.api.schemas.msgpack import PackedRequest
from service.core.problems import Problem, invalid
from service.core.settings import Limits

JSON = "application/json"
MSGPACK = "application/msgpack"
OCTETS = "application/octet-stream"
ENCODINGS = (JSON, MSGPACK)
"""Media types of answers; the first is the default."""

Schema = TypeVar("Schema", bound=BaseModel)
Packed = TypeVar("Packed", bound=PackedRequest)


@dataclass(frozen=True, slots=True)
class Body:
    """Body of a request and its media type, which is empty if the request names none."""

    media_type: str
    content: bytes


def answer_type(request: Request, offered: Sequence[str] = ENCODINGS) -> str:
    """Return the offered media type that the Accept header prefers; the first of equals.

    Raises:
        Problem: 406 if no offered type is acceptable.
    """
    accept = ",".join(request.headers.getlist("accept"))
    if not accept.strip():
        return offered[0]
    best = max(offered, key=lambda media_type: _quality(media_type, accept))
    if _quality(best, accept) <= 0:
        raise Problem(
            406,
            "not-acceptable",
            f"Unsupported media type in Accept {accept!r:.80}: expected {' or '.join(offered)}.",
        )
    return best


def prefers(request: Request, media_type: str, default: str) -> bool:
    """Return whether the Accept header prefers a media type to the default one."""
    accept = ",".join(request.headers.getlist("accept"))
    return _quality(media_type, accept) > _quality(default, accept)


def _quality(media_type: str, accept: str) -> float:
    """Return the quality of a media type in an Accept header, 0 to 1.

    The most specific range that matches decides.
    """
    fits = (media_type, media_type.partition("/")[0] + "/*", "*/*")
    qualities: dict[str, float] = {}
    for part in accept.lower().split(","):
        name, *parameters = (piece.strip() for piece in part.split(";"))
        weights = [piece[2:] for piece in parameters if piece.startswith("q=")]
        # An invalid weight counts as 0. `float` alone would accept `nan`.
        good = all(re.fullmatch(r"[01](\.\d*)?", weight) for weight in weights)
        quality = float(weights[0]) if good and weights else float(good)
        qualities[name] = max(quality, qualities.get(name, 0.0))
    return next((qualities[name] for name in fits if name in qualities), 0.0)


def parse(
    schema: type[Schema], packed: type[Packed], body: Body, limits: Limits
) -> Schema | Packed:
    """Parse a body by the schema of its encoding, JSON or msgpack.

    Raises:
        Problem: 413 if the body holds too many values, 400 if it is invalid JSON or msgpack, 422
            if it does not match the schema.
    """
    try:
        if body.media_type == MSGPACK:
            return packed.model_validate(msgpack_codec.unpack(body.content, limits))
        return cast(Schema, read_json(schema, body.content, limits))
    except ValidationError as error:
        raise invalid(error) from error


def read_json_body(schema: type[Schema], content: bytes) -> Schema:
    """Parse a small JSON body; 400 if it is not JSON, 422 if it does not match the schema."""
    try:
        return schema.model_validate_json(content)
    except ValidationError as error:
        raise invalid(error) from error


def render(response: BaseModel | dict[str, Any], media_type: str) -> bytes:
    """Encode a response.

    Lists are encoded item by item, so that other threads can run in between.
    """
    content = response.model_dump() if isinstance(response, BaseModel) else response
    return msgpack_codec.pack(content) if media_type == MSGPACK else b"".join(_json_parts(content))


def _json_parts(content: dict[str, Any]) -> Iterator[bytes]:
    """Yield the JSON of an object, lists item by item."""
    before = b"{"
    for key, value in content.items():
        yield before + to_json(key) + b":"
        before = b","
        if isinstance(value, list | msgpack_codec.Items):
            yield b"["
            for number, item in enumerate(value):
                yield b"," + to_json(item) if number else to_json(item)
            yield b"]"
        else:
            yield to_json(value)
    yield b"}" if content else b"{}"
