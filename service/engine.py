"""Engine: place recognition in one process, without a server.

    from pathlib import Path

    from service.core.settings import Settings
    from service.engine import Engine

    settings = Settings(data_dir=Path("maps"), models_dir=Path("models"), model="context")
    with Engine.open(settings) as engine:
        engine.put_map("yard", yard)
        seen = engine.describe(clouds, sensors)
        result = engine.localize(seen, maps=["yard"])
        print(result[0].localization.pose)

Here `yard` is a `CompactMap`, `clouds` holds the points of each segment, and `sensors` the sensor
positions. The HTTP service is a layer above the engine: a route parses a request, calls the engine,
and serializes the result. The engine needs no HTTP library.
"""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import Self, get_args

from numpy.typing import ArrayLike
from placecell_client import CompactMap, Delta, Hints, Info, decode, encode, encode_delta
from placecell_client.hints import SensorPose
from placecell_client.maps.map_file import VERSION

from placecell.core.cancellation import current
from placecell.core.segment_classes import ClassFilter
from placecell.descriptors.manifest import Manifest, ModelError
from placecell.descriptors.site_calibration import CalibrationState, SiteCalibration
from placecell.localization import LocalizationParameters
from placecell.map_alignment import AlignmentParameters
from placecell.pose_graph import PoseGraphParameters
from service.annotations.annotations import Annotations, MirrorMark
from service.annotations.writer import AnnotationWriter
from service.core.auth import ANYONE, Principal
from service.core.cost import check_cost, cost_of_aligning
from service.core.metrics import Metrics
from service.core.preconditions import Preconditions
from service.core.settings import Settings
from service.core.timing import Timing
from service.inference.describer import Descriptors
from service.inference.model_registry import Model, Models
from service.inference.scan import Scan
from service.live.alarms import StoreWatch
from service.live.events import EventRing
from service.live.robots import Robots
from service.maps.cache import MapCache
from service.maps.following.follower import Follower
from service.maps.history import commits_of, version_file
from service.maps.quotas import Quotas
from service.maps.repository import MapRepository
from service.maps.shared_index import Patterns
from service.maps.snapshot import MapEntry, MapSnapshot
from service.maps.store import Commit, MapStore, SharedStore, StoreError, StoreLockedError
from service.maps.stores import open_store
from service.maps.sync import MapSync, SyncPage
from service.maps.writes.maintenance import Maintenance, MaintenanceThresholds
from service.maps.writes.partial_uploads import PartialUploads
from service.maps.writes.writer import EditOptions, MapWriter, WriteResult
from service.merging.alignment import AlignedMaps, K, MapSide, align_maps, check_same_model
from service.merging.bending import OptimizedMap, Optimizer, check_solver, cost_of_loops
from service.merging.carrying import carry_anchors
from service.merging.loop_memory import LoopMemory
from service.merging.merge import Merger, MergeResult
from service.search.hints import ResolvedHints, resolve, sensor_of_codes
from service.search.localization import LocalizationResult, localize
from service.search.matching import MatchResult, match
from service.search.query import Query, query_of_codes, query_of_scan, select_maps
from service.search.sessions import RobotSession, Session, Sessions
from service.warm_up import warm_up

NO_CONDITIONS = Preconditions()

ALIGN_SMALLER = "Align smaller maps, such as parts of these."

MERGE_FEWER = "Merge fewer or smaller maps at once."
BEND_FEWER = "Merge fewer or smaller maps at once, or with rigid: true."

OPTIMIZE_SMALLER = "Optimize parts of the map, or raise the limit alignment_seconds."


class StartError(Exception):
    """Failed start of the engine or the service; the message gives the reason."""


