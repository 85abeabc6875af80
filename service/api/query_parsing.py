"""Parsing of requests for recognition: from their schemas to scans and descriptors."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any, Protocol

import numpy as np
from fastapi import Depends
from fastapi import Query as QueryValue
from numpy.typing import ArrayLike
from placecell_client.maps.compact_map import COORDINATE_LIMIT

from placecell.core.segment_classes import CLASSES, ClassFilter, encoded
from placecell.core.types import Float64, Int8, Int64, UInt8
from service.api.schemas.localization import LocalizeQuery
from service.api.schemas.recognition import ClassIn, ClassName, IgnoredName, MatchQuery, Point
from service.api.state import State
from service.core.auth import Principal
from service.core.problems import Problem, invalid_value
from service.core.timing import Timing
from service.inference.describer import Descriptors
from service.inference.scan import Scan
from service.search.query import Query


async def wanted_classes(
    classes: Annotated[
        list[ClassName] | None,
        QueryValue(
            max_length=32,
            description="Only segments of this class; repeatable. A segment whose class is unknown "
            "has none. Default: all segments.",
        ),
    ] = None,
    ignore: Annotated[
        list[IgnoredName] | None,
        QueryValue(
            max_length=32,
            description="Leave out segments of this class; repeatable. `movable` names vehicle and "
            "person. A segment whose class is unknown is never left out.",
        ),
    ] = None,
) -> ClassFilter | None:
    """Return the filter of a request's query parameters; None keeps all segments."""
    return ClassFilter.of(classes, ignore or ())


WantedClasses = Annotated[ClassFilter | None, Depends(wanted_classes)]


class HasPoints(Protocol):
    """Segment of a request, in any encoding."""

    @property
    def points(self) -> ArrayLike:
        """Return the points, (n, 3)."""

    @property
    def sensor(self) -> Point:
        """Return the sensor position."""


def read_scan(segments: Sequence[HasPoints], origin: Point | None) -> Scan:
    """Build the scan of a request's segments.

    Args:
        segments: the segments.
        origin: offset of all points and sensors; None if the request has none.

    Raises:
        Problem: 422 if a coordinate exceeds the limit once the origin is added.
    """
    clouds = [np.asarray(each.points).reshape(-1, 3) for each in segments]
    counts = np.array([len(cloud) for cloud in clouds])
    points = np.concatenate(clouds, dtype=np.float64)
    sensors = np.array([each.sensor for each in segments], np.float64)
    if origin is not None:
        points += origin
        sensors += origin
        _check_coordinates(points, sensors, counts)
    return Scan.from_points(points, counts, sensors)


def read_query(
    state: State,
    principal: Principal,
    request: MatchQuery[Any, Any, Any, Any] | LocalizeQuery[Any, Any, Any, Any],
    timing: Timing,
    rerank: bool = False,
) -> Query:
    """Build the query of a request to `/match` or `/localize`.

    Args:
        state: the service's state.
        principal: principal of the request's key.
        request: the request.
        timing: stopwatch of the request.
        rerank: re-rank the candidates.

    Raises:
        Problem: as `Engine.query`; 413 or 422 if the request exceeds a limit or is inconsistent.
    """
    limits = state.settings.limits
    if request.k > limits.k:
        raise invalid_value("/k", f"k is {request.k}; the limit is {limits.k}.")
    if request.maps is not None and len(request.maps) > limits.named_maps:
        detail = f"The request names {len(request.maps)} maps; the limit is {limits.named_maps}."
        raise invalid_value("/maps", detail)
    if request.codes is not None:
        centroids = None if request.centroids is None else np.array(request.centroids, np.float64)
        described = _read_codes(
            state, request.codes, request.model_id, centroids, _read_classes(request.query_classes)
        )
        heights = request.heights if isinstance(request, LocalizeQuery) else None
        seen: Descriptors | Scan = _with_heights(described, heights)
    else:
        assert request.segments is not None  # as the schema has checked
        seen = read_scan(request.segments, request.origin)
    wanted = ClassFilter.of(request.classes, request.ignore or ())
    return state.engine.query(
        seen, request.maps, request.k, principal, timing, rerank, request.tags, wanted
    )


