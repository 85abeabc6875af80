"""msgpack codec: decodes request bodies with limits on memory, and encodes responses."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import msgpack  # type: ignore[import-untyped]

from service.api.schemas.msgpack import Pairs
from service.core.problems import Problem
from service.core.settings import Limits


@dataclass(frozen=True, slots=True, eq=False)
class Items:
    """List of an answer whose items are created one at a time, during encoding.

    Attributes:
        length: number of items.
        items: iterator over the items; it can be used once.
    """

    length: int
    items: Iterator[Any]

    def __len__(self) -> int:
        return self.length

    def __iter__(self) -> Iterator[Any]:
        return self.items


KEYS = 16
"""Largest number of keys of a map. The schemas have fewer."""


def unpack(body: bytes, limits: Limits) -> object:
    """Decode a body; return its single value, with maps as `Pairs`.

    Raises:
        Problem: 413 if the body holds too many values, 400 if it is not msgpack or holds more than
            one value.
    """
    # The limit of bytes is not enough, because one byte can encode an empty list, which takes 64
    # bytes of memory. So each list and map is counted when it ends. Those that have not ended are
    # nested (at most 1,024 deep) and short. A segment has 9 values. The rest is for the names of
    # maps, and so that one segment too many gets its own error.
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
    # Most exceptions of msgpack are ValueErrors, but not all.
    except (ValueError, msgpack.UnpackException) as error:
        if isinstance(error, ValueError) and "max_array_len" in str(error):
            raise _too_long(error, limits) from error
        reason = str(error) or type(error).__name__
        raise Problem(
            400, "not-msgpack", f"The body cannot be read as msgpack: {reason:.200}."
        ) from error


def pack(content: dict[str, Any]) -> bytes:
    """Encode a response as msgpack; `bytes` become binary data."""
    packer = msgpack.Packer(autoreset=False)
    packer.pack_map_header(len(content))
    for key, value in content.items():
        packer.pack(key)
        if isinstance(value, list | Items):
            packer.pack_array_header(len(value))
            # Item by item, so that other threads can run in between.
            for item in value:
                packer.pack(item)
        else:
            packer.pack(value)
    return bytes(packer.bytes())


def _too_many(limit: int, limits: Limits) -> Problem:
    return Problem(
        413,
        "too-many-values",
        f"The body holds more than {limit} values, each blob counted as one. Send at most "
        f"{limits.segments} segments and no unknown keys.",
    )


def _too_long(error: ValueError, limits: Limits) -> Problem:
    length = str(error).partition(" ")[0]
    return Problem(
        413,
        "too-many-values",
        f"The body holds a list of {length} items; the limit is {limits.segments} segments or "
        "descriptors in a request. Send several requests.",
    )
