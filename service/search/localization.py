"""Localization of a robot in one map or in many maps."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from placecell_client.hints import OutsidePlace, SensorPose, UsedHints
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float64, Int8, Int64
from placecell.localization import (
    Candidates,
    Confidence,
    Hypothesis,
    Localization,
    LocalizationParameters,
    Pose,
)
from placecell.localization.covariance import at_point
from placecell.localization.evidence import Evidence, middle_of
from placecell.localization.guided_matching import MapSegments
from placecell.localization.joint import JointLocalization, MapQuery, localize_jointly
from placecell.localization.localize import threshold_of, unknown
from service.core.problems import invalid_value
from service.core.timing import Timing
from service.inference.describer import Descriptors, SegmentError
from service.inference.match_probability import QueryComparison
from service.inference.model_registry import Model
from service.live.robots import RobotPose, RobotReport
from service.maps.repository import MapRepository
from service.maps.shared_index import IndexPart, Patterns
from service.maps.snapshot import MapSnapshot
from service.search.hints import ResolvedHints, guesses_within
from service.search.links import pose_between
from service.search.matching import index_parts, nearest_segments
from service.search.parallel import in_threads, is_large
from service.search.query import MapSelection, Query
from service.search.ranking import FULL, best_of, votes_of
from service.search.sessions import Session


class StoredNeighborhood:
    """Segments of a stored map around a position, for guided matching (`MapBoxes`)."""

    def __init__(
        self, codes: Int8, model: Model, snapshot: MapSnapshot, wanted: ClassFilter | None = None
    ) -> None:
        """Compare with queries of these codes, int8 (q, code bytes), made by the map's model."""
        self._layers = snapshot.layers
        self._wanted = wanted
        site = self._layers.sites.of(self._layers, model.manifest)
        self._comparison = QueryComparison(codes, model, site, comparable=True)

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Return the rows near some places, and their centroids."""
        rows = self._layers.rows_near(places, meters, self._wanted)
        return rows, self._layers.column("centroids", rows)

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """Return the match probability of each pair of query and row."""
        codes = self._layers.column("codes", rows)
        probabilities = self._comparison.probabilities(queries, codes)
        presence = self._layers.presence(rows)
        return probabilities if presence is None else probabilities * presence

    def heights(self, rows: Int64) -> Float64:
        """Return the heights of the boxes of rows, meters; NaN: unknown."""
        return self._layers.heights(rows)


def map_query(
    codes: Int8,
    centroids: Float64,
    model: Model,
    snapshot: MapSnapshot,
    k: int,
    evidence: Evidence | None = None,
    guesses: Callable[[MapSegments, Sequence[Hypothesis]], tuple[Pose, ...]] | None = None,
    wanted: ClassFilter | None = None,
    sensor: Float64 | None = None,
    heights: Float64 | None = None,
) -> MapQuery:
    """Search the candidates in one map.

    Args:
        codes: codes of the segments around the robot, int8 (q, code bytes).
        centroids: their centroids, float64 (q, 3), meters, in the robot's frame.
        model: model that made the codes and the map.
        snapshot: the map, with an index.
        k: largest number of candidates of a segment.
        evidence: result of the robot's earlier requests.
        guesses: returns poses to try as well, given the map's segments, compared with the codes,
            and the hypotheses that were found without them.
        wanted: filter of the map's segments.
        sensor: sensor position in the robot's frame, float64 (3,), meters; None if it is not known.
        heights: heights of the segments' boxes, float64 (q,), meters; None if they are not known.
    """
    nearest = nearest_segments(codes, model, (snapshot,), k, wanted=wanted)
    there = StoredNeighborhood(codes, model, snapshot, wanted)
    queries = np.repeat(np.arange(len(codes)), nearest.rows.shape[1])
    probabilities = there.match_probabilities(queries, nearest.rows.ravel()).reshape(
        nearest.rows.shape
    )
    layers = snapshot.layers
    places = layers.column("centroids", nearest.rows)
    candidates = Candidates(
        centroids,
        nearest.rows,
        places,
        probabilities,
        sensor=sensor,
        captures=None if sensor is None else layers.capture_positions(nearest.rows),
        heights=heights,
    )
    return MapQuery(
        name=snapshot.name,
        model=model.id,
        candidates=candidates,
        there=there,
        confidence=model.confidence,
        evidence=evidence,
        guesses=None if guesses is None else partial(guesses, there),
    )


@dataclass(frozen=True, slots=True, eq=False)
class ModelQuery:
    """Query as one model describes it, with the maps that this model made.

    Attributes:
        model: the model.
        searched: the maps, each with an index.
        codes: codes of the segments around the robot, int8 (q, code bytes).
        centroids: their centroids, float64 (q, 3), meters, in the robot's frame.
        segments: index of each in the request, int64 (q,).
        heights: heights of their boxes, float64 (q,), meters; None if they are not known.
    """

    model: Model
    searched: tuple[MapSnapshot, ...]
    codes: Int8
    centroids: Float64
    segments: Int64
    heights: Float64 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class MapLocalization:
    """Localization in one map.

    Attributes:
        snapshot: the map.
        group: index of the model's query.
        segments: index in the request of each of the query's segments, int64 (q,).
        judged: pose hypotheses, after those of all maps were compared.
        is_full: whether the map was searched in full; only then is there anything to remember.
        rival: map of `judged.rival`.
    """

    snapshot: MapSnapshot
    group: int
    segments: Int64
    judged: JointLocalization
    is_full: bool
    rival: MapSnapshot | None = None

    @property
    def localization(self) -> Localization:
        """Return the pose, or the reason why there is none, and the hypotheses."""
        return self.judged.localization


@dataclass(frozen=True, slots=True, eq=False)
class LocalizationResult:
    """Result of a localization: the poses in all maps, the most probable first.

    Attributes:
        model_id: id of the model of the query's codes, or of the default model.
        selection: the maps that were searched, and those that were skipped.
        maps: localization in each map.
        errors: reason for each segment that no model describes, by index.
        dropped_points: points of the request that were not finite and were left out.
        sensor: pose of the sensor in the request's frame.
        hints: effect of the request's hints; None if it has none.
    """

    model_id: str
    selection: MapSelection
    maps: tuple[MapLocalization, ...]
    errors: dict[int, SegmentError]
    dropped_points: int
    sensor: SensorPose
    hints: UsedHints | None = None

    def __len__(self) -> int:
        return len(self.maps)

    def __iter__(self) -> Iterator[MapLocalization]:
        return iter(self.maps)

    def __getitem__(self, index: int) -> MapLocalization:
        """Return the localization in one map; the first one is the most probable."""
        return self.maps[index]


def localize(
    query: Query,
    descriptors: Sequence[Descriptors],
    maps: MapRepository,
    patterns: Patterns,
    parameters: LocalizationParameters,
    timing: Timing,
    session: Session | None = None,
    resolve_hints: Callable[[SensorPose], ResolvedHints] | None = None,
) -> LocalizationResult:
    """Localize a robot by the segments around it, in the maps of its query's selection.

    Args:
        query: the query.
        descriptors: its descriptors by each model of the selection, with centroids.
        maps: all maps.
        patterns: map name patterns that keys open; see `index_parts`.
        parameters: parameters of the localization.
        timing: stopwatch of the request.
        session: earlier requests of the same robot.
        resolve_hints: puts the request's hints into the frames of the maps, given the pose of the
            sensor in the request's frame; None if there are no hints.

    Raises:
        Problem: 422 if a model's calibration does not support the parameters'
            `max_false_acceptance`, or if a hint is wrong.
    """
    check_risk(query.selection, parameters)
    groups: list[ModelQuery] = []
    middles: dict[str, Float64] = {}
    for (model, searched), described in zip(query.selection.searched, descriptors, strict=True):
        assert described.centroids is not None
        usable = described.usable
        group = ModelQuery(
            model,
            searched,
            described.codes[usable],
            described.centroids[usable],
            usable,
            None if described.heights is None else described.heights[usable],
        )
        groups.append(group)
        middle = middle_of(group.centroids)
        middles |= {snapshot.head.uid: middle for snapshot in searched}

    def evidence(snapshot: MapSnapshot) -> Evidence | None:
        return session.evidence(snapshot, middles[snapshot.head.uid]) if session else None

    def parts(group: ModelQuery) -> list[IndexPart]:
        return index_parts(maps, group.model, group.searched, patterns)

    sensor = SensorPose((0.0, 0.0, 0.0) if query.sensor is None else query.sensor.tolist())
    hints = None if resolve_hints is None else resolve_hints(sensor)
    seen_from = query.sensor
    if hints is not None and hints.is_sensor_given:
        seen_from = np.asarray(hints.sensor.position, np.float64)
    answers = localize_among(
        groups, query.k, parameters, timing, parts, evidence, hints, query.wanted, seen_from
    )
    for each in answers:
        if session and each.is_full:
            hypotheses = each.localization.hypotheses
            session.remember(each.snapshot, middles[each.snapshot.head.uid], hypotheses)
    outside = None
    if hints is not None:
        outside = _outside(answers, hints)
        sensor, answers = hints.sensor, _narrowed(answers, hints)
    errors = set.intersection(*({*described.errors} for described in descriptors))
    return LocalizationResult(
        model_id=query.model_id,
        selection=query.selection,
        maps=tuple(answers),
        errors={index: descriptors[0].errors[index] for index in sorted(errors)},
        dropped_points=descriptors[0].dropped_points,
        sensor=sensor,
        hints=None if hints is None else _used(hints, query.selection, outside),
    )


def _narrowed(answers: Sequence[MapLocalization], hints: ResolvedHints) -> list[MapLocalization]:
    """Return the localizations without the poses that the hints exclude, in their order."""
    narrowed = []
    for each in answers:
        told = hints.narrowed(each.snapshot, each.localization)
        narrowed.append(replace(each, judged=replace(each.judged, localization=told)))
    return sorted(narrowed, key=_sort_key)


def _outside(answers: Sequence[MapLocalization], hints: ResolvedHints) -> OutsidePlace | None:
    """Return the best place outside the hints if it is more probable than all within them."""
    inside, best = 0.0, None
    for each in answers:
        found = each.localization
        if found.best is None:
            continue
        if hints.allow(each.snapshot, found.best.pose):
            inside = max(inside, found.probability)
        elif best is None or found.probability > best.localization.probability:
            best = each
    if best is None or best.localization.best is None or best.localization.probability <= inside:
        return None
    pose = best.localization.best.pose
    x, y, z = pose.apply(np.asarray(hints.sensor.position, np.float64)).tolist()
    yaw = float((pose.yaw + hints.sensor.yaw + np.pi) % (2 * np.pi) - np.pi)
    return OutsidePlace(
        best.snapshot.name, best.snapshot.frame, (x, y, z), yaw, best.localization.probability
    )


def _used(hints: ResolvedHints, selection: MapSelection, outside: OutsidePlace | None) -> UsedHints:
    allowed = [each.name for each in selection.maps if each.head.uid in hints.areas]
    return UsedHints(hints.used, hints.unused, tuple(allowed), outside)


def report_of(robot: str, result: LocalizationResult) -> RobotReport:
    """Return a robot's report by its localization: the pose of its sensor, or the reason for none.

    Args:
        robot: name of the robot.
        result: result of its request.
    """
    best = result[0] if len(result) else None
    found = None if best is None else best.localization
    if best is None or found is None or found.pose is None or found.best is None:
        reason = "no map was searched" if found is None or found.reason is None else found.reason
        return RobotReport(robot, None, "not-localized", reason, None, "localize")
    point = np.asarray(result.sensor.position, np.float64)
    there = found.pose.after(Pose.of_yaw(result.sensor.yaw, point))
    x, y, z = there.translation.tolist()
    i, j, k, w = Rotation.from_matrix(there.rotation).as_quat(canonical=True).tolist()
    covariance = at_point(found.best.covariance, found.pose, point).tolist()
    pose = RobotPose(
        map=best.snapshot.name,
        position=(x, y, z),
        orientation=(i, j, k, w),
        covariance=tuple(map(tuple, covariance)),
        probability=found.probability,
    )
    return RobotReport(robot, pose, "localized", "", None, "localize")


def check_risk(selection: MapSelection, parameters: LocalizationParameters) -> None:
    """Check that the calibration of each searched model supports `max_false_acceptance`.

    Raises:
        Problem: 422 if one does not.
    """
    if parameters.max_false_acceptance is None:
        return  # the default follows from each model's calibration
    for model, _ in selection.searched:
        try:
            threshold_of(parameters, model.confidence)
        except ValueError as error:
            raise invalid_value("/max_false_acceptance", f"{error}") from error


def localize_among(
    groups: Sequence[ModelQuery],
    k: int,
    parameters: LocalizationParameters,
    timing: Timing,
    parts: Callable[[ModelQuery], list[IndexPart]],
    evidence: Callable[[MapSnapshot], Evidence | None],
    hints: ResolvedHints | None = None,
    wanted: ClassFilter | None = None,
    sensor: Float64 | None = None,
) -> list[MapLocalization]:
    """Localize the robot in any of the maps, the most probable first.

    If there are more than a few maps, all are searched at once. The maps in which most segments
    agree are then searched in full and judged together. So the work is bounded, however many maps
    there are.

    Args:
        groups: the query by each model.
        k: largest number of candidates of a segment and map.
        parameters: parameters of the localization.
        timing: stopwatch of the request.
        parts: gives the parts of the search in a model's maps at once.
        evidence: gives the result of the robot's earlier requests in a map.
        hints: where the robot says that it is.
        wanted: filter of the segments of the maps.
        sensor: sensor position in the request's frame, float64 (3,), meters; None if it is not
            known.
    """
    past = {
        (number, place): evidence(snapshot)
        for number, group in enumerate(groups)
        for place, snapshot in enumerate(group.searched)
    }
    chosen = _chosen(groups, past, parameters, parts, hints, wanted)

    def query(place_of: tuple[int, int]) -> MapQuery:
        number, place = place_of
        current().check()
        group = groups[number]
        return map_query(
            codes=group.codes,
            centroids=group.centroids,
            model=group.model,
            snapshot=group.searched[place],
            k=k,
            evidence=past[number, place],
            guesses=None
            if hints is None
            else partial(_guesses, group, group.searched[place], parameters, hints, wanted),
            wanted=wanted,
            sensor=sensor,
            heights=group.heights,
        )

    pairs = sum(
        len(groups[number].codes) * len(groups[number].searched[place]) for number, place in chosen
    )
    together = len(chosen) > 1 and is_large(pairs)
    queries = [*(in_threads(query, chosen) if together else map(query, chosen))]
    timing.lap("search")
    maps = [groups[number].searched[place] for number, place in chosen]
    judged = localize_jointly(
        queries, parameters, lambda one, other: pose_between(maps[one], maps[other])
    )
    full = dict(zip(chosen, judged, strict=True))
    answers = []
    for number, group in enumerate(groups):
        for place, snapshot in enumerate(group.searched):
            of_map = full.get((number, place))
            if of_map is None:
                usable = len(group.codes) if len(snapshot) else 0
                told = not_searched(usable, parameters, group.model.confidence, len(chosen))
                of_map = JointLocalization(told, 0.0)
            answers.append(
                MapLocalization(
                    snapshot=snapshot,
                    group=number,
                    segments=group.segments,
                    judged=of_map,
                    is_full=(number, place) in full,
                    rival=None if of_map.rival is None else maps[of_map.rival.map],
                )
            )
    timing.lap("verify")
    return sorted(answers, key=_sort_key)


def _guesses(
    group: ModelQuery,
    snapshot: MapSnapshot,
    parameters: LocalizationParameters,
    hints: ResolvedHints,
    wanted: ClassFilter | None,
    there: MapSegments,
    found: Sequence[Hypothesis],
) -> tuple[Pose, ...]:
    """Return poses within the hints to try in a map, if no hypothesis is within them."""
    area = hints.areas.get(snapshot.head.uid)
    if area is None or any(area.holds(each.pose, hints.sensor) for each in found):
        return ()
    return guesses_within(
        area=area,
        sensor=hints.sensor,
        codes=group.codes,
        centroids=group.centroids,
        model=group.model,
        snapshot=snapshot,
        there=there,
        parameters=parameters,
        wanted=wanted,
    )


def not_searched(
    usable: int, parameters: LocalizationParameters, confidence: Confidence, full: int
) -> Localization:
    """Return the localization of a map that was not searched in full."""
    told = unknown(usable, parameters, confidence)
    if told.reason != "inconsistent" or not full:
        return told
    detail = (
        f"Fewer segments agree than in the {full} best maps, which were searched in full. "
        "Name this map in 'maps' to search it in full."
    )
    return replace(told, detail=detail)


def _sort_key(answer: MapLocalization) -> tuple[bool, float, float, str]:
    """Return the sort key of an answer: localized first, by probability, then by score.

    The name orders answers that are equal otherwise, such as those of maps without a candidate.
    """
    localization = answer.localization
    return (
        localization.pose is None,
        -localization.probability,
        -answer.judged.total,
        answer.snapshot.name,
    )


def _chosen(
    groups: Sequence[ModelQuery],
    past: dict[tuple[int, int], Evidence | None],
    parameters: LocalizationParameters,
    parts: Callable[[ModelQuery], list[IndexPart]],
    hints: ResolvedHints | None = None,
    wanted: ClassFilter | None = None,
) -> list[tuple[int, int]]:
    """Choose the maps to search in full, by group and index.

    Half of them at most are those in which the robot was before, and those that the hints allow.
    """
    every = list(past)
    if len(every) <= FULL:
        return every
    votes = np.concatenate(
        [
            votes_of(group.codes, group.centroids, group.searched, parts(group), parameters, wanted)
            for group in groups
        ]
    )
    known = [index for index, each in enumerate(every) if (before := past[each]) and before.past]
    known.sort(key=lambda index: -votes[index])
    if hints is not None:
        areas = hints.areas
        hinted = [
            index
            for index, (number, place) in enumerate(every)
            if index not in known and groups[number].searched[place].head.uid in areas
        ]
        known += sorted(hinted, key=lambda index: -votes[index])
    return [every[index] for index in best_of(votes, parameters.least_segments, known)]
