"""Parsers of successful responses.

Each function raises a ValueError, KeyError, TypeError or similar error if the response does not
have the service's format.
"""

import re
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.classes import packed
from placecell_client.hints import UsedHints
from placecell_client.http.encoding import loads, row_of
from placecell_client.http.response import HttpResponse
from placecell_client.maps import delta_file, map_file
from placecell_client.maps.compact_map import CLASS_LIMIT
from placecell_client.maps.delta_file import Delta, decode_delta
from placecell_client.replica import ChangesPage
from placecell_client.results.alignment import MapAlignment, alignment_of
from placecell_client.results.anchors import (
    AnchorPose,
    Coverage,
    MapAnchor,
    MapAnchorFit,
    MapMirror,
)
from placecell_client.results.core import (
    Candidate,
    Description,
    Info,
    ItemError,
    Maps,
    MapSummary,
    MapVersion,
    Matches,
    PartialUpload,
    Skipped,
    Written,
)
from placecell_client.results.localization import Localizations, localization_of
from placecell_client.results.merge import Merge, merge_of
from placecell_client.results.optimization import Optimization, optimization_of
from placecell_client.results.robots import RobotState
from placecell_client.results.scans import AddedScan, KeyScope, ScannedFile
from placecell_client.results.shapes import SegmentShape


def info(answer: HttpResponse) -> Info:
    """Read the response of `GET /info`."""
    content = _content(answer)
    return Info(
        version=content["version"],
        model_id=content["model"]["model_id"],
        model=content["model"],
        limits=content["limits"],
        map_file_version=content["map_file"]["version"],
        costs=content.get("costs", {}),
    )


def description(answer: HttpResponse, count: int, dropped: int = 0) -> Description:
    """Read the response of `POST /describe` to `count` segments; `dropped` points were left out."""
    content = _content(answer)
    items = _items(content["descriptors"], count)
    good = [index for index, item in enumerate(items) if "error" not in item]
    if not good:
        raise ValueError("The answer has no descriptors")
    rows = np.stack([row_of(items[index]["codes"], "int8") for index in good])
    values = np.stack([row_of(items[index]["descriptor"], "<f4") for index in good])
    if values.shape[1] != content["dimension"]:
        raise ValueError(
            f"The descriptors have {values.shape[1]} dimensions, not {content['dimension']}"
        )
    codes = np.zeros((count, rows.shape[1]), dtype=np.int8)
    descriptors = np.full((count, values.shape[1]), np.nan, dtype=np.float32)
    centroids = np.full((count, 3), np.nan)
    codes[good] = rows
    descriptors[good] = values
    for index in good:
        x, y, z = items[index]["centroid"]
        centroids[index] = x, y, z
    return Description(
        content["model_id"],
        codes,
        descriptors,
        centroids,
        _errors(items),
        dropped + _dropped(content),
        _classes(content.get("classes"), count),
    )


def _classes(given: Any, count: int) -> NDArray[np.uint8] | None:
    """Return the classes of `count` segments, from bytes or JSON; None if there are none."""
    if given is None:
        return None
    if isinstance(given, bytes):
        classes = np.frombuffer(given, np.uint8).copy()
    else:
        classes = np.array(
            [0 if each is None else packed(each["name"], each["probability"]) for each in given],
            np.uint8,
        )
    if len(classes) != count or (count and classes.max() > CLASS_LIMIT):
        raise ValueError(f"The classes are not {count} bytes of 0 to {CLASS_LIMIT}")
    return classes


def matches(answer: HttpResponse, count: int, dropped: int = 0) -> Matches:
    """Read the response of `POST /match` to `count` queries; `dropped` points were left out."""
    content = _content(answer)
    items = _items(content["queries"], count)
    return Matches(
        model_id=content["model_id"],
        queries=tuple(
            tuple(_candidate(candidate) for candidate in item["candidates"])
            if "error" not in item
            else ()
            for item in items
        ),
        errors=_errors(items),
        searched=tuple(content["searched"]),
        skipped=_skipped(content),
        dropped_points=dropped + _dropped(content),
    )


def matches_of(answer: HttpResponse, description: Description, rows: list[int]) -> Matches:
    """Read the response of `POST /match` to some rows of a description; restore its indices."""
    found = matches(answer, len(rows))
    queries: list[tuple[Candidate, ...]] = [()] * len(description.codes)
    for row, candidates in zip(rows, found.queries, strict=True):
        queries[row] = candidates
    errors = description.errors | {rows[index]: error for index, error in found.errors.items()}
    return Matches(found.model_id, tuple(queries), errors, found.searched, found.skipped)


