"""Reading a request's body and writing a response's: media type, then bytes, then schema."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from fastapi import Request
from pydantic import BaseModel, ValidationError
from pydantic_core import to_json

from service import packing
from service.packed_schemas import PackedRequest
from service.problems import Problem, invalid
from service.settings import Limits

JSON = "application/json"
MSGPACK = "application/msgpack"
OCTETS = "application/octet-stream"
ENCODINGS = (JSON, MSGPACK)
"""The first one unless the client says otherwise."""

Schema = TypeVar("Schema", bound=BaseModel)
Packed = TypeVar("Packed", bound=PackedRequest)


@dataclass(frozen=True, slots=True)
class Body:
    """A request's body, and its media type: empty if the request names none."""

    media_type: str
    content: bytes


def answer_type(request: Request, offered: Sequence[str] = ENCODINGS) -> str:
    """Of the media types on offer, the one that the request's Accept likes best; ties: the first.

    Raises:
        Problem: 406 if none fits.
    """
    accept = ",".join(request.headers.getlist("accept"))
    if not accept.strip():
        return offered[0]
    best = max(offered, key=lambda media_type: _quality(media_type, accept))
    if _quality(best, accept) <= 0:
        raise Problem(
            406, "not-acceptable", f"The answer can be {' or '.join(offered)}, not {accept!r:.80}."
        )
    return best


def _quality(media_type: str, accept: str) -> float:
    """What an Accept header gives a media type, 0 to 1; the range that fits closest decides."""
    fits = (media_type, media_type.partition("/")[0] + "/*", "*/*")
    qualities: dict[str, float] = {}
    for part in accept.lower().split(","):
        name, *parameters = (piece.strip() for piece in part.split(";"))
        weights = [piece[2:] for piece in parameters if piece.startswith("q=")]
        # A weight that cannot be read is none; `float` alone would take `nan`.
        good = all(re.fullmatch(r"[01](\.\d*)?", weight) for weight in weights)
        quality = float(weights[0]) if good and weights else float(good)
        qualities[name] = max(quality, qualities.get(name, 0.0))
    return next((qualities[name] for name in fits if name in qualities), 0.0)


def parse(
    schema: type[Schema], packed: type[Packed], body: Body, limits: Limits
) -> Schema | Packed:
    """The body as its schema says: the one for JSON, or the one for msgpack.

    Raises:
        Problem: 413 if it holds too many values, 400 if it is not in its encoding, 422 if it does
            not fit the schema.
    """
    try:
        if body.media_type == MSGPACK:
            return packed.model_validate(packing.unpack(body.content, limits))
        _count(body.content, limits)
        # Straight from the bytes: pydantic's own parser takes half the time of the standard
        # library's, and names the place of a value that is wrong, NaN and infinity too.
        return schema.model_validate_json(body.content)
    except ValidationError as error:
        raise invalid(error) from error


def render(response: BaseModel | dict[str, Any], media_type: str) -> bytes:
    """A response in its encoding."""
    return packing.pack(response) if media_type == MSGPACK else to_json(response)


def _count(body: bytes, limits: Limits) -> None:
    """Refuse a JSON body that would take too much memory.

    Parsed, a body of tiny values is fifty times its size; so they are counted before. A point is
    three values in a list; the second term is for the descriptors that `/match` takes.
    """
    limit = 4 * limits.points + 1_000 * limits.segments
    values = body.count(b",") + body.count(b"[") + body.count(b"{")
    # Two keys a segment, and those of the request: each that is unknown would be an error to tell.
    if values > limit or body.count(b":") > 4 * limits.segments + 1_000:
        raise Problem(
            413,
            "too-many-values",
            f"The body holds about {values} values; {limits.points} points in {limits.segments} "
            "segments are the limit.",
        )
