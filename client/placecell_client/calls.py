"""Each request that the service takes, and how to read its answer. Nothing here sends."""

import gzip
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from urllib.parse import quote

from numpy.typing import ArrayLike

from placecell_client import reading
from placecell_client.answer import Answer
from placecell_client.map_file import MEDIA_TYPE, CompactMap, decode, encode
from placecell_client.results import Description, Info, MapSummary, Matches
from placecell_client.wire import MEDIA_TYPES, Encoding, codes_of, dumps, segments_of

T = TypeVar("T")

COMPRESSED_BYTES = 1024
"""Maps of less are sent as they are."""


@dataclass(frozen=True, slots=True)
class Call(Generic[T]):
    """A request, safe to repeat, and how to read its answer.

    Attributes:
        method: of HTTP.
        path: below the service's address, quoted.
        read: raises a ValueError, KeyError, TypeError or the like if the answer is not as it should
            be.
        headers: of the request.
        content: its body, the same bytes in every attempt.
    """

    method: str
    path: str
    read: Callable[[Answer], T]
    headers: dict[str, str] = field(default_factory=dict)
    content: bytes | None = None


@dataclass(frozen=True, slots=True)
class Calls:
    """Makes calls; the clients say what each does.

    Attributes:
        encoding: of points and descriptors.
        compress: whether maps travel as gzip.
    """

    encoding: Encoding
    compress: bool = False

    def info(self) -> Call[Info]:
        """`GET /info`."""
        return Call("GET", "/info", reading.info)

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Call[Description]:
        """`POST /describe`."""
        body = segments_of(segments, sensors, self.encoding)
        count = len(segments)
        return self._post("/describe", body, lambda answer: reading.description(answer, count))

    def match(
        self,
        description: Description | None,
        segments: Sequence[ArrayLike] | None,
        sensors: ArrayLike | None,
        maps: Sequence[str] | None,
        k: int,
    ) -> Call[Matches]:
        """`POST /match`."""
        body: dict[str, Any] = {"k": k}
        if maps is not None:
            body["maps"] = list(maps)
        if description is not None and segments is None and sensors is None:
            rows = [row for row in range(len(description.codes)) if row not in description.errors]
            codes = codes_of(description.codes[rows], self.encoding)
            body |= {"model_id": description.model_id, "codes": codes}
            return self._post(
                "/match", body, lambda answer: reading.matches_of(answer, description, rows)
            )
        if description is None and segments is not None and sensors is not None:
            body |= segments_of(segments, sensors, self.encoding)
            count = len(segments)
            return self._post("/match", body, lambda answer: reading.matches(answer, count))
        raise ValueError("give either a description, or segments and sensors")

    def maps(self) -> Call[tuple[MapSummary, ...]]:
        """`GET /maps`."""
        return Call("GET", "/maps", reading.summaries)

    def put_map(self, name: str, compact_map: CompactMap | bytes) -> Call[MapSummary]:
        """`PUT /maps/{map}`."""
        data = encode(compact_map) if isinstance(compact_map, CompactMap) else compact_map
        headers = {"Content-Type": MEDIA_TYPE}
        if self.compress and len(data) > COMPRESSED_BYTES:
            # No time in its header: equal maps are equal uploads.
            data = gzip.compress(data, mtime=0)
            headers["Content-Encoding"] = "gzip"
        return Call("PUT", _map_path(name), reading.summary, headers, data)

    def get_map(self, name: str) -> Call[CompactMap]:
        """`GET /maps/{map}`, decoded."""
        return Call("GET", _map_path(name), lambda answer: decode(reading.file(answer)))

    def get_map_file(self, name: str) -> Call[bytes]:
        """`GET /maps/{map}`."""
        return Call("GET", _map_path(name), reading.file)

    def delete_map(self, name: str) -> Call[None]:
        """`DELETE /maps/{map}`."""
        return Call("DELETE", _map_path(name), reading.gone)

    def _post(self, path: str, body: dict[str, Any], read: Callable[[Answer], T]) -> Call[T]:
        media_type = MEDIA_TYPES[self.encoding]
        headers = {"Content-Type": media_type, "Accept": media_type}
        return Call("POST", path, read, headers, dumps(body, self.encoding))


def _map_path(name: str) -> str:
    # Quoted whole, so that a name with a slash is refused by the service, not taken for a path.
    # Dots too: `..` would be resolved on the way.
    return "/maps/" + quote(name, safe="").replace(".", "%2E")
