"""Requests to the service, each with the parser of its response; no input or output."""

import gzip
import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any, Generic, TypeVar, Union
from urllib.parse import quote, urlencode

import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client.hints import Hints
from placecell_client.http import parsing
from placecell_client.http.encoding import (
    MEDIA_TYPES,
    Encoding,
    centroids_of,
    classes_of,
    codes_of,
    dumps,
    segments_of,
)
from placecell_client.http.point_clouds import rows_of
from placecell_client.http.response import HttpResponse
from placecell_client.maps import delta_file, map_file
from placecell_client.maps.delta_file import Delta, encode_delta
from placecell_client.maps.map_file import CompactMap, decode, encode
from placecell_client.replica import ChangesPage
from placecell_client.results.alignment import MapAlignment
from placecell_client.results.anchors import (
    AnchorPose,
    Coverage,
    MapAnchor,
    MapAnchorFit,
    MapMirror,
)
from placecell_client.results.core import (
    Description,
    Info,
    Maps,
    MapSummary,
    MapVersion,
    Matches,
    PartialUpload,
    Written,
)
from placecell_client.results.localization import Localizations, Motion
from placecell_client.results.merge import Merge
from placecell_client.results.optimization import Optimization
from placecell_client.results.robots import RobotState
from placecell_client.results.scans import AddedScan, KeyScope, ScannedFile
from placecell_client.results.shapes import SegmentShape

T = TypeVar("T")

PointCloudFile = Union[bytes, str, "PathLike[str]"]
"""Point cloud file: its path, or its content."""

ANY = "*"
"""Any version, in the place of an ETag."""

ALIGNMENT_SECONDS = 300.0
"""Default timeout of `align_maps` and `merge_maps`, seconds; the service's default is the same."""

COVERAGE_K = 25
"""Candidates of each segment in `coverage`: those that re-ranking looks at."""

OCTETS = "application/octet-stream"

SESSION_HEADER = "Placecell-Session"
"""Header by which a balancer sends all requests of a session to one replica."""

COMPRESSED_BYTES = 1024
"""Smallest file that is compressed, bytes."""


@dataclass(frozen=True, slots=True)
class Call(Generic[T]):
    """A request and the parser of its response.

    Attributes:
        method: HTTP method.
        path: Path below the service's address, quoted.
        read: Parser of the response. It raises a ValueError, KeyError, TypeError or similar error
            if the response has another format.
        headers: Headers of the request.
        content: Body of the request, the same bytes in every attempt.
        repeatable: Whether the request may be sent again although it may have been carried out. A
            repeatable request never undoes later writes of other clients.
        timeout: Time limit of the call and of each attempt, seconds; None for the client's.
        older: Builds the same call without the fields that earlier services do not know; it is
            sent if the service refuses such a field. None if there is no such field.
    """

    method: str
    path: str
    read: Callable[[HttpResponse], T]
    headers: dict[str, str] = field(default_factory=dict)
    content: bytes | None = None
    repeatable: bool = True
    timeout: float | None = None
    older: "Callable[[], Call[T]] | None" = None