def localizations(answer: HttpResponse, dropped: int = 0) -> Localizations:
    """Read the response of `POST /localize`; `dropped` points were left out."""
    content = _content(answer)
    return Localizations(
        model_id=content["model_id"],
        maps=tuple(localization_of(item) for item in content["localizations"]),
        errors={
            item["query"]: ItemError(
                item["error"]["type"], item["error"]["title"], item["error"]["detail"]
            )
            for item in content["unusable"]
        },
        skipped=_skipped(content),
        dropped_points=dropped + _dropped(content),
        # Older services have no such field.
        hints=None if content.get("hints") is None else UsedHints.of(content["hints"]),
    )


def localizations_of(
    answer: HttpResponse, description: Description, rows: list[int]
) -> Localizations:
    """Read the response of `POST /localize` to some rows of a description; restore its indices."""
    found = localizations(answer)
    own = np.array(rows, dtype=np.int64)
    maps = [
        replace(each, inliers=replace(each.inliers, queries=own[each.inliers.queries]))
        for each in found.maps
    ]
    return replace(found, maps=tuple(maps), errors=description.errors)


def maps(answer: HttpResponse) -> Maps:
    """Read the response of `GET /maps`."""
    content = _content(answer)
    return Maps(tuple(map(MapSummary.of, content["maps"])), tuple(content["damaged"]))


def summary(answer: HttpResponse) -> MapSummary:
    """Read the response of `PUT /maps/{map}`."""
    return MapSummary.of(_content(answer))


def file(answer: HttpResponse) -> bytes:
    """Read the response of `GET /maps/{map}`."""
    return _file(answer, map_file.MEDIA_TYPE)


def page(answer: HttpResponse) -> ChangesPage:
    """Read the response of `GET /maps/{map}/changes`."""
    delta = decode_delta(_file(answer, delta_file.MEDIA_TYPE))
    # A proxy that compresses the response makes the ETag weak.
    etag = str(answer.headers["ETag"]).removeprefix("W/").strip('"')
    if not re.fullmatch("[0-9a-f]+-[0-9]+", etag):
        raise ValueError("The answer's ETag is not a map version")
    return ChangesPage(delta, etag, answer.headers.get("Placecell-Next"))


def key(answer: HttpResponse) -> KeyScope:
    """Read the response of `GET /key`."""
    return KeyScope.of(_content(answer))


def scanned_file(answer: HttpResponse) -> ScannedFile:
    """Read the response of `POST /scans`."""
    return ScannedFile.of(_content(answer))


def added_scan(answer: HttpResponse) -> AddedScan:
    """Read the response of `POST /maps/{map}/scans`."""
    return AddedScan.of(_content(answer))


def version_changes(answer: HttpResponse) -> Delta:
    """Read the response of `GET /maps/{map}/versions/{version}/changes`."""
    return decode_delta(_file(answer, delta_file.MEDIA_TYPE))


def exported(answer: HttpResponse) -> bytes:
    """Read the response of `GET /maps/{map}/export`."""
    # A login page of a network has a success status, too, but is no download.
    if "attachment" not in answer.headers.get("Content-Disposition", ""):
        raise ValueError("The answer is not a file to save")
    return answer.content


def written(answer: HttpResponse) -> Written:
    """Read the response to a write of segments."""
    return Written.of(_content(answer))


def ids(answer: HttpResponse) -> NDArray[np.uint32]:
    """Read the response of `POST /maps/{map}/ids`."""
    content = _content(answer)
    first, count = int(content["first"]), int(content["count"])
    return np.arange(first, first + count, dtype=np.uint32)


def free_ids(answer: HttpResponse) -> range:
    """Read the response of `POST /maps/{map}/ids/reset`."""
    content = _content(answer)
    return range(content["first"], content["first"] + content["count"])


def uploads(answer: HttpResponse) -> tuple[PartialUpload, ...]:
    """Read the response of `GET /maps/{map}/uploads`."""
    return tuple(
        PartialUpload(item["digest"], item["bytes"], item["time"])
        for item in _content(answer)["uploads"]
    )


def received(answer: HttpResponse, until: int) -> int:
    """Read the response of `PUT /maps/{map}/uploads/{digest}` to a part that ends at `until`."""
    count = _content(answer)["bytes"]
    if not isinstance(count, int) or count < until:
        raise ValueError(f"The service has {count!r} bytes, not the {until} that were sent")
    return count


def versions(answer: HttpResponse) -> tuple[MapVersion, ...]:
    """Read the response of `GET /maps/{map}/versions`."""
    return tuple(MapVersion.of(item) for item in _content(answer)["versions"])


