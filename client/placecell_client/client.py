"""The HTTP client."""

import json
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

import httpx
import numpy as np
from numpy.typing import ArrayLike, NDArray

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


class Client:
    """Talks to one Placecell service; a context manager, to be shared by threads.

    Each method raises `ServiceError` when the service refuses, and `httpx.TransportError` when it
    cannot be reached.

    Args:
        base_url: such as `http://127.0.0.1:8000`.
        timeout: seconds without an answer.
        transport: instead of the network, for tests.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
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
        content = self._json("GET", "/info")
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
        content = self._json("POST", "/describe", {"segments": _segments(segments, sensors)})
        items, dimension = content["descriptors"], content["dimension"]
        codes = np.zeros((len(items), dimension), dtype=np.int8)
        descriptors = np.full((len(items), dimension), np.nan, dtype=np.float32)
        centroids = np.full((len(items), 3), np.nan)
        for index, item in enumerate(items):
            if "error" not in item:
                codes[index] = item["codes"]
                descriptors[index] = item["descriptor"]
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
            body |= {"model_id": description.model_id, "codes": description.codes[rows].tolist()}
        elif description is None and segments is not None and sensors is not None:
            body["segments"] = _segments(segments, sensors)
        else:
            raise ValueError("give either a description, or segments and sensors")
        content = self._json("POST", "/match", body)
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
        return tuple(MapSummary.of(item) for item in self._json("GET", "/maps")["maps"])

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

    def _json(self, method: str, path: str, body: dict[str, Any] | None = None) -> dict[str, Any]:
        if body is None:
            response = self._send(method, path)
        else:
            content = json.dumps(body, separators=(",", ":"), allow_nan=False).encode()
            response = self._send(
                method, path, content=content, headers={"Content-Type": "application/json"}
            )
        result: dict[str, Any] = response.json()
        return result

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


def _segments(segments: Sequence[ArrayLike], sensors: ArrayLike) -> list[dict[str, Any]]:
    positions = np.asarray(sensors, dtype=np.float64)
    if positions.shape not in {(3,), (len(segments), 3)}:
        raise ValueError(f"sensors: shape {positions.shape}, not (3,) or ({len(segments)}, 3)")
    items = []
    for index, cloud in enumerate(segments):
        points: NDArray[np.float64] = np.asarray(cloud, dtype=np.float64).reshape(-1, 3)
        position = positions if positions.ndim == 1 else positions[index]
        if not (np.isfinite(points).all() and np.isfinite(position).all()):
            raise ValueError(f"segment {index}: a value is not finite")
        items.append({"points": points.tolist(), "sensor": position.tolist()})
    return items


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
