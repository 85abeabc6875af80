"""HTTP client for threads: `Client`."""

import random
import time
from collections.abc import Callable, Iterator, Sequence
from types import TracebackType
from typing import TypeVar

import httpx
import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client import transfers
from placecell_client.hints import Hints
from placecell_client.http.attempts import Attempt
from placecell_client.http.encoding import Encoding
from placecell_client.http.errors import ServiceError
from placecell_client.http.events import (
    EventLines,
    Reconnection,
    ServerEvent,
    is_stream,
    refused,
)
from placecell_client.http.requests import ALIGNMENT_SECONDS, Call, PointCloudFile
from placecell_client.http.response import HttpResponse
from placecell_client.http.retry import USUAL, Retries
from placecell_client.http.transport import BaseClient, http_options
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.map_file import CompactMap
from placecell_client.replica import PAGE_SEGMENTS, ChangesPage, MapCopy
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
ClientT = TypeVar("ClientT", bound="Client")


class Client(BaseClient):
    """Client of one Placecell service; threads may share it.

    Use it as a context manager, or call `close`. Localize a robot by the segments of its last scan:

        from placecell_client import Client

        # segments: one array (points, 3) per segment; sensor: (3,); meters, in one z-up frame
        with Client("http://127.0.0.1:8000") as client:
            found = client.localize(segments=segments, sensors=sensor, maps=["yard"])
            if found.best is not None:
                print(found.best.pose.matrix)  # from the robot's frame to the map's frame

    Every method raises `ServiceError` if the service refuses the request or its answer is
    unreadable, and `httpx.TransportError` if the service cannot be reached or does not answer in
    time.

    The client repeats a call after a temporary failure (statuses 429, 502, 503, 504 and connection
    errors), but only if a repetition is safe. A write may have been carried out although its answer
    was lost; a repetition could then undo later writes of other clients. An ETag as `if_match`
    makes every write safe to repeat. Without an ETag, `add_scan`, `restore_map`, `prune_map`,
    `merge_maps`, `optimize_map`, `compact_map`, `delete_map`, and every write with `if_match="*"`,
    are not repeated in this case.

    Args:
        base_url: Address of the service, such as `http://127.0.0.1:8000`.
        timeout: Time limit of a whole call in seconds, with all attempts and the waits between
            them. `align_maps` and `merge_maps` have their own `timeout`.
        transport: Replacement of the network, for tests.
        encoding: Encoding of points and descriptors: `msgpack`, or `json`, which is readable but
            larger and slower.
        key: API key, sent as `Authorization: Bearer`.
        retries: Number of attempts and waits between them.
        compress: Compress maps and deltas with gzip before sending.
        jitter: Function that returns a uniform random number from 0 to 1, for the waits.
        sleep: Function that waits a number of seconds.
        clock: Function that returns monotonic seconds.
        mirrors: Source of the mirrors that this client writes.

    Raises:
        ValueError: The address, the encoding, the timeout or the key is invalid.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
        encoding: Encoding = "msgpack",
        *,
        key: str | None = None,
        retries: Retries = USUAL,
        compress: bool = False,
        jitter: Callable[[], float] = random.random,
        sleep: Callable[[float], None] = time.sleep,
        clock: Callable[[], float] = time.monotonic,
        mirrors: str | None = None,
    ) -> None:
        super().__init__(base_url, encoding, compress, timeout, retries, jitter, clock)
        self._sleep = sleep
        self._http = httpx.Client(transport=transport, **http_options(self._base_url, key, mirrors))

    def __enter__(self: ClientT) -> ClientT:
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
        """Return version, default model, limits and costs of the service."""
        return self._send(self._calls.info())

    def key(self) -> KeyScope:
        """Return what the client's API key may do."""
        return self._send(self._calls.key())

    def scan_file(self, file: PointCloudFile, *, file_name: str | None = None) -> ScannedFile:
        """Segment a point cloud file: PCD, PLY, LAS, LAZ, KITTI's .bin, NumPy, CSV or other text.

        The service levels the points by the ground that they show.

            scan = client.scan_file("scan.pcd")
            found = client.localize(segments=scan.segments, sensors=scan.sensors)

        Args:
            file: Path of the file, or its content.
            file_name: Name of the file. Its ending tells a format that the content does not tell.
                Default: the name in the path.

        Returns:
            The segments, and the points of the scan with their segments.

        Raises:
            OSError: The file cannot be read.
        """
        return self._send(self._calls.scan_file(file, file_name))

    def add_scan(
        self,
        name: str,
        file: PointCloudFile,
        *,
        robot: str | None = None,
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        time: float | None = None,
        create: bool = False,
        deduplicate: bool = False,
        file_name: str | None = None,
        if_match: str | None = None,
    ) -> AddedScan:
        """Segment a point cloud file and add its segments to a map as one capture.

        Args:
            name: Name of the map.
            file: Path of the file, or its content, as for `scan_file`.
            robot: Robot that saw the scan. Default: the robot of the API key.
            position: Position of the sensor in the map's frame, meters.
            yaw: Angle of the sensor about the z axis in the map's frame, radians.
            time: Time of the scan, seconds. Default: now, on the service's clock.
            create: Create the map if it does not exist.
            deduplicate: Do not store segments that were seen before.
            file_name: Name of the file, as for `scan_file`.
            if_match: ETag of the version to add to, or `*` for any version.

        Returns:
            The new version, and the ids of the segments.

        Raises:
            OSError: The file cannot be read.
        """
        call = self._calls.add_scan(
            name, file, file_name, robot, position, yaw, time, create, deduplicate, if_match
        )
        return self._send(call)

    def version_changes(self, name: str, version: int) -> Delta:
        """Return the changes of one version of a map against the version before it.

        Args:
            name: Name of the map.
            version: Sequence number of the version.

        Returns:
            The added and replaced segments, and the ids of removed ones.
        """
        return self._send(self._calls.version_changes(name, version))

    def export(
        self,
        name: str,
        to: str,
        *,
        color: str = "id",
        anchor: str | None = None,
        version: int | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> bytes:
        """Return a map as a file for another program, as `placecell export` writes it.

        Args:
            name: Name of the map.
            to: Format: `ply`, `las`, `pcd`, `mcap`, `geojson`, `tum` or `g2o`.
            color: Number of a segment that decides its color: `id`, `robot`, `group` or
                `class`.
            anchor: Place of the map's origin, `LAT,LON` or `LAT,LON,YAW_DEG`, for `geojson`.
                Default: the anchor of the map.
            version: Sequence number of a version. Default: the newest.
            classes: Only segments of these classes (`placecell_client.classes.CLASSES`). A segment
                whose class is unknown has none. Default: all segments.
            ignore: Leave out segments of these classes; `movable` names vehicles and persons.
        """
        call = self._calls.export(name, to, color, anchor, version, classes, ignore)
        return self._send(call)

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """Compute the descriptors of the segments of one scan.

        Args:
            segments: Points of each segment: an array (points, 3), or a structured array with the
                fields x, y and z. Unit: meters. All segments are in one frame with z up. Points
                that are not finite are left out and counted.
            sensors: Sensor position at capture in the same frame, meters: (segments, 3), or (3,)
                for all segments.

        Returns:
            Codes, descriptors and centroids, one row per segment. Segments that cannot be used are
            listed in `errors`.

        Raises:
            ValueError: An array has a wrong shape or type, or a sensor position is not finite.
        """
        return self._send(self._calls.describe(segments, sensors))

    def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
        rerank: bool = True,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Matches:
        """Find the k nearest map segments of each query segment.

        Give either `description`, or `segments` and `sensors`.

        Args:
            description: Query segments, as `describe` returned them.
            segments: Points of the query segments, as for `describe`.
            sensors: Sensor positions, as for `describe`.
            maps: Names of the maps to search. Default: all maps of loaded models.
            k: Largest number of candidates per query.
            rerank: Order the candidates by the other segments that support them, and return the
                best k of 25. All segments must be from one scan. A description without centroids
                (NaN) is not re-ranked, and a service that is older than this option does not
                re-rank.
            tags: Search only maps that have all of these tags.
            classes: Search only map segments of these classes (`placecell_client.classes.CLASSES`).
                Segments of the request that have another class are left out.
            ignore: Leave out segments of these classes, in the maps and in the request; `movable`
                names vehicle and person. A segment of unknown class is never left out.

        Returns:
            Candidates of each query, best first.

        Raises:
            ValueError: Neither or both kinds of query are given, or an array is invalid.
        """
        return self._send(
            self._calls.match(
                description, segments, sensors, maps, k, rerank, tags, classes, ignore
            )
        )

    def localize(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 25,
        motion: Motion = "yaw",
        session: str | None = None,
        max_false_acceptance: float | None = None,
        hints: Hints | None = None,
        robot: str | None = None,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Localizations:
        """Localize the robot: compute the pose of its frame in each map.

        Give either `description`, or `segments` and `sensors`: all segments around the robot, in
        the robot's frame.

        Args:
            description: Query segments, as `describe` returned them.
            segments: Points of the query segments, as for `describe`.
            sensors: Sensor positions, as for `describe`.
            maps: Names of the maps to search. Default: all maps of loaded models.
            k: Largest number of candidates per segment.
            motion: Degrees of freedom of the pose: `yaw` (x, y, z, yaw; both frames are level) or
                `se3` (all six).
            session: Id that only this robot uses. Requests of one session have their segments in
                one odometry frame; the requests of the last seconds support each other.
            max_false_acceptance: Largest expected share of requests that get a false pose, off by
                more than 3 m or 10 degrees; more than 0 and at most 0.5. Default: 0.001, or the
                smallest value that the model supports.
            hints: Where the robot is, as far as it knows. A pose that contradicts a hint is not
                returned; no hint makes a pose more probable. The result's `hints` tells the effect.
            robot: Name of the robot. `robots` then shows its pose.
            tags: Search only maps that have all of these tags.
            classes: Search only map segments of these classes (`placecell_client.classes.CLASSES`).
                Segments of the request that have another class are left out.
            ignore: Leave out segments of these classes, in the maps and in the request; `movable`
                names vehicle and person. A segment of unknown class is never left out.

        Returns:
            One result per map, most probable first: the pose with its covariance and probability,
            or the reason why the robot is not localized. `best` is the most probable pose.

        Raises:
            ValueError: Neither or both kinds of query are given, or an array is invalid.
        """
        return self._send(
            self._calls.localize(
                description,
                segments,
                sensors,
                maps,
                k,
                motion,
                session,
                max_false_acceptance,
                hints,
                robot,
                tags,
                classes,
                ignore,
            )
        )

    def maps(self) -> Maps:
        """Return the stored maps, sorted by name, and the names of damaged maps."""
        return self._send(self._calls.maps())

    def put_map(
        self,
        name: str,
        compact_map: CompactMap | bytes,
        *,
        if_match: str | None = None,
        create_only: bool = False,
    ) -> MapSummary:
        """Store a whole map; return when it is on the service's disk.

        A file that exceeds the service's request limit is sent in parts. Each part is a call with
        its own `timeout`. The map appears when all parts have arrived. After a broken connection
        the same call continues with the missing part.

        An existing map with other content is replaced only if `if_match` names its version.
        Otherwise a `ServiceError` with status 428 is raised, or with 412 if it names an old one.

        Args:
            name: Name of the map.
            compact_map: The map, or the content of its file.
            if_match: ETag of the version to replace, or `*` for any version.
            create_only: Refuse to replace a map (status 412).

        Returns:
            The stored map.

        Raises:
            MapFileError: The map is invalid.
        """
        return self._run(transfers.put_map(self._calls, name, compact_map, if_match, create_only))

    def uploads(self, name: str) -> tuple[PartialUpload, ...]:
        """Return the unfinished uploads of a map file that belong to this API key."""
        return self._send(self._calls.uploads(name))

    def delete_upload(self, name: str, digest: str) -> None:
        """Remove an unfinished upload; the map is unchanged.

        Args:
            name: Name of the map.
            digest: SHA-256 of the whole file, as `uploads` lists it.
        """
        self._send(self._calls.delete_upload(name, digest))

    def edit_map(
        self,
        name: str,
        delta: Delta | bytes,
        *,
        robot: str | None = None,
        create: bool = False,
        deduplicate: bool = False,
        only_new: bool = False,
        if_match: str | None = None,
    ) -> Written:
        """Add, replace and remove segments atomically; return when the write is on disk.

        Without `if_match`, segments of other robots cannot be replaced or removed: a `ServiceError`
        with status 409 lists their `ids`.

        Args:
            name: Name of the map.
            delta: Changes with `since` and `until` 0, or the content of their delta file.
            robot: Robot whose segments may be removed, in addition to the robots of the changed
                segments.
            create: Create the map if it does not exist.
            deduplicate: Do not store a segment that lies within 0.5 m of a stored segment and looks
                the same; record only that it was seen. Other views of it are stored.
            only_new: Refuse to replace any segment (status 409).
            if_match: ETag of the version that the delta changes, or `*` for any version. It also
                allows changes to segments of other robots.

        Returns:
            The new version, and the numbers of changed, removed and repeated segments.

        Raises:
            MapFileError: The delta is invalid.
        """
        call = self._calls.edit_map(name, delta, robot, create, deduplicate, only_new, if_match)
        return self._send(call)

    def reserve_ids(self, name: str, count: int) -> NDArray[np.uint32]:
        """Reserve ids for new segments of a map; no other client gets the same ids.

        Args:
            name: Name of the map.
            count: Number of ids.

        Returns:
            The ids: uint32 (count,), ascending.
        """
        return self._send(self._calls.reserve_ids(name, count))

    def reset_ids(self, name: str) -> range:
        """Free the ids that no kept version of a map uses, and return them; needs an admin key.

        Ids that robots have reserved are freed too.
        """
        return self._send(self._calls.reset_ids(name))

    def pull(self, copy: MapCopy | str, limit: int = PAGE_SEGMENTS) -> MapCopy:
        """Update a local copy of a map; only the changes since its version are transferred.

        The changes arrive in pages. Each page is a call with its own `timeout`. If a page fails,
        the copy keeps its version, and the next pull continues with that page.

        Args:
            copy: Copy from an earlier pull, or the name of a map for a new copy.
            limit: Largest number of segments per page.

        Returns:
            The copy, updated to the version that was the newest when the pull began.

        Raises:
            MapFileError: A page does not fit the copy.
        """
        return self._run(transfers.pull(self._calls, copy, limit))

    def changes(
        self,
        name: str,
        since: int | str = 0,
        cursor: str | None = None,
        limit: int = PAGE_SEGMENTS,
        *,
        moved: bool = False,
    ) -> ChangesPage:
        """Return one page of the changes of a map; `pull` combines all pages.

        Args:
            name: Name of the map.
            since: ETag or sequence number of the known version; 0 requests the whole map.
            cursor: Cursor of the page, from the page before it; None requests the first page.
            limit: Largest number of segments per page.
            moved: Receive captures that moved (`Delta.moved`) instead of all their segments, from
                services that can; `apply` and `MapCopy` know them.
        """
        return self._send(self._calls.changes(name, since, cursor, limit, moved))

    def get_map(
        self,
        name: str,
        version: int | None = None,
        *,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> CompactMap:
        """Download a map and decode it.

        Args:
            name: Name of the map.
            version: Sequence number of an earlier version. Default: the newest.
            classes: Only segments of these classes (`placecell_client.classes.CLASSES`). A segment
                whose class is unknown has none. Default: all segments.
            ignore: Leave out segments of these classes; `movable` names vehicles and persons.

        Raises:
            MapFileError: The file has a version that this client cannot read.
        """
        return self._send(self._calls.get_map(name, version, classes, ignore))

    def get_map_file(
        self,
        name: str,
        version: int | None = None,
        *,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> bytes:
        """Download a map as a file.

        Args:
            name: Name of the map.
            version: Sequence number of an earlier version. Default: the newest.
            classes: Only segments of these classes (`placecell_client.classes.CLASSES`). A segment
                whose class is unknown has none. Default: all segments.
            ignore: Leave out segments of these classes; `movable` names vehicles and persons.
        """
        return self._send(self._calls.get_map_file(name, version, classes, ignore))

    def versions(self, name: str, limit: int = 100) -> tuple[MapVersion, ...]:
        """Return the kept versions of a map, newest first, at most `limit`."""
        return self._send(self._calls.versions(name, limit))

    def restore_map(
        self, name: str, version: int, if_match: str | None = None, *, dry_run: bool = False
    ) -> Written:
        """Restore an old version of a map: write a new version with its content.

        Args:
            name: Name of the map.
            version: Sequence number of the old version.
            if_match: ETag that the newest version must have; otherwise a `ServiceError` with status
                412 is raised.
            dry_run: Only count the segments that would change.
        """
        return self._send(self._calls.restore_map(name, version, if_match, dry_run))

    def prune_map(
        self,
        name: str,
        unseen_since: float,
        dry_run: bool = False,
        *,
        if_match: str | None = None,
    ) -> Written:
        """Remove segments that were last seen before a time.

        Args:
            name: Name of the map.
            unseen_since: Time in seconds, on the clock of the map's frame times.
            dry_run: Only count the segments.
            if_match: ETag that the newest version must have.

        Returns:
            The new version; `removed` is the number of removed segments.
        """
        return self._send(self._calls.prune_map(name, unseen_since, dry_run, if_match))

    def align_maps(
        self,
        name: str,
        other: str,
        *,
        motion: Motion = "yaw",
        pairs: bool = False,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> MapAlignment:
        """Align two maps: compute the pose of the other map's frame in the first map's frame.

        Nothing is written. The service may need minutes for large maps.

        Args:
            name: Name of the first map.
            other: Name of the other map.
            motion: Degrees of freedom: `yaw` (x, y, z, yaw; both frames are level) or `se3` (all
                six).
            pairs: Return the pairs of segments that agree with the pose, too.
            timeout: Time limit of the call in seconds; it replaces the client's.

        Returns:
            The pose with its covariance and the overlap, or the reason why the maps are not
            aligned.
        """
        return self._send(self._calls.align_maps(name, other, motion, pairs, timeout))

    def merge_maps(
        self,
        merged_map: str,
        maps: Sequence[str],
        *,
        dry_run: bool = False,
        deduplicate: bool = True,
        motion: Motion = "yaw",
        rigid: bool = True,
        if_match: str | None = None,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> Merge:
        """Align maps and merge their segments into one map, which is created if needed.

        Maps that cannot be aligned are left out; `parts` of the result lists them. If no maps can
        be aligned, a `ServiceError` with status 409 is raised, and nothing is written. The service
        may need minutes.

        Args:
            merged_map: Name of the merged map. A new one takes the frame of the first of `maps`.
            maps: Names of the maps to merge. A map that has grown can be merged again.
            dry_run: Only compute the result; write nothing.
            deduplicate: Leave out segments that repeat a segment of another map.
            motion: Degrees of freedom: `yaw` (x, y, z, yaw; all frames are level) or `se3` (all
                six).
            rigid: Move each map as a whole. False also removes drift: the merged map is optimized
                before it is written, as by `optimize_map`.
            if_match: ETag that the merged map's newest version must have.
            timeout: Time limit of the call in seconds; it replaces the client's.

        Returns:
            The alignments, the outcome for each map, and the new version.
        """
        call = self._calls.merge_maps(
            merged_map, maps, dry_run, deduplicate, motion, if_match, timeout, rigid
        )
        return self._send(call)

    def optimize_map(
        self,
        name: str,
        *,
        dry_run: bool = False,
        frames: bool = False,
        if_match: str | None = None,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> Optimization:
        """Remove the drift of a map by loops within it, and write the moved map as one version.

        The service localizes the captures of the map in its other parts. Loops that drift does not
        explain are rejected and told. Restoring `previous` undoes the optimization. The service may
        need minutes. A service without the solver gives a `ServiceError` with status 501.

        Args:
            name: Name of the map.
            dry_run: Only compute the result; write nothing.
            frames: Also return each capture before and after.
            if_match: ETag that the map's newest version must have.
            timeout: Time limit of the call in seconds; it replaces the client's.

        Returns:
            The loops, how far captures move, and the new version.
        """
        call = self._calls.optimize_map(name, dry_run, frames, if_match, timeout)
        return self._send(call)

    def segment_shape(self, name: str, segment: int) -> SegmentShape:
        """Return what a stored segment looks like, decoded from its code.

        A map whose model has no decoder gives a `ServiceError` with status 409.

        Args:
            name: Name of the map.
            segment: Id of the segment.
        """
        return self._send(self._calls.segment_shape(name, segment))

    def segment_shapes(self, name: str, segments: Sequence[int]) -> list[SegmentShape]:
        """Return what some stored segments look like, by ascending id.

        Segments that the newest version of the map does not have are left out. A map whose model
        has no decoder gives a `ServiceError` with status 409.

        Args:
            name: Name of the map.
            segments: Ids of 1 to 100 segments.
        """
        return self._send(self._calls.segment_shapes(name, segments))

    def compact_map(self, name: str, keep: int = 1) -> int:
        """Drop all but the newest `keep` versions; return the oldest kept sequence number."""
        return self._send(self._calls.compact_map(name, keep))

    def delete_map(self, name: str, if_match: str | None = None) -> None:
        """Delete a map with all its versions.

        Args:
            name: Name of the map.
            if_match: ETag that the newest version must have.
        """
        self._send(self._calls.delete_map(name, if_match))

    def coverage(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        tags: Sequence[str] | None = None,
    ) -> tuple[Coverage, ...]:
        """Return how much of what the robot sees each map knows, the largest share first.

        It is a summary of `match` and gives no pose.

        Args:
            description: Query segments, as `describe` returned them.
            segments: Points of the query segments, as for `describe`.
            sensors: Sensor positions, as for `describe`.
            maps: Names of the maps to search. Default: all maps of loaded models.
            tags: Search only maps that have all of these tags.

        Raises:
            ValueError: Neither or both kinds of query are given, or an array is invalid.
        """
        return self._send(self._calls.coverage(description, segments, sensors, maps, tags))

    def tags(self, name: str) -> tuple[str, ...]:
        """Return the tags of a map, sorted."""
        return self._send(self._calls.tags(name))

    def set_tags(self, name: str, tags: Sequence[str]) -> tuple[str, ...]:
        """Replace all tags of a map; return when they are on the service's disk.

        Args:
            name: Name of the map.
            tags: Tags of 1 to 64 letters, digits, dots, dashes or underscores.
        """
        return self._send(self._calls.set_tags(name, tags))

    def anchor(self, name: str) -> MapAnchor:
        """Return the place of a map on the Earth; a `ServiceError` (404) if it has none."""
        return self._send(self._calls.anchor(name))

    def set_anchor(
        self,
        name: str,
        lat: float,
        lon: float,
        *,
        height: float = 0.0,
        yaw_deg: float = 0.0,
        accuracy: float = 0.0,
        position: ArrayLike = (0.0, 0.0, 0.0),
    ) -> MapAnchor:
        """Set the place of a map on the Earth (WGS 84).

        Args:
            name: Name of the map.
            lat: Latitude, degrees, north positive.
            lon: Longitude, degrees, east positive.
            height: Height above the ellipsoid, meters.
            yaw_deg: Angle from east to the map's x axis, degrees, counter-clockwise.
            accuracy: Standard deviation of the position along an axis, meters.
            position: Point of the map that is at this place, in the map's frame, meters. Default:
                the origin.
        """
        call = self._calls.set_anchor(name, lat, lon, height, yaw_deg, accuracy, position)
        return self._send(call)

    def delete_anchor(self, name: str) -> None:
        """Remove the place of a map on the Earth."""
        self._send(self._calls.delete_anchor(name))

    def fit_anchor(
        self,
        name: str,
        positions: ArrayLike,
        lats: ArrayLike,
        lons: ArrayLike,
        *,
        accuracies: ArrayLike,
        heights: ArrayLike | None = None,
        dry_run: bool = False,
    ) -> MapAnchorFit:
        """Fit the place of a map on the Earth to GNSS fixes of localized robots.

        Fixes that contradict the others are left out. A `ServiceError` with status 422 is raised if
        the fixes do not determine the yaw.

        Args:
            name: Name of the map.
            positions: Positions of the antenna in the map's frame, (fixes, 3), meters.
            lats: Latitudes, degrees, (fixes,).
            lons: Longitudes, degrees, (fixes,).
            accuracies: Standard deviations along an axis, meters, (fixes,) or one for all.
            heights: Heights above the ellipsoid, meters, (fixes,). Default: not known.
            dry_run: Write nothing.

        Raises:
            ValueError: An array has a wrong shape.
        """
        return self._send(
            self._calls.fit_anchor(name, positions, lats, lons, heights, accuracies, dry_run)
        )

    def anchors(self, name: str) -> tuple[AnchorPose, ...]:
        """Return the named anchors of a map, by name."""
        found, after = self._send(self._calls.anchors(name))
        while after is not None:
            more, after = self._send(self._calls.anchors(name, after))
            found += more
        return found

    def named_anchor(self, name: str, anchor: str) -> AnchorPose:
        """Return a named anchor of a map."""
        return self._send(self._calls.named_anchor(name, anchor))

    def set_named_anchor(
        self,
        name: str,
        anchor: str,
        position: ArrayLike,
        orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    ) -> AnchorPose:
        """Add or replace a named pose in a map, such as a dock; edits and merges keep it.

        Args:
            name: Name of the map.
            anchor: Name of the anchor.
            position: Position in the map's frame x, y, z, meters.
            orientation: Orientation as a quaternion x, y, z, w. Default: none.
        """
        return self._send(self._calls.set_named_anchor(name, anchor, position, orientation))

    def delete_named_anchor(self, name: str, anchor: str) -> None:
        """Remove a named pose of a map."""
        self._send(self._calls.delete_named_anchor(name, anchor))

    def mirror(self, name: str) -> MapMirror | None:
        """Return the source of a map that is a mirror; None for all other maps."""
        return self._send(self._calls.mirror(name))

    def set_mirror(self, name: str, source: str, etag: str = "") -> MapMirror:
        """Mark an empty map, or a mirror, as a read-only copy of another service's map.

        Only a client with `mirrors=source` can write to it then.

        Args:
            name: Name of the map.
            source: URL of the other service's map.
            etag: ETag of the version there that was copied last; empty before the first copy.
        """
        return self._send(self._calls.set_mirror(name, source, etag))

    def delete_mirror(self, name: str) -> None:
        """Make a mirror a map of this service, which takes writes."""
        self._send(self._calls.delete_mirror(name))

    def report_pose(
        self,
        robot: str,
        map_name: str | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        covariance: ArrayLike | None = None,
        *,
        probability: float | None = None,
        state: str = "localized",
        reason: str = "",
        time: float | None = None,
    ) -> RobotState:
        """Report the pose and state of a robot; other clients see them in `robots`.

        Args:
            robot: Name of the robot.
            map_name: Name of the map; None if the robot has no pose now.
            position: Position of the sensor in the map's frame x, y, z, meters.
            orientation: Orientation of the sensor, quaternion x, y, z, w. Default: none.
            covariance: Covariance of the pose: 3 x 3 (x, y, z), 4 x 4 (and yaw) or 6 x 6 (and
                rotations about x, y, z), meters and radians.
            probability: Probability that the pose is right.
            state: State of the robot in a word, such as `localized` or `lost`.
            reason: Reason for the state, at most 200 characters.
            time: Time of the robot's clock, Unix seconds.
        """
        return self._send(
            self._calls.report_pose(
                robot,
                map_name,
                position,
                orientation,
                covariance,
                probability,
                state,
                reason,
                time,
            )
        )

    def robots(self) -> tuple[RobotState, ...]:
        """Return the last report of each robot that this API key may see, by name."""
        found, after = self._send(self._calls.robots())
        while after is not None:
            more, after = self._send(self._calls.robots(after))
            found += more
        return found

    def robot(self, robot: str) -> RobotState:
        """Return the last report of a robot."""
        return self._send(self._calls.robot(robot))

    def events(self, last_event_id: str = "") -> Iterator[ServerEvent]:
        """Listen to what happens in the service, without end; break the loop to stop.

        A broken stream is opened again after the last event, so no event is lost as long as the
        service keeps it. Otherwise an event of the kind `missed` comes. Waits between attempts are
        those of `retries`, without a limit of attempts.

        Args:
            last_event_id: Id of an earlier event, to continue after it.

        Raises:
            ServiceError: The service refuses the stream, for example with status 401.
        """
        lines = EventLines(last_event_id)
        again = Reconnection(self._policy.retries)
        while True:
            failed: Exception | None = None
            try:
                yield from self._listen(lines, again)
            except (httpx.TransportError, ServiceError) as error:
                failed = error
            self._sleep(again.wait_after(failed, self._policy.jitter()))

    def _listen(self, lines: EventLines, again: Reconnection) -> Iterator[ServerEvent]:
        headers = again.headers(lines)
        with self._http.stream(
            "GET", "/events", headers=headers, timeout=again.timeout
        ) as response:
            if not is_stream(response):
                raise refused(response, response.read())
            for line in response.iter_lines():
                event = lines.read(line)
                if event is not None:
                    again.failures = 0
                    yield event

    def _run(self, steps: transfers.Steps[T]) -> T:
        """Send the calls of a transfer one after the other and return its result."""
        try:
            call = next(steps)
            while True:
                try:
                    result = self._send(call)
                except ServiceError as error:  # noqa: PERF203 -- the steps handle it
                    call = steps.throw(error)
                else:
                    call = steps.send(result)
        except StopIteration as done:
            value: T = done.value
            return value

    def _send(self, call: Call[T]) -> T:
        attempts = self._attempts(call)
        while True:
            try:
                return attempts.result(self._exchange(attempts.next()))
            except (httpx.TransportError, ServiceError) as error:
                wait = attempts.wait_after(error)
                if wait is None:
                    self._explain(error, attempts.request_id)
                    raise
            self._sleep(wait)

    def _exchange(self, attempt: Attempt) -> HttpResponse:
        with self._http.stream(**attempt.request, content=attempt.parts()) as response:
            try:
                parts = attempt.deadline.guard(response.iter_bytes(), httpx.ReadTimeout)
                return HttpResponse.of(response, b"".join(parts))
            except httpx.DecodingError as error:
                raise ServiceError.unreadable(HttpResponse.of(response, b""), str(error)) from error