class Engine:
    """Models and maps of one process; safe to use from many threads. Close it after use.

    Each method raises `Problem` for what the service answers with an error. A write returns when it
    is safely on disk.

    Attributes:
        settings: settings that the engine was opened with.
        metrics: counters and times.
        models: loaded models.
        maps: stored maps.
        annotations: tags and anchors of the maps.
        partial_uploads: map files that are uploaded in parts and are not complete.
        sync: incremental transfers of maps, for robots that keep a copy.
        sessions: results of robots' last requests.
        loops: loops of the last optimizations of maps.
        follower: loads what other services write to the database; None without a database.
        robots: last pose and state of each robot.
        events: what happens, for clients that listen.
    """

    def __init__(
        self, settings: Settings, metrics: Metrics, key_patterns: Callable[[], Patterns]
    ) -> None:
        """Open the data directory and load models and maps; `open` does so too.

        Raises:
            StartError: a model or the data directory cannot be used.
        """
        self.settings = settings
        self.metrics = metrics
        self._key_patterns = key_patterns
        self._open_parts = ExitStack()
        limits = settings.limits
        try:
            self.models = Models(settings, metrics)
        except ModelError as error:
            raise StartError(
                f"model {settings.model!r} cannot be loaded: {error}. Check the settings model "
                "and models_dir ('placecell config')."
            ) from error
        warm_up(self.models, limits)
        place = "database" if settings.database.get_secret_value() else "data directory"
        with ExitStack() as opened:
            try:
                store = opened.enter_context(open_store(settings))
                cache = MapCache(settings.data_dir)
                self.maps = MapRepository(
                    store,
                    self.models,
                    Quotas(limits),
                    cache,
                    patterns=settings.maps,
                    most_segments=settings.loaded_segments,
                )
            except (StoreLockedError, StoreError) as error:
                raise StartError(f"{place}: {error}") from error
            except OSError as error:
                raise StartError(f"data directory {settings.data_dir}: {error}") from error
            try:
                self.annotations = Annotations(store, limits)
            except StoreError as error:
                raise StartError(f"{place}: {error}") from error
            self.maps.on_delete = self.annotations.forget
            self.maps.anchors = self.annotations
            self.follower: Follower | None = None
            if isinstance(store, SharedStore):
                reload = partial(self.annotations.reload, read=store.annotations_of)
                self.follower = Follower(store, self.maps, reload)
                opened.enter_context(self.follower.running())
                metrics.store_lag.set_function(self.follower.lag)
            self.sync = MapSync(store)
            self.partial_uploads = PartialUploads(settings.data_dir, limits)
            self.sessions = Sessions(limits.sessions)
            self.loops = LoopMemory(cache.folder)
            self.robots = Robots(limits.robots, limits.robot_seconds)
            self.events = EventRing(limits.events, limits.event_clients)
            watch = StoreWatch(self.events, self.maps.trouble, self.maps.damaged)
            bounds = MaintenanceThresholds(
                map_bytes=limits.map_stored_bytes, all_bytes=limits.stored_bytes
            )
            maintenance = Maintenance(
                self.maps,
                self.sync,
                cache,
                bounds,
                self.partial_uploads,
                watch.check,
                _alone(store),
            )
            opened.enter_context(maintenance.running())
            self._open_parts = opened.pop_all()
        self._fill(metrics)

    @classmethod
    def open(
        cls,
        settings: Settings | None = None,
        metrics: Metrics | None = None,
        key_patterns: Callable[[], Patterns] = tuple,
    ) -> Self:
        """Open the data directory of some settings and load models and maps.

        Args:
            settings: settings as of the service; the service's own defaults unless given.
            metrics: counters and times; new ones unless given.
            key_patterns: gives the map name patterns that API keys open; only maps that the same
                keys open share an index.

        Raises:
            StartError: a model or the data directory cannot be used.
        """
        return cls(settings or Settings(), metrics or Metrics(), key_patterns)

    @classmethod
    def temporary(cls, model: Path) -> Self:
        """Open an engine with the model of a folder and no maps; closing it deletes its maps.

        Raises:
            ModelError: the folder holds no usable model.
            StartError: the model cannot be loaded.
        """
        Manifest.load(model)
        with ExitStack() as opened:
            folder = opened.enter_context(TemporaryDirectory(prefix="placecell-"))
            engine = cls.open(
                Settings(data_dir=Path(folder), models_dir=model.resolve().parent, model=model.name)
            )
            # Parts are closed in reverse order: the folder is deleted last.
            opened.push(engine._open_parts.pop_all())
            engine._open_parts = opened.pop_all()
        return engine

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
        """Stop the maintenance, end streams of events and release the data directory."""
        self.events.close()
        self._open_parts.close()

    @property
    def model(self) -> Model:
        """Return the default model."""
        return self.models.default

    def info(self) -> Info:
        """Return facts about the engine, as `Client.info` returns those of a service."""
        manifest = self.model.manifest
        return Info(
            version="",
            model_id=manifest.model_id,
            model={"name": manifest.name, "preprocessing": manifest.preprocessing},
            limits=self.settings.limits.model_dump(),
            map_file_version=VERSION,
        )

    def unready(self) -> str | None:
        """Return why requests should go to another instance; None if they should not."""
        if self.follower is not None:
            return self.follower.trouble()
        trouble = self.maps.trouble()
        return None if trouble is None else f"Maps cannot be written. {trouble}"

    def warnings(self) -> list[str]:
        """Return problems that an operator should solve although the engine works."""
        warning = None if self.follower is None else self.follower.warning()
        return [] if warning is None else [warning]

    def _fill(self, metrics: Metrics) -> None:
        """Give the gauges of maps, robots and events their values."""
        metrics.maps.set_function(lambda: len(self.maps))
        metrics.loaded_maps.set_function(lambda: len(self.maps.all()))
        metrics.robots.set_function(lambda: len(self.robots))
        metrics.event_clients.set_function(lambda: len(self.events))
        for name in get_args(CalibrationState):
            metrics.calibrated.labels(name).set_function(partial(self._maps_with, name))
        metrics.map_segments.set_function(lambda: sum(len(each) for each in self.maps.entries()))

    def _maps_with(self, state: CalibrationState) -> int:
        """Return the number of maps whose latest calibration has this state."""
        sites = (each.layers.sites.latest for each in self.maps.all())
        return sum(site is not None and site.state == state for site in sites)

    # Recognition.

    def describe(
        self,
        segments: Sequence[ArrayLike],
        sensors: ArrayLike,
        model: str | None = None,
        classified: bool = True,
    ) -> Descriptors:
        """Describe the segments of one scan.

        Args:
            segments: points of each segment, (n, 3), meters, in one z-up frame.
            sensors: sensor position of each segment, (segments, 3), or one for all, (3,).
            model: id or name of a loaded model; the default model unless given.
            classified: state the class of each segment, if the model has a semantic head.

        Raises:
            Problem: 409 if the model is not loaded, 413 if there are too many segments, 422 if no
                segment can be described.
        """
        describer = self.models.named(model).describer
        scan = Scan.from_clouds(segments, sensors)
        prepared = describer.prepare(scan, Timing(), classified=classified)
        return describer.describe_alone(prepared)

    def match(
        self,
        seen: Descriptors | Scan,
        maps: Sequence[str] | None = None,
        k: int = 10,
        principal: Principal = ANYONE,
        rerank: bool = True,
        wanted: ClassFilter | None = None,
    ) -> MatchResult:
        """Return the k nearest map segments of each segment, re-ranked if centroids are known.

        Args:
            seen: descriptors, which are searched in maps of their model; or a scan, which is
                described by the model of each map.
            maps: names of maps; all maps unless given.
            k: largest number of candidates of a segment.
            principal: principal, whose scope may not cover all maps.
            rerank: order the candidates by the neighbors that support them, the best k of 25.
            wanted: filter of the segments by class.

        Raises:
            Problem: as `query`.
        """
        timing = Timing()
        query = self.query(seen, maps, k, principal, timing, rerank, wanted=wanted)
        return self.matches(query, query.describe_alone())

    def localize(
        self,
        seen: Descriptors | Scan,
        maps: Sequence[str] | None = None,
        k: int = 25,
        parameters: LocalizationParameters | None = None,
        session: str | Session | None = None,
        principal: Principal = ANYONE,
        hints: Hints | None = None,
        wanted: ClassFilter | None = None,
    ) -> LocalizationResult:
        """Return the robot's pose in each map, or the reason for none; the most probable first.

        Args:
            seen: descriptors with centroids, or a scan: all segments around the robot.
            maps: names of maps; all maps unless given.
            k: largest number of candidates of a segment and map.
            parameters: parameters of the localization; the default ones unless given.
            session: id that this robot uses for all its requests in one odometry frame; requests of
                the last seconds support each other.
            principal: principal, whose scope may not cover all maps.
            hints: where the robot is, as far as it knows; they narrow the result.
            wanted: filter of the segments by class.

        Raises:
            Problem: as `query`; 422 if a hint is wrong.
        """
        timing = Timing()
        query = self.query(seen, maps, k, principal, timing, wanted=wanted)
        descriptors = query.describe_alone()
        return self.poses(query, descriptors, timing, parameters, session, principal, hints)

    def query(
        self,
        seen: Descriptors | Scan,
        maps: Sequence[str] | None,
        k: int,
        principal: Principal,
        timing: Timing,
        rerank: bool = False,
        tags: Sequence[str] | None = None,
        wanted: ClassFilter | None = None,
    ) -> Query:
        """Select the maps to search and prepare the segments: the first step of a search.

        The second step is `Query.describe`, the third `matches` or `poses`.

        Args:
            seen: descriptors or a scan.
            maps: names of maps; all maps unless given.
            k: largest number of candidates of a segment.
            principal: principal, whose scope may not cover all maps.
            timing: stopwatch of the request.
            rerank: re-rank the candidates.
            tags: tags that the maps must have.
            wanted: filter of the segments by class.

        Raises:
            Problem: 403 if a named map is outside the scope of the key, 404 if it does not exist,
                409 if its model is not loaded or not that of the descriptors, 413 if the request is
                too much work, 422 if no segment can be described.
        """

        def is_tagged(snapshot: MapEntry) -> bool:
            return tags is None or {*tags} <= {*self.annotations.tags(snapshot)}

        if isinstance(seen, Descriptors):
            only = self.models.named(seen.model_id)
            selection = select_maps(self.maps, self.models, maps, only, principal, is_tagged)
            limits = self.settings.limits
            return query_of_codes(seen, selection, k, limits, timing, rerank, wanted)
        selection = select_maps(self.maps, self.models, maps, None, principal, is_tagged)
        return query_of_scan(seen, self.models.default, selection, k, timing, rerank, wanted)

    def matches(self, query: Query, descriptors: Sequence[Descriptors]) -> MatchResult:
        """Search the nearest segments: the third step of a match."""
        return match(query, descriptors, self.maps, self._key_patterns())

    def poses(
        self,
        query: Query,
        descriptors: Sequence[Descriptors],
        timing: Timing,
        parameters: LocalizationParameters | None = None,
        session: str | Session | None = None,
        principal: Principal = ANYONE,
        hints: Hints | None = None,
    ) -> LocalizationResult:
        """Search the robot's pose: the third step of a localization."""
        if isinstance(session, str):
            session = RobotSession(self.sessions, principal.name, session)
        return localize(
            query=query,
            descriptors=descriptors,
            maps=self.maps,
            patterns=self._key_patterns(),
            parameters=parameters or LocalizationParameters(),
            timing=timing,
            session=session,
            resolve_hints=None
            if hints is None
            else partial(self._resolved, hints, query, descriptors, principal),
        )

    def _resolved(
        self,
        hints: Hints,
        query: Query,
        descriptors: Sequence[Descriptors],
        principal: Principal,
        sensor: SensorPose,
    ) -> ResolvedHints:
        """Put hints into the frames of the searched maps."""
        if hints.sensor is None and query.sensor is None and hints.needs_sensor:
            assert descriptors[0].centroids is not None  # `/localize` needs them
            sensor = sensor_of_codes(descriptors[0].centroids)
        return resolve(
            hints=hints,
            searched=query.selection.maps,
            sensor=sensor,
            known=lambda name: self.maps.entry(name) is not None,
            tags_of=self.annotations.tags,
            anchor_of=self.annotations.geo_anchor,
            principal=principal,
        )

    def reload_models(self) -> list[Model]:
        """Load the models anew that changed on disk, and return all; the default model first.

        Raises:
            ModelError: a model cannot be used; the loaded models stay in use.
        """
        self.models.reload()
        self.maps.index_all()
        return self.models.all()

    # Maps.

    def align(
        self, name: str, other: str, parameters: AlignmentParameters | None = None
    ) -> AlignedMaps:
        """Return the transform from another map's frame into a map's, or the reason for none.

        Args:
            name: name of the map.
            other: name of the other map.
            parameters: parameters of the alignment; the default ones unless given.

        Raises:
            Problem: 404 if there is no such map, 409 if two models made the maps, 413 if it is too
                much work.
        """
        here, there = self.maps.get(name), self.maps.get(other)
        check_same_model(here, there)
        model = self.models.named(here.model_id)
        options = parameters or AlignmentParameters()
        self.check_alignments([name, other], ALIGN_SMALLER, options)
        a, b = MapSide.of(here), MapSide.of(there)
        found = align_maps(a, b, a.index(model), model, options, current().check)
        return AlignedMaps(a, b, found)

    def calibration(self, snapshot: MapSnapshot) -> SiteCalibration | None:
        """Return the calibration of a map's match probabilities by its own segments.

        None if the model of the map is not loaded or has no site constants.
        """
        model = self.models.find(snapshot.model_id)
        layers = snapshot.layers
        return None if model is None else layers.sites.of(layers, model.manifest)

    def writer(
        self, principal: Principal = ANYONE, conditions: Preconditions = NO_CONDITIONS
    ) -> MapWriter:
        """Return a writer of maps, with the rights of a key and the conditions of a request.

        The caller checks that the key may write the map (`Principal.check_write`).
        """
        return MapWriter(self.maps, self.models, principal, conditions)

    def mirror(self, name: str) -> MirrorMark | None:
        """Return the mark of a map that is a copy of another service's; None for other maps."""
        if name in self.maps.damaged():
            return None
        entry = self.maps.entry(name)
        return None if entry is None else self.annotations.of(entry).mirror

    def annotation_writer(
        self, principal: Principal = ANYONE, conditions: Preconditions = NO_CONDITIONS
    ) -> AnnotationWriter:
        """Return a writer of tags and anchors, with the rights of a key.

        The caller checks that the key may write the map (`Principal.check_write`).
        """
        return AnnotationWriter(self.maps, self.annotations, principal, conditions)

    def put_map(
        self,
        name: str,
        content: CompactMap | bytes,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
    ) -> WriteResult:
        """Store a map, given as such or as its file; see `MapWriter.put`."""
        file = content if isinstance(content, bytes) else encode(content)
        return self._writer_to(name, principal, conditions).put(name, file)

    def get_map(self, name: str, version: int | None = None) -> CompactMap:
        """Return a stored map, or one of its earlier versions.

        Raises:
            Problem: 404 if there is no such map or version, 410 if the version is no longer kept.
        """
        snapshot = self.maps.get(name)
        if version is None:
            return snapshot.layers.content()
        file, _ = version_file(self.maps.store, snapshot, version)
        return decode(file)

    def edit_map(
        self,
        name: str,
        delta: Delta | bytes,
        robot: str | None = None,
        create: bool = False,
        deduplicate: bool = False,
        only_new: bool = False,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
    ) -> WriteResult:
        """Add, replace and remove segments of a map, all or none; see `MapWriter.edit`."""
        file = delta if isinstance(delta, bytes) else encode_delta(delta)
        return self._writer_to(name, principal, conditions).edit(
            name,
            file,
            EditOptions(robot=robot, create=create, deduplicate=deduplicate, only_new=only_new),
        )

    def delete_map(
        self, name: str, principal: Principal = ANYONE, conditions: Preconditions = NO_CONDITIONS
    ) -> None:
        """Remove a map with all its versions; see `MapWriter.delete`."""
        self._writer_to(name, principal, conditions).delete(name)

    def restore_map(
        self,
        name: str,
        version: int,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
    ) -> WriteResult:
        """Make a new version with the content of an earlier one; see `MapWriter.restore`."""
        return self._writer_to(name, principal, conditions).restore(name, version)

    def prune_map(
        self,
        name: str,
        unseen_since: float,
        dry_run: bool = False,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
    ) -> WriteResult:
        """Remove segments that were last seen before a time; see `MapWriter.prune`."""
        return self._writer_to(name, principal, conditions).prune(name, unseen_since, dry_run)

    def compact_map(self, name: str, keep: int = 1, principal: Principal = ANYONE) -> MapSnapshot:
        """Drop all but the newest versions of a map; see `MapWriter.compact`."""
        return self._writer_to(name, principal).compact(name, keep)

    def versions(self, name: str) -> list[Commit]:
        """Return the versions of a map that are kept, oldest first."""
        return commits_of(self.maps.store, self.maps.get(name))

    def changes(
        self, name: str, since: str | int = 0, limit: int = 20_000, moved: bool = False
    ) -> SyncPage:
        """Return the first page of a map's changes since a version; see `MapSync.first_page`."""
        return self.sync.first_page(self.maps.get(name), f"{since}", limit, moved)

    def merge_maps(
        self,
        name: str,
        maps: Sequence[str],
        parameters: AlignmentParameters | None = None,
        deduplicate: bool = True,
        dry_run: bool = False,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
        rigid: bool = True,
    ) -> MergeResult:
        """Align maps with each other and write their segments into one map; see `Merger.merge`.

        Raises:
            Problem: as `Merger.merge`; 403 if a map is outside the scope of the principal; 413 if
                it is too much work.
        """
        writer = self._writer_to(name, principal, conditions)
        for each in maps:
            principal.check_map(each)
        options = parameters or AlignmentParameters()
        self.check_alignments([name, *maps], MERGE_FEWER, options)
        if not rigid:
            check_solver()
            self._check_bending(name, maps)
        merger = Merger(
            writer=writer,
            parameters=options,
            deduplicate=deduplicate,
            dry_run=dry_run,
            check=current().check,
            rigid=rigid,
        )
        merged = merger.merge(name, maps)
        carried = carry_anchors(merged, name, self.maps, self.annotations, principal.name)
        return replace(merged, anchors=carried)

    def optimize_map(
        self,
        name: str,
        dry_run: bool = False,
        parameters: PoseGraphParameters | None = None,
        principal: Principal = ANYONE,
        conditions: Preconditions = NO_CONDITIONS,
    ) -> OptimizedMap:
        """Remove the drift of a map by loops within it; see `Optimizer.optimize`.

        Raises:
            Problem: as `Optimizer.optimize`; 403 if the map is outside the scope of the principal;
                413 if it is too much work.
        """
        writer = self._writer_to(name, principal, conditions)
        options = parameters or PoseGraphParameters()
        check_solver()
        cost = cost_of_loops([self.maps.get(name).layers.content()], options)
        check_cost(cost, self.settings.limits.alignment_seconds, OPTIMIZE_SMALLER)
        return Optimizer(writer, options, dry_run, current().check, self.loops).optimize(name)

    def check_alignments(
        self, names: Sequence[str], remedy: str, parameters: AlignmentParameters | None = None
    ) -> None:
        """Check that the alignments of all pairs of maps are not too much work; 413 if they are.

        Args:
            names: names of the maps; a name without a map is left out.
            remedy: what to do instead, for the error.
            parameters: parameters of the alignments; the default ones unless given.
        """
        snapshots = [entry for each in names if (entry := self.maps.entry(each)) is not None]
        sizes = [len(each) for each in snapshots]
        cost = cost_of_aligning(sizes, K, parameters or AlignmentParameters())
        check_cost(cost, self.settings.limits.alignment_seconds, remedy)

    def _check_bending(self, name: str, maps: Sequence[str]) -> None:
        """Check that the loops of maps, and of their merged map, are not too much work; 413."""
        parameters, limit = PoseGraphParameters(), self.settings.limits.alignment_seconds
        for names in ([name], maps):  # a map that was merged before is in both
            found = [each for one in names if (each := self.maps.find(one)) is not None]
            cost = cost_of_loops([each.layers.content() for each in found], parameters)
            check_cost(cost, limit, BEND_FEWER)

    def _writer_to(
        self, name: str, principal: Principal, conditions: Preconditions = NO_CONDITIONS
    ) -> MapWriter:
        """Return a writer after the check that the principal may write a map; 403 if not."""
        principal.check_write(name)
        return self.writer(principal, conditions)


def _alone(store: MapStore) -> Callable[[], AbstractContextManager[bool]]:
    """Return what yields whether this process may do maintenance of the store."""
    return store.alone if isinstance(store, SharedStore) else lambda: nullcontext(True)