@dataclass(frozen=True, slots=True)
class Calls:
    """Factory of calls, one method per method of the clients; `Client` documents them.

    Attributes:
        encoding: Encoding of points and descriptors.
        compress: Whether maps and deltas are compressed with gzip.
    """

    encoding: Encoding
    compress: bool = False

    def info(self) -> Call[Info]:
        """Build `GET /info`."""
        return Call("GET", "/info", parsing.info)

    def key(self) -> Call[KeyScope]:
        """Build `GET /key`."""
        return Call("GET", "/key", parsing.key)

    def scan_file(self, file: PointCloudFile, file_name: str | None) -> Call[ScannedFile]:
        """Build `POST /scans`."""
        content, name = _point_cloud(file, file_name)
        headers = {"Accept": MEDIA_TYPES[self.encoding]}
        path = f"/scans?{urlencode({'name': name})}"
        return self._upload("POST", path, content, OCTETS, parsing.scanned_file, headers)

    def add_scan(
        self,
        name: str,
        file: PointCloudFile,
        file_name: str | None,
        robot: str | None,
        position: ArrayLike,
        yaw: float,
        time: float | None,
        create: bool,
        deduplicate: bool,
        if_match: str | None,
    ) -> Call[AddedScan]:
        """Build `POST /maps/{map}/scans`."""
        content, shown = _point_cloud(file, file_name)
        (place,) = rows_of(np.asarray(position)[None], "position", 3, integers=False).tolist()
        path = _path(
            name,
            "/scans",
            name=shown,
            robot=robot,
            **dict(zip("xyz", map(repr, place), strict=True)),
            yaw=repr(float(yaw)),
            time=None if time is None else repr(float(time)),
            create="true" if create else None,
            deduplicate="true" if deduplicate else None,
        )
        headers = _conditions(if_match)
        call = self._upload("POST", path, content, OCTETS, parsing.added_scan, headers)
        return replace(call, repeatable=if_match not in (None, ANY))

    def version_changes(self, name: str, version: int) -> Call[Delta]:
        """Build `GET /maps/{map}/versions/{version}/changes`."""
        path = _path(name, f"/versions/{int(version)}/changes")
        return Call("GET", path, parsing.version_changes)

    def export(
        self,
        name: str,
        to: str,
        color: str,
        anchor: str | None,
        version: int | None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Call[bytes]:
        """Build `GET /maps/{map}/export`."""
        wanted = _filter(classes, ignore)
        path = _path(name, "/export", to=to, color=color, anchor=anchor, version=version, **wanted)
        return Call("GET", path, parsing.exported)

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Call[Description]:
        """Build `POST /describe`."""
        body, clouds = segments_of(segments, sensors, self.encoding)
        count, dropped, heights = len(segments), clouds.dropped, clouds.heights
        return self._post(
            "/describe",
            body,
            lambda answer: replace(parsing.description(answer, count, dropped), heights=heights),
        )

    def match(
        self,
        description: Description | None,
        segments: Sequence[ArrayLike] | None,
        sensors: ArrayLike | None,
        maps: Sequence[str] | None,
        k: int,
        rerank: bool,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Call[Matches]:
        """Build `POST /match`."""
        wanted = _filter(classes, ignore)
        body = _search(maps, k, tags) | wanted
        if description is not None and segments is None and sensors is None:
            rows = _usable(description)
            body |= self._codes(description, rows)
            body |= self._classes(description, rows) if wanted else {}
            added = (
                self._centroids(description, rows)
                if rerank and _has_centroids(description, rows)
                else {}
            )
            return self._with_older(
                "/match", body, added, lambda answer: parsing.matches_of(answer, description, rows)
            )
        if description is None and segments is not None and sensors is not None:
            own, clouds = segments_of(segments, sensors, self.encoding)
            dropped = clouds.dropped
            count = len(segments)
            added = {} if rerank else {"rerank": False}
            return self._with_older(
                "/match",
                body | own,
                added,
                lambda answer: parsing.matches(answer, count, dropped),
            )
        raise ValueError("Give either a description, or segments and sensors.")

    def localize(
        self,
        description: Description | None,
        segments: Sequence[ArrayLike] | None,
        sensors: ArrayLike | None,
        maps: Sequence[str] | None,
        k: int,
        motion: Motion,
        session: str | None,
        max_false_acceptance: float | None,
        hints: Hints | None = None,
        robot: str | None = None,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Call[Localizations]:
        """Build `POST /localize`."""
        wanted = _filter(classes, ignore)
        body = _search(maps, k, tags) | wanted | {"motion": motion}
        if session is not None:
            body["session"] = session
        if hints is not None:  # older services have no such fields
            body["hints"] = hints.as_dict()
        if robot is not None:
            body["robot"] = robot
        if max_false_acceptance is not None:
            body["max_false_acceptance"] = max_false_acceptance
        if description is not None and segments is None and sensors is None:
            rows = _usable(description)
            body |= self._codes(description, rows) | self._centroids(description, rows)
            body |= self._classes(description, rows) if wanted else {}
            call = self._with_older(
                "/localize",
                body,
                self._heights(description, rows),
                lambda answer: parsing.localizations_of(answer, description, rows),
            )
            return _of_session(call, session)
        if description is None and segments is not None and sensors is not None:
            own, clouds = segments_of(segments, sensors, self.encoding)
            dropped = clouds.dropped
            call = self._post(
                "/localize",
                body | own,
                lambda answer: parsing.localizations(answer, dropped),
            )
            return _of_session(call, session)
        raise ValueError("Give either a description, or segments and sensors.")

    def coverage(
        self,
        description: Description | None,
        segments: Sequence[ArrayLike] | None,
        sensors: ArrayLike | None,
        maps: Sequence[str] | None,
        tags: Sequence[str] | None,
    ) -> Call[tuple[Coverage, ...]]:
        """Build `POST /coverage`."""
        # The body is that of a match.
        call = self.match(description, segments, sensors, maps, COVERAGE_K, True, tags)
        return Call("POST", "/coverage", parsing.coverage, call.headers, call.content)

    def maps(self) -> Call[Maps]:
        """Build `GET /maps`."""
        return Call("GET", "/maps", parsing.maps)

    def put_map(
        self,
        name: str,
        compact_map: CompactMap | bytes,
        if_match: str | None,
        create_only: bool,
    ) -> Call[MapSummary]:
        """Build `PUT /maps/{map}`."""
        data = encode(compact_map) if isinstance(compact_map, CompactMap) else compact_map
        headers = _conditions(if_match) | ({"If-None-Match": "*"} if create_only else {})
        call = self._upload("PUT", _path(name), data, map_file.MEDIA_TYPE, parsing.summary, headers)
        return replace(call, repeatable=if_match != ANY)

    def uploads(self, name: str) -> Call[tuple[PartialUpload, ...]]:
        """Build `GET /maps/{map}/uploads`."""
        return Call("GET", _path(name, "/uploads"), parsing.uploads)

    def put_part(self, name: str, digest: str, offset: int, part: bytes) -> Call[int]:
        """Build `PUT /maps/{map}/uploads/{digest}`; the result is the number of received bytes."""
        path = _path(name, f"/uploads/{_quoted(digest)}", offset=offset)
        until = offset + len(part)
        return self._upload(
            "PUT", path, part, OCTETS, lambda answer: parsing.received(answer, until), {}
        )

    def complete_upload(
        self, name: str, digest: str, if_match: str | None, create_only: bool, timeout: float
    ) -> Call[MapSummary]:
        """Build `POST /maps/{map}/uploads/{digest}`."""
        headers = _conditions(if_match) | ({"If-None-Match": "*"} if create_only else {})
        return Call(
            "POST",
            _path(name, f"/uploads/{_quoted(digest)}"),
            parsing.summary,
            headers,
            repeatable=if_match != ANY,
            timeout=timeout,
        )

    def delete_upload(self, name: str, digest: str) -> Call[None]:
        """Build `DELETE /maps/{map}/uploads/{digest}`."""
        return Call("DELETE", _path(name, f"/uploads/{_quoted(digest)}"), parsing.gone)

    def edit_map(
        self,
        name: str,
        delta: Delta | bytes,
        robot: str | None,
        create: bool,
        deduplicate: bool,
        only_new: bool,
        if_match: str | None,
    ) -> Call[Written]:
        """Build `POST /maps/{map}/segments`."""
        data = encode_delta(delta) if isinstance(delta, Delta) else delta
        asked = {"create": create, "deduplicate": deduplicate, "only_new": only_new}
        flags = {flag: "true" for flag, wanted in asked.items() if wanted}
        path = _path(name, "/segments", robot=robot, **flags)
        headers = _conditions(if_match)
        call = self._upload("POST", path, data, delta_file.MEDIA_TYPE, parsing.written, headers)
        # Without a condition it changes only segments of the robot itself.
        return replace(call, repeatable=if_match != ANY)

    def get_map(
        self,
        name: str,
        version: int | None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Call[CompactMap]:
        """Build `GET /maps/{map}`; the result is the decoded map."""
        path = _path(name, version=version, **_filter(classes, ignore))
        return Call("GET", path, lambda answer: decode(parsing.file(answer)))

    def get_map_file(
        self,
        name: str,
        version: int | None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Call[bytes]:
        """Build `GET /maps/{map}`."""
        path = _path(name, version=version, **_filter(classes, ignore))
        return Call("GET", path, parsing.file)

    def changes(
        self, name: str, since: int | str, cursor: str | None, limit: int, moved: bool
    ) -> Call[ChangesPage]:
        """Build `GET /maps/{map}/changes`."""
        told = "true" if moved else None
        path = _path(name, "/changes", since=since, cursor=cursor, limit=limit, moved=told)
        return Call("GET", path, parsing.page)

    def reserve_ids(self, name: str, count: int) -> Call[NDArray[np.uint32]]:
        """Build `POST /maps/{map}/ids`."""
        return Call("POST", _path(name, "/ids", count=count), parsing.ids)

    def reset_ids(self, name: str) -> Call[range]:
        """Build `POST /maps/{map}/ids/reset`."""
        return Call("POST", _path(name, "/ids/reset"), parsing.free_ids, repeatable=False)

    def versions(self, name: str, limit: int) -> Call[tuple[MapVersion, ...]]:
        """Build `GET /maps/{map}/versions`."""
        return Call("GET", _path(name, "/versions", limit=limit), parsing.versions)

    def restore_map(
        self, name: str, version: int, if_match: str | None, dry_run: bool
    ) -> Call[Written]:
        """Build `POST /maps/{map}/versions/{version}/restore`."""
        dry = "true" if dry_run else None
        path = _path(name, f"/versions/{int(version)}/restore", dry_run=dry)
        call = self._tied("POST", path, parsing.written, if_match)
        return replace(call, repeatable=True) if dry_run else call

    def prune_map(
        self, name: str, unseen_since: float, dry_run: bool, if_match: str | None
    ) -> Call[Written]:
        """Build `POST /maps/{map}/age`."""
        dry = "true" if dry_run else None
        path = _path(name, "/age", unseen_since=repr(float(unseen_since)), dry_run=dry)
        call = self._tied("POST", path, parsing.written, if_match)
        return replace(call, repeatable=True) if dry_run else call

    def align_maps(
        self, name: str, other: str, motion: Motion, pairs: bool, timeout: float
    ) -> Call[MapAlignment]:
        """Build `POST /maps/{map}/align/{other}`."""
        asked = "true" if pairs else None
        path = _path(name, f"/align/{_quoted(other)}", motion=motion, pairs=asked)
        return Call("POST", path, parsing.alignment, timeout=timeout)

    def merge_maps(
        self,
        merged_map: str,
        maps: Sequence[str],
        dry_run: bool,
        deduplicate: bool,
        motion: Motion,
        if_match: str | None,
        timeout: float,
        rigid: bool = True,
    ) -> Call[Merge]:
        """Build `POST /maps/{map}/merge`."""
        body: dict[str, Any] = {
            "maps": list(maps),
            "dry_run": dry_run,
            "deduplicate": deduplicate,
            "motion": motion,
        }
        if not rigid:  # services of earlier releases do not know it
            body["rigid"] = False
        call = self._tied("POST", _path(merged_map, "/merge"), parsing.merge, if_match)
        # The body is small, so it is always JSON.
        return replace(
            call,
            headers=call.headers | {"Content-Type": MEDIA_TYPES["json"]},
            content=dumps(body, "json"),
            repeatable=call.repeatable or dry_run,
            timeout=timeout,
        )

    def optimize_map(
        self, name: str, dry_run: bool, frames: bool, if_match: str | None, timeout: float
    ) -> Call[Optimization]:
        """Build `POST /maps/{map}/optimize`."""
        asked = {"dry_run": dry_run or None, "frames": frames or None}
        options = {key: "true" for key, value in asked.items() if value}
        path = _path(name, "/optimize", **options)
        call = self._tied("POST", path, parsing.optimization, if_match)
        return replace(call, repeatable=call.repeatable or dry_run, timeout=timeout)

    def segment_shape(self, name: str, segment: int) -> Call[SegmentShape]:
        """Build `GET /maps/{map}/segments/{id}/shape`."""
        return Call("GET", _path(name, f"/segments/{segment}/shape"), parsing.segment_shape)

    def segment_shapes(self, name: str, segments: Sequence[int]) -> Call[list[SegmentShape]]:
        """Build `GET /maps/{map}/shapes`."""
        return Call("GET", _path(name, "/shapes", id=list(segments)), parsing.segment_shapes)

    def compact_map(self, name: str, keep: int) -> Call[int]:
        """Build `POST /maps/{map}/compact`."""
        path = _path(name, "/compact", keep=keep)
        return Call("POST", path, parsing.oldest, repeatable=False)

    def delete_map(self, name: str, if_match: str | None) -> Call[None]:
        """Build `DELETE /maps/{map}`."""
        return self._tied("DELETE", _path(name), parsing.gone, if_match)

    def tags(self, name: str) -> Call[tuple[str, ...]]:
        """Build `GET /maps/{map}/tags`."""
        return Call("GET", _path(name, "/tags"), parsing.tags)

    def set_tags(self, name: str, tags: Sequence[str]) -> Call[tuple[str, ...]]:
        """Build `PUT /maps/{map}/tags`."""
        return self._json("PUT", _path(name, "/tags"), {"tags": list(tags)}, parsing.tags)

    def mirror(self, name: str) -> Call[MapMirror | None]:
        """Build `GET /maps/{map}` as JSON."""
        headers = {"Accept": MEDIA_TYPES["json"]}
        return Call("GET", _path(name), parsing.mirror, headers=headers)

    def set_mirror(self, name: str, source: str, etag: str) -> Call[MapMirror]:
        """Build `PUT /maps/{map}/mirror`."""
        body = {"source": source, "etag": etag}
        return self._json("PUT", _path(name, "/mirror"), body, parsing.new_mirror)

    def delete_mirror(self, name: str) -> Call[None]:
        """Build `DELETE /maps/{map}/mirror`."""
        return Call("DELETE", _path(name, "/mirror"), parsing.gone)

    def anchor(self, name: str) -> Call[MapAnchor]:
        """Build `GET /maps/{map}/anchor`."""
        return Call("GET", _path(name, "/anchor"), parsing.anchor)

    def set_anchor(
        self,
        name: str,
        lat: float,
        lon: float,
        height: float,
        yaw_deg: float,
        accuracy: float,
        position: ArrayLike,
    ) -> Call[MapAnchor]:
        """Build `PUT /maps/{map}/anchor`."""
        body = {
            "lat": float(lat),
            "lon": float(lon),
            "height": float(height),
            "yaw_deg": float(yaw_deg),
            "accuracy": float(accuracy),
            "position": np.asarray(position, np.float64).tolist(),
        }
        return self._json("PUT", _path(name, "/anchor"), body, parsing.anchor)

    def delete_anchor(self, name: str) -> Call[None]:
        """Build `DELETE /maps/{map}/anchor`."""
        return Call("DELETE", _path(name, "/anchor"), parsing.gone)

    def fit_anchor(
        self,
        name: str,
        positions: ArrayLike,
        lats: ArrayLike,
        lons: ArrayLike,
        heights: ArrayLike | None,
        accuracies: ArrayLike,
        dry_run: bool,
    ) -> Call[MapAnchorFit]:
        """Build `POST /maps/{map}/anchor/fit`."""
        points = rows_of(positions, "positions", 3, integers=False)
        count = len(points)
        columns = {"lat": lats, "lon": lons, "height": heights, "accuracy": accuracies}
        values = {
            key: np.broadcast_to(np.asarray(each, np.float64), (count,)).tolist()
            for key, each in columns.items()
            if each is not None
        }
        fixes = [
            {"position": point} | {key: column[row] for key, column in values.items()}
            for row, point in enumerate(np.asarray(points, np.float64).tolist())
        ]
        body = {"fixes": fixes, "dry_run": dry_run}
        return self._json("POST", _path(name, "/anchor/fit"), body, parsing.anchor_fit)

    def anchors(
        self, name: str, after: str | None = None
    ) -> Call[tuple[tuple[AnchorPose, ...], str | None]]:
        """Build `GET /maps/{map}/anchors`; the result is a page and the name to continue after."""
        return Call("GET", _path(name, "/anchors", after=after), parsing.named_anchors)

    def named_anchor(self, name: str, anchor: str) -> Call[AnchorPose]:
        """Build `GET /maps/{map}/anchors/{anchor}`."""
        return Call("GET", _path(name, f"/anchors/{_quoted(anchor)}"), parsing.named_anchor)

    def set_named_anchor(
        self, name: str, anchor: str, position: ArrayLike, orientation: ArrayLike
    ) -> Call[AnchorPose]:
        """Build `PUT /maps/{map}/anchors/{anchor}`."""
        body = {
            "position": np.asarray(position, np.float64).tolist(),
            "orientation": np.asarray(orientation, np.float64).tolist(),
        }
        path = _path(name, f"/anchors/{_quoted(anchor)}")
        return self._json("PUT", path, body, parsing.named_anchor)

    def delete_named_anchor(self, name: str, anchor: str) -> Call[None]:
        """Build `DELETE /maps/{map}/anchors/{anchor}`."""
        return Call("DELETE", _path(name, f"/anchors/{_quoted(anchor)}"), parsing.gone)

    def report_pose(
        self,
        robot: str,
        map_name: str | None,
        position: ArrayLike | None,
        orientation: ArrayLike | None,
        covariance: ArrayLike | None,
        probability: float | None,
        state: str,
        reason: str,
        time: float | None,
    ) -> Call[RobotState]:
        """Build `PUT /robots/{robot}`."""
        arrays = {"position": position, "orientation": orientation, "covariance": covariance}
        values = {
            name: np.asarray(each, np.float64).tolist()
            for name, each in arrays.items()
            if each is not None
        }
        others = {"map": map_name, "probability": probability, "time": time}
        body = {"state": state, "reason": reason, **values}
        body |= {name: each for name, each in others.items() if each is not None}
        return self._json("PUT", f"/robots/{_quoted(robot)}", body, parsing.robot)

    def robot(self, robot: str) -> Call[RobotState]:
        """Build `GET /robots/{robot}`."""
        return Call("GET", f"/robots/{_quoted(robot)}", parsing.robot)

    def robots(self, after: str = "") -> Call[tuple[tuple[RobotState, ...], str | None]]:
        """Build `GET /robots`; the result is one page and the name to continue after."""
        query = f"?{urlencode({'after': after})}" if after else ""
        return Call("GET", f"/robots{query}", parsing.robots)

    def _json(
        self,
        method: str,
        path: str,
        body: dict[str, Any],
        read: Callable[[HttpResponse], T],
        repeatable: bool = True,
    ) -> Call[T]:
        """Build a request with a small body, which is always JSON."""
        headers = {"Content-Type": MEDIA_TYPES["json"]}
        return Call(method, path, read, headers, dumps(body, "json"), repeatable=repeatable)

    def _tied(
        self, method: str, path: str, read: Callable[[HttpResponse], T], if_match: str | None
    ) -> Call[T]:
        """Build a write that is repeatable only if it depends on a version."""
        repeatable = if_match not in (None, ANY)
        return Call(method, path, read, _conditions(if_match), repeatable=repeatable)

    def _upload(
        self,
        method: str,
        path: str,
        data: bytes,
        media_type: str,
        read: Callable[[HttpResponse], T],
        headers: dict[str, str],
    ) -> Call[T]:
        headers = headers | {"Content-Type": media_type}
        if self.compress and len(data) > COMPRESSED_BYTES:
            # mtime=0: equal maps are equal uploads.
            packed = gzip.compress(data, mtime=0)
            if len(packed) < len(data):
                data = packed
                headers["Content-Encoding"] = "gzip"
        return Call(method, path, read, headers, data)

    def _codes(self, description: Description, rows: list[int]) -> dict[str, Any]:
        """Return the part of a body that holds codes."""
        codes = codes_of(description.codes[rows], self.encoding)
        return {"model_id": description.model_id, "codes": codes}

    def _classes(self, description: Description, rows: list[int]) -> dict[str, Any]:
        """Return the part of a body that holds the classes of codes, if they are known."""
        if description.classes is None:
            return {}
        return {"query_classes": classes_of(description.classes[rows], self.encoding)}

    def _centroids(self, description: Description, rows: list[int]) -> dict[str, Any]:
        """Return the part of a body that holds the centroids of codes."""
        return {"centroids": centroids_of(description.centroids[rows], self.encoding)}

    def _heights(self, description: Description, rows: list[int]) -> dict[str, Any]:
        """Return the part of a body that holds the heights of codes, if they are known."""
        if description.heights is None:
            return {}
        heights = description.heights[rows].tolist()
        return {"heights": [each if math.isfinite(each) else None for each in heights]}

    def _post(self, path: str, body: dict[str, Any], read: Callable[[HttpResponse], T]) -> Call[T]:
        media_type = MEDIA_TYPES[self.encoding]
        headers = {"Content-Type": media_type, "Accept": media_type}
        return Call("POST", path, read, headers, dumps(body, self.encoding))

    def _with_older(
        self,
        path: str,
        body: dict[str, Any],
        added: dict[str, Any],
        read: Callable[[HttpResponse], T],
    ) -> Call[T]:
        """Build a POST with added fields, which earlier services do not know."""
        call = self._post(path, body | added, read)
        if not added:
            return call
        return replace(call, older=lambda: self._post(path, body, read))


def _of_session(call: Call[T], session: str | None) -> Call[T]:
    """Return a call with the header of its session; a hash, as an id may have any characters."""
    if session is None:
        return call
    digest = hashlib.sha256(session.encode()).hexdigest()[:16]
    older = call.older
    return replace(
        call,
        headers=call.headers | {SESSION_HEADER: digest},
        older=None if older is None else lambda: _of_session(older(), session),
    )


def _search(
    maps: Sequence[str] | None, k: int, tags: Sequence[str] | None = None
) -> dict[str, Any]:
    """Return the part of a body that selects the maps."""
    names = {} if maps is None else {"maps": list(maps)}
    # Older services have no tags.
    return {"k": k} | names | ({} if tags is None else {"tags": list(tags)})


def _filter(classes: Sequence[str] | None, ignore: str | Sequence[str] | None) -> dict[str, Any]:
    """Return the part of a request that filters segments by class; older services have no such."""
    wanted: dict[str, Any] = {}
    if classes is not None:
        wanted["classes"] = [classes] if isinstance(classes, str) else list(classes)
    if ignore is not None:
        wanted["ignore"] = [ignore] if isinstance(ignore, str) else list(ignore)
    return wanted


def _has_centroids(description: Description, rows: list[int]) -> bool:
    """Return whether these rows of a description have centroids, which re-ranking needs."""
    centroids = description.centroids
    return centroids.shape[1:] == (3,) and bool(np.isfinite(centroids[rows]).all())


def _usable(description: Description) -> list[int]:
    """Return the rows that have a descriptor."""
    return [row for row in range(len(description.codes)) if row not in description.errors]


def _point_cloud(file: PointCloudFile, name: str | None) -> tuple[bytes, str]:
    """Return the content of a point cloud file, and the name that the service sees.

    Raises:
        OSError: The file cannot be read.
    """
    if isinstance(file, bytes):
        return file, name or "scan"
    return Path(file).read_bytes(), name or Path(file).name


def _path(name: str, way: str = "", /, **query: object) -> str:
    """Return the path of a map or of a part of it; query values that are None are left out."""
    path = f"/maps/{_quoted(name)}{way}"
    given = {key: value for key, value in query.items() if value is not None}
    return f"{path}?{urlencode(given, doseq=True)}" if given else path


def _quoted(name: str) -> str:
    """Quote one part of a path."""
    # Slashes are quoted too, so that the service refuses such a name instead of reading a path.
    # Dots are quoted, because a proxy would resolve `..`.
    return quote(name, safe="").replace(".", "%2E")


def _conditions(if_match: str | None) -> dict[str, str]:
    """Return the headers that bind a write to a version by its ETag, or to `*`."""
    if if_match is None:
        return {}
    # Results hold ETags without quotes.
    return {"If-Match": if_match if if_match == ANY else f'"{if_match}"'}