def alignment(answer: HttpResponse) -> MapAlignment:
    """Read the response of `POST /maps/{map}/align/{other}`."""
    return alignment_of(_content(answer))


def optimization(answer: HttpResponse) -> Optimization:
    """Read the response of `POST /maps/{map}/optimize`."""
    return optimization_of(_content(answer))


def segment_shape(answer: HttpResponse) -> SegmentShape:
    """Read the response of `GET /maps/{map}/segments/{id}/shape`."""
    return _shape_of(_content(answer))


def segment_shapes(answer: HttpResponse) -> list[SegmentShape]:
    """Read the response of `GET /maps/{map}/shapes`."""
    return [_shape_of(each) for each in _content(answer)["shapes"]]


def _shape_of(content: dict[str, Any]) -> SegmentShape:
    told = content["class"]
    return SegmentShape(
        id=content["id"],
        model_id=content["model_id"],
        bytes=content["bytes"],
        voxel_m=content["voxel_m"],
        points=np.array(content["points"], np.float64).reshape(-1, 3),
        class_name=None if told is None else told["name"],
    )


def merge(answer: HttpResponse) -> Merge:
    """Read the response of `POST /maps/{map}/merge`."""
    return merge_of(_content(answer))


def tags(answer: HttpResponse) -> tuple[str, ...]:
    """Read the response of `GET` and `PUT /maps/{map}/tags`."""
    return tuple(_content(answer)["tags"])


def mirror(answer: HttpResponse) -> MapMirror | None:
    """Read the mark of a mirror in the response of `GET /maps/{map}`; older services have none."""
    found = _content(answer).get("mirror")
    return None if found is None else MapMirror.of(found)


def new_mirror(answer: HttpResponse) -> MapMirror:
    """Read the response of `PUT /maps/{map}/mirror`."""
    return MapMirror.of(_content(answer))


def anchor(answer: HttpResponse) -> MapAnchor:
    """Read the response of `GET` and `PUT /maps/{map}/anchor`."""
    return MapAnchor.of(_content(answer))


def anchor_fit(answer: HttpResponse) -> MapAnchorFit:
    """Read the response of `POST /maps/{map}/anchor/fit`."""
    return MapAnchorFit.of(_content(answer))


def named_anchor(answer: HttpResponse) -> AnchorPose:
    """Read the response of `GET` and `PUT /maps/{map}/anchors/{anchor}`."""
    return AnchorPose.of(_content(answer))


def named_anchors(answer: HttpResponse) -> tuple[tuple[AnchorPose, ...], str | None]:
    """Read the response of `GET /maps/{map}/anchors`: one page, and the name to continue after."""
    content = _content(answer)
    return tuple(map(AnchorPose.of, content["anchors"])), content["next"]


def coverage(answer: HttpResponse) -> tuple[Coverage, ...]:
    """Read the response of `POST /coverage`."""
    return tuple(map(Coverage.of, _content(answer)["maps"]))


def robot(answer: HttpResponse) -> RobotState:
    """Read the response of `GET` and `PUT /robots/{robot}`."""
    return RobotState.of(_content(answer))


def robots(answer: HttpResponse) -> tuple[tuple[RobotState, ...], str | None]:
    """Read the response of `GET /robots`: one page, and the name to continue after."""
    content = _content(answer)
    return tuple(map(RobotState.of, content["robots"])), content["next"]


def oldest(answer: HttpResponse) -> int:
    """Read the response of `POST /maps/{map}/compact`."""
    return int(_content(answer)["oldest"])


def gone(answer: HttpResponse) -> None:
    """Read the response of a DELETE; a repeated one gets 404."""
    # A login page of a network has a success status, too.
    if answer.status not in {204, 404}:
        raise ValueError("The answer is not 204 No Content")


def _file(answer: HttpResponse, media_type: str) -> bytes:
    if answer.media_type != media_type:
        raise ValueError(f"The answer is not {media_type}")
    return answer.content


def _content(answer: HttpResponse) -> dict[str, Any]:
    return loads(answer.media_type, answer.content)


def _items(items: list[dict[str, Any]], count: int) -> list[dict[str, Any]]:
    if len(items) != count:
        raise ValueError(f"The answer has {len(items)} results for {count} segments")
    return items


def _skipped(content: dict[str, Any]) -> tuple[Skipped, ...]:
    return tuple(Skipped(item["map"], item["model_id"]) for item in content["skipped"])


def _dropped(content: dict[str, Any]) -> int:
    return int(content.get("dropped_points", 0))  # older services have no such field


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
        model_id=item.get("model_id", ""),  # older services have no such fields
        support=item.get("support"),
    )