def _read_classes(given: UInt8 | list[ClassIn | None] | None) -> UInt8 | None:
    """Return the request's own classes, uint8 (q,)."""
    if given is None or isinstance(given, np.ndarray):
        return given
    return encoded(
        [-1 if each is None else CLASSES.index(each.name) for each in given],
        [0.0 if each is None else each.probability for each in given],
    )


def _read_codes(
    state: State,
    given: Int8 | list[list[int]],
    model_id: str | None,
    centroids: Float64 | None,
    classes: UInt8 | None,
) -> Descriptors:
    """Return the request's own descriptors.

    Raises:
        Problem: 409 if their model is not loaded, 413 if there are too many, 422 if they do not
            fit the model or the centroids.
    """
    model = state.engine.models.named(model_id)
    codes = _code_rows(given, model.manifest.code_bytes)
    limit = state.settings.limits.segments
    if len(codes) > limit:
        raise Problem(
            413, "too-many-segments", f"{len(codes)} queries in a request; the limit is {limit}."
        )
    if centroids is not None and len(centroids) != len(codes):
        detail = f"{len(centroids)} centroids for {len(codes)} codes; expected one for each code."
        raise invalid_value("/centroids", detail)
    if classes is not None and len(classes) != len(codes):
        detail = f"{len(classes)} classes for {len(codes)} codes; expected one for each code."
        raise invalid_value("/query_classes", detail)
    return Descriptors(model.id, codes, None, centroids, {}, classes=classes)


def _with_heights(seen: Descriptors, given: Sequence[float | None] | None) -> Descriptors:
    """Return the request's own descriptors with the heights of their boxes.

    Raises:
        Problem: 422 if there is not one height for each code.
    """
    if given is None:
        return seen
    if len(given) != len(seen):
        detail = f"{len(given)} heights for {len(seen)} codes; expected one for each code."
        raise invalid_value("/heights", detail)
    return replace(seen, heights=np.array(given, np.float64))


def _code_rows(given: Int8 | list[list[int]], code_bytes: int) -> Int8:
    """Return the codes by query, int8 (q, code bytes), from a blob or from rows."""
    if isinstance(given, np.ndarray) and given.ndim == 1:
        if len(given) % code_bytes:
            detail = f"{len(given)} bytes; the model's codes have {code_bytes} bytes each."
            raise invalid_value("/codes", detail)
        return given.reshape(-1, code_bytes)
    for index, row in enumerate(given):
        if len(row) != code_bytes:
            detail = f"{len(row)} bytes; the model's codes have {code_bytes} bytes."
            raise invalid_value(f"/codes/{index}", detail)
    return np.asarray(given, dtype=np.int8)


def _check_coordinates(points: Float64, sensors: Float64, counts: Int64) -> None:
    """Check that no coordinate exceeds the limit; NaN does not.

    Raises:
        Problem: 422 with a pointer to the first coordinate that does.
    """
    is_far = np.abs(points) > COORDINATE_LIMIT
    if is_far.any():
        row, axis = np.argwhere(is_far)[0].tolist()
        segment = int(np.searchsorted(np.cumsum(counts), row, side="right"))
        point = row - int(counts[:segment].sum())
        raise _too_far(f"/segments/{segment}/points/{point}/{axis}", float(points[row, axis]))
    is_far = np.abs(sensors) > COORDINATE_LIMIT
    if is_far.any():
        segment, axis = np.argwhere(is_far)[0].tolist()
        raise _too_far(f"/segments/{segment}/sensor/{axis}", float(sensors[segment, axis]))


def _too_far(pointer: str, value: float) -> Problem:
    return invalid_value(
        pointer,
        f"The coordinate plus the origin is {value:g} m; the limit is {COORDINATE_LIMIT:g} m. "
        "Check that the origin belongs to these coordinates.",
    )
