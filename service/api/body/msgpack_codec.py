"""Between the bytes of a msgpack body and Python values, within bounds of memory."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import msgpack  # type: ignore[import-untyped]

from service.api.schemas.msgpack import Pairs
from service.core.problems import Problem
from service.core.settings import Limits


@dataclass(frozen=True, slots=True, eq=False)
class Items:
    """List of an answer whose items are made while they are encoded, one at a time.

    Attributes:
        length: number of items.
        items: yields them, once.
    """

    length: int
    items: Iterator[Any]

    def __len__(self) -> int:
        return self.length

    def __iter__(self) -> Iterator[Any]:
        return self.items


KEYS = 16
"""A map, at most; the schemas know fewer."""


def unpack(body: bytes, limits: Limits) -> object:
    """The one value of a body, its maps as `Pairs`.

    Raises:
        Problem: 413 if it holds too many values, 400 if it is not msgpack, or more than one value.
    """
    # The limit of bytes is not enough: one can stand for an empty list, which takes 64 of them. So
    # lists and maps are counted as they end, and those that have not ended yet (at most 1,024,
    # one in the other) are short. A segment is 9 values; the rest is for the names of maps, and
    # so that a segment too many is told as such.
    limit = 16 * limits.segments + 1_000
    values = 0

    def count(more: int) -> None:
        nonlocal values
        values += more + 1
        if values > limit:
            raise _too_many(limit, limits)

    def listed(items: list[Any]) -> list[Any]:
        count(len(items))
        return items

    def paired(items: list[tuple[object, object]]) -> Pairs:
        count(2 * len(items))
        return Pairs(items)

    try:
        return msgpack.unpackb(
            body,
            list_hook=listed,
            object_pairs_hook=paired,
            max_array_len=limits.segments + 1_000,
            max_map_len=KEYS,
        )
    except Problem:
        raise
    # Most of msgpack's own exceptions are ValueErrors, but not all.
    except (ValueError, msgpack.UnpackException) as error:
        if isinstance(error, ValueError) and "max_array_len" in str(error):
            raise _too_long(error, limits) from error
        reason = str(error) or type(error).__name__
        raise Problem(
            400, "not-msgpack", f"The body cannot be read as msgpack: {reason:.200}."
        ) from error


def pack(content: dict[str, Any]) -> bytes:
    """A response as msgpack; `bytes` become blobs."""
    packer = msgpack.Packer(autoreset=False)
    packer.pack_map_header(len(content))
    for key, value in content.items():
        packer.pack(key)
        if isinstance(value, list | Items):
            packer.pack_array_header(len(value))
            # One after the other, so that other threads get their turn.
            for item in value:
                packer.pack(item)
        else:
            packer.pack(value)
    return bytes(packer.bytes())


def _too_many(limit: int, limits: Limits) -> Problem:
    return Problem(
        413,
        "too-many-values",
        f"The body holds more than {limit} values, each blob counted as one. "
        f"{limits.segments} segments, the limit of a request, have fewer.",
    )


def _too_long(error: ValueError, limits: Limits) -> Problem:
    length = str(error).partition(" ")[0]
    return Problem(
        413,
        "too-many-values",
        f"The body holds a list of {length} items; the limit is {limits.segments} segments or "
        "descriptors in a request.",
    )
