"""The HTTP client."""

from collections.abc import Sequence
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

import httpx
import numpy as np
from numpy.typing import ArrayLike

from placecell_client.errors import ServiceError
from placecell_client.map_file import MEDIA_TYPE, CompactMap, decode, encode
from placecell_client.results import (
    Candidate,
    Description,
    Info,
    ItemError,
    MapSummary,
    Matches,
    Skipped,
)
from placecell_client.wire import MEDIA_TYPES, Encoding, codes_of, dumps, loads, row_of, segments_of


class Client:
    """Talks to one Placecell service; a context manager, to be shared by threads.

    Each method raises `ServiceError` when the service refuses, and `httpx.TransportError` when it
    cannot be reached.

    Args:
        base_url: such as `http://127.0.0.1:8000`.
        timeout: seconds without an answer.
        transport: instead of the network, for tests.
        encoding: of points and descriptors on the wire; `json` is larger and slower, and readable.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
        encoding: Encoding = "msgpack",
    ) -> None:
        if encoding not in MEDIA_TYPES:
            raise ValueError(f"encoding {encoding!r} is none of {', '.join(MEDIA_TYPES)}")
        self._encoding = encoding
        self._http = httpx.Client(base_url=base_url, timeout=timeout, transport=transport)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def info(self) -> Info:
        """What the service is, and how much it takes at once."""
        content = self._get("/info")
        return Info(
            version=content["version"],
            model_id=content["model"]["model_id"],
            model=content["model"],
            limits=content["limits"],
            map_file_version=content["map_file"]["version"],
        )

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """Descriptors of the segments of one scan.

        Args:
            segments: points of each, (points, 3), metres, all in one z-up frame.
            sensors: where the sensor was at capture, (segments, 3) or (3,) for all, same frame.

        Raises:
            ValueError: the arrays do not fit each other or hold a value that is not finite.
        """
        content = self._post("/describe", segments_of(segments, sensors, self._encoding))
        items, dimension = content["descriptors"], content["dimension"]
        # The service answers with an error as a whole where no segment could be used.
        code_bytes = next(len(item["codes"]) for item in items if "error" not in item)
        codes = np.zeros((len(items), code_bytes), dtype=np.int8)
        descriptors = np.full((len(items), dimension), np.nan, dtype=np.float32)
        centroids = np.full((len(items), 3), np.nan)
        for index, item in enumerate(items):
            if "error" not in item:
                codes[index] = row_of(item["codes"], "int8")
                descriptors[index] = row_of(item["descriptor"], "<f4")
                centroids[index] = item["centroid"]
        return Description(content["model_id"], codes, descriptors, centroids, _errors(items))

    def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
    ) -> Matches:
        """The k nearest segments of the maps to each query.

        Args:
            description: the queries, as `describe` gave them, or
            segments: the queries' points, with
            sensors: as for `describe`.
            maps: names; all maps of the service's model unless said.
            k: candidates a query, at most.

        Raises:
            ValueError: neither or both kinds of query, or arrays that do not fit.
        """
        body: dict[str, Any] = {"k": k}
        if maps is not None:
            body["maps"] = list(maps)
        rows = None
        if description is not None and segments is None and sensors is None:
            rows = [
                index for index in range(len(description.codes)) if index not in description.errors
            ]
            codes = codes_of(description.codes[rows], self._encoding)
            body |= {"model_id": description.model_id, "codes": codes}
        elif description is None and segments is not None and sensors is not None:
            body |= segments_of(segments, sensors, self._encoding)
        else:
            raise ValueError("give either a description, or segments and sensors")
        content = self._post("/match", body)
        matches = Matches(
            model_id=content["model_id"],
            queries=tuple(
                tuple(_candidate(candidate) for candidate in item.get("candidates", ()))
                for item in content["queries"]
            ),
            errors=_errors(content["queries"]),
            searched=tuple(content["searched"]),
            skipped=tuple(Skipped(item["map"], item["model_id"]) for item in content["skipped"]),
        )
        if description is None or not description.errors or rows is None:
            return matches
        return _spread(matches, description, rows)

    def maps(self) -> tuple[MapSummary, ...]:
        """The stored maps, by name."""
        return tuple(MapSummary.of(item) for item in self._get("/maps")["maps"])

    def put_map(self, name: str, compact_map: CompactMap | bytes) -> MapSummary:
        """Store a map, in place of one of that name; returns when it is safely on disk."""
        data = encode(compact_map) if isinstance(compact_map, CompactMap) else compact_map
        response = self._send(
            "PUT", _map_path(name), content=data, headers={"Content-Type": MEDIA_TYPE}
        )
        return MapSummary.of(response.json())

    def get_map(self, name: str) -> CompactMap:
        """A stored map.

        Raises:
            MapFileError: the map is of another version than this client reads.
        """
        return decode(self.get_map_file(name))

    def get_map_file(self, name: str) -> bytes:
        """A stored map's file, byte by byte as it was put."""
        return self._send("GET", _map_path(name)).content

    def delete_map(self, name: str) -> None:
        """Remove a map."""
        self._send("DELETE", _map_path(name))

    def _get(self, path: str) -> dict[str, Any]:
        return loads(self._send("GET", path))

    def _post(self, path: str, body: dict[str, Any]) -> dict[str, Any]:
        media_type = MEDIA_TYPES[self._encoding]
        headers = {"Content-Type": media_type, "Accept": media_type}
        return loads(self._send("POST", path, dumps(body, self._encoding), headers))

    def _send(
        self,
        method: str,
        path: str,
        content: bytes | None = None,
        headers: dict[str, str] | None = None,
    ) -> httpx.Response:
        response = self._http.request(method, path, content=content, headers=headers)
        if not response.is_success:
            raise ServiceError.of(response)
        return response


def _errors(items: list[dict[str, Any]]) -> dict[int, ItemError]:
    return {
        index: ItemError(item["error"]["type"], item["error"]["title"], item["error"]["detail"])
        for index, item in enumerate(items)
        if "error" in item
    }


def _candidate(item: dict[str, Any]) -> Candidate:
    x, y, z = item["centroid"]
    return Candidate(
        map=item["map"],
        id=item["id"],
        robot=item["robot"],
        distance=item["distance"],
        probability=item["probability"],
        centroid=(x, y, z),
        frame=item["frame"],
    )


def _spread(matches: Matches, description: Description, rows: list[int]) -> Matches:
    """Back to the description's own indices: what could not be described was not sent."""
    queries: list[tuple[Candidate, ...]] = [()] * len(description.codes)
    for row, candidates in zip(rows, matches.queries, strict=True):
        queries[row] = candidates
    return Matches(
        matches.model_id, tuple(queries), description.errors, matches.searched, matches.skipped
    )


def _map_path(name: str) -> str:
    # Quoted whole, so that a name with a slash is refused by the service, not taken for a path.
    # Dots too: `..` would be resolved on the way.
    return "/maps/" + quote(name, safe="").replace(".", "%2E")
