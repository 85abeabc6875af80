"""Annotations in memory, and their writes. They belong to a map and not to one of its versions."""

import json
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from threading import Lock
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.geodesy import GeoAnchor
from placecell.core.types import Float64
from placecell.localization import Pose
from service.annotations.moving import CaptureMovement
from service.core.settings import Limits
from service.maps.layers import MapLayers
from service.maps.quotas import OverQuotaError
from service.maps.repository import OutdatedError
from service.maps.snapshot import MapEntry, MapSnapshot
from service.maps.store import Annotation, MapStore

TAG, GEO, NAMED, MIRROR = "tag", "anchor", "pose", "mirror"
"""Kinds of annotations."""

FOLLOWED = "segment"
"""Kind of the annotation that names a segment: an anchor follows its capture. Its name is that of
the anchor; it is empty for the place on the Earth."""

MAP_TAGS = 32
"""Largest number of tags of a map."""


@dataclass(frozen=True, slots=True)
class StoredGeoAnchor:
    """WGS 84 anchor of a map.

    Attributes:
        anchor: place of the map on the Earth.
        frame: name of the map's frame when the anchor was written; it is of no use in another one.
        author: name of the key that wrote it.
        time: time of the write, Unix seconds.
    """

    anchor: GeoAnchor
    frame: str
    author: str
    time: float


@dataclass(frozen=True, slots=True, eq=False)
class NamedAnchor:
    """Named pose in a map.

    Attributes:
        name: name of the anchor.
        pose: pose in the map's frame.
        frame: name of the map's frame when the anchor was written; it is of no use in another one.
        author: name of the key that wrote it.
        time: time of the write, Unix seconds.
    """

    name: str
    pose: Pose
    frame: str
    author: str
    time: float


@dataclass(frozen=True, slots=True)
class MirrorMark:
    """Mark of a map that is a read-only copy of another service's map.

    Attributes:
        source: URL of that map.
        etag: ETag of the version that was copied last; empty before the first copy.
        author: name of the key that copies it.
        time: time of the last copy, Unix seconds.
    """

    source: str
    etag: str
    author: str
    time: float


@dataclass(frozen=True, slots=True, eq=False)
class MapAnnotations:
    """Annotations of one map.

    Attributes:
        tags: tags, sorted.
        geo: WGS 84 anchor; None if the map has none.
        named: named anchors by name, sorted.
        mirror: mark of a copy of another service's map; None for a map of this service.
        followed: segment whose capture each anchor followed when captures were moved, by name; the
            empty name is the WGS 84 anchor.
    """

    tags: tuple[str, ...] = ()
    geo: StoredGeoAnchor | None = None
    named: Mapping[str, NamedAnchor] = field(default_factory=dict)
    mirror: MirrorMark | None = None
    followed: Mapping[str, int] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.tags) + (self.geo is not None) + len(self.named)


NOTHING = MapAnnotations()


class Annotations:
    """Annotations of all maps. Safe to use from many threads.

    A reader takes a `MapAnnotations`, which never changes. A writer holds the map's write lock.
    """

    def __init__(
        self, store: MapStore, limits: Limits, clock: Callable[[], float] = time.time
    ) -> None:
        """Load the annotations of all maps."""
        self._store = store
        self._limits = limits
        self._clock = clock
        self._lock = Lock()
        self._by_uid = {uid: _parsed(rows) for uid, rows in store.annotations().items()}

    def of(self, snapshot: MapEntry) -> MapAnnotations:
        """Return the annotations of a map."""
        return self._by_uid.get(snapshot.head.uid, NOTHING)

    def tags(self, snapshot: MapEntry) -> tuple[str, ...]:
        """Return the tags of a map."""
        return self.of(snapshot).tags

    def geo_anchor(self, snapshot: MapEntry) -> GeoAnchor | None:
        """Return the WGS 84 anchor of a map; None if it has none in its present frame."""
        geo = self.of(snapshot).geo
        return geo.anchor if geo is not None and geo.frame == snapshot.frame else None

    def forget(self, uid: str) -> None:
        """Forget the annotations of a map that was deleted."""
        with self._lock:
            self._by_uid.pop(uid, None)

    def reload(self, uid: str, read: Callable[[str], Sequence[Annotation]]) -> None:
        """Replace the annotations of a map by those that the store has now.

        Args:
            uid: uid of the map.
            read: reads its annotations from the store.
        """
        with self._lock:  # no write of this service comes between reading and replacing
            self._by_uid[uid] = _parsed(read(uid))

    def write(
        self,
        snapshot: MapSnapshot,
        author: str,
        put: Sequence[tuple[str, str, dict[str, Any]]],
        removed: Collection[tuple[str, str]] = (),
    ) -> MapAnnotations:
        """Add or replace annotations and remove some; on return they are durable.

        Args:
            snapshot: the map; the caller holds its write lock.
            author: name of the key.
            put: kind, name and value of each.
            removed: kind and name of each.

        Raises:
            OverQuotaError: the map, or all maps, would have too many annotations.
            StoreError: the store failed; nothing was changed.
        """
        uid, now = snapshot.head.uid, self._clock()
        rows = [Annotation(kind, name, json.dumps(value), author, now) for kind, name, value in put]
        with self._lock:
            before = self._by_uid.get(uid, NOTHING)
            # An anchor that is written anew follows the capture that is nearest then.
            written = [*((row.kind, row.name) for row in rows), *removed]
            loose = [(FOLLOWED, name) for kind, name in written if kind in {GEO, NAMED}]
            removed = [*removed, *(key for key in loose if key[1] in before.followed)]
            kept = {(each.kind, each.name): each for each in _rows_of(before)}
            for key in removed:
                kept.pop(key, None)
            kept |= {(each.kind, each.name): each for each in rows}
            after = _parsed(list(kept.values()))
            self._check(before, after)
            try:
                self._store.annotate(uid, rows, removed)
            except KeyError as error:  # another service deleted the map
                raise OutdatedError(snapshot.name) from error
            self._by_uid[uid] = after
            return after

    def moved(self, snapshot: MapSnapshot, layers: MapLayers) -> list[Annotation]:
        """Return the anchors of a map that follow captures into its next version, as rows.

        Args:
            snapshot: the map as it is.
            layers: segments of its next version.
        """
        present = self.of(snapshot)
        if (present.geo is None and not present.named) or layers.base.frame != snapshot.frame:
            return []
        movement = CaptureMovement(snapshot.layers.content(), layers.content())
        if movement.is_none:
            return []
        now, rows = self._clock(), []

        def follow(name: str, author: str, position: Float64) -> Pose | None:
            """Add the row of the followed segment; return the movement, None if there is none."""
            found = movement.bound(position, present.followed.get(name))
            if found is None or np.array_equal(found[1].matrix, np.eye(4)):
                return None
            value = json.dumps({"segment": found[0]})
            rows.append(Annotation(FOLLOWED, name, value, author, now))
            return found[1]

        geo = present.geo
        if geo is not None and geo.frame == snapshot.frame:
            move = follow("", geo.author, np.array(geo.anchor.position))
            if move is not None:
                there = geo.anchor.moved(move.rotation, move.translation)
                value = json.dumps(geo_value(there, geo.frame))
                rows.append(Annotation(GEO, "", value, geo.author, now))
        for name, each in present.named.items():
            if each.frame != snapshot.frame:
                continue
            move = follow(name, each.author, each.pose.translation)
            if move is not None:
                value = json.dumps(pose_value(move.after(each.pose), each.frame))
                rows.append(Annotation(NAMED, name, value, each.author, now))
        return rows

    def adopt(self, snapshot: MapSnapshot, rows: Sequence[Annotation]) -> None:
        """Use annotations of a map that were written with its next version."""
        uid = snapshot.head.uid
        with self._lock:
            kept = {(each.kind, each.name): each for each in _rows_of(self._by_uid[uid])}
            kept |= {(each.kind, each.name): each for each in rows}
            self._by_uid[uid] = _parsed(list(kept.values()))

    def _check(self, before: MapAnnotations, after: MapAnnotations) -> None:
        """Check the quotas; removal is never refused."""
        limits = self._limits
        for kind, old, new, most in (
            ("tags", len(before.tags), len(after.tags), MAP_TAGS),
            ("anchors", len(before.named), len(after.named), limits.map_anchors),
        ):
            if new > max(old, most):
                raise OverQuotaError(
                    f"The map would have {new} {kind}; the limit is {most}. Remove some first."
                )
        total = sum(map(len, self._by_uid.values())) - len(before) + len(after)
        if len(after) > len(before) and total > limits.annotations:
            raise OverQuotaError(
                "All maps together would have too many tags and anchors; the limit is "
                f"{limits.annotations}. Remove some first."
            )


def geo_value(anchor: GeoAnchor, frame: str) -> dict[str, Any]:
    """Return a WGS 84 anchor as the value of an annotation."""
    return asdict(anchor) | {"frame": frame}


def pose_value(pose: Pose, frame: str) -> dict[str, Any]:
    """Return a named pose as the value of an annotation."""
    return {
        "position": pose.translation.tolist(),
        "orientation": Rotation.from_matrix(pose.rotation).as_quat(canonical=True).tolist(),
        "frame": frame,
    }


def mirror_value(source: str, etag: str) -> dict[str, Any]:
    """Return the mark of a mirror as the value of an annotation."""
    return {"source": source, "etag": etag}


def _parsed(rows: Sequence[Annotation]) -> MapAnnotations:
    tags = sorted(each.name for each in rows if each.kind == TAG)
    geo = mirror = None
    named, followed = {}, {}
    for each in sorted(rows, key=lambda row: row.name):
        value = json.loads(each.value)
        if each.kind == GEO:
            frame = value.pop("frame")
            anchor = GeoAnchor(**value | {"position": tuple(value["position"])})
            geo = StoredGeoAnchor(anchor, frame, each.author, each.time)
        elif each.kind == NAMED:
            pose = Pose(
                Rotation.from_quat(value["orientation"]).as_matrix(), np.array(value["position"])
            )
            named[each.name] = NamedAnchor(each.name, pose, value["frame"], each.author, each.time)
        elif each.kind == MIRROR:
            mirror = MirrorMark(value["source"], value["etag"], each.author, each.time)
        elif each.kind == FOLLOWED:
            followed[each.name] = int(value["segment"])
    return MapAnnotations(tuple(tags), geo, named, mirror, followed)


def _rows_of(annotations: MapAnnotations) -> list[Annotation]:
    """Return the annotations as rows; authors of tags are in the store only."""
    rows = [Annotation(TAG, tag, "{}", "", 0.0) for tag in annotations.tags]
    if (geo := annotations.geo) is not None:
        value = json.dumps(geo_value(geo.anchor, geo.frame))
        rows.append(Annotation(GEO, "", value, geo.author, geo.time))
    for each in annotations.named.values():
        value = json.dumps(pose_value(each.pose, each.frame))
        rows.append(Annotation(NAMED, each.name, value, each.author, each.time))
    if (mirror := annotations.mirror) is not None:
        value = json.dumps(mirror_value(mirror.source, mirror.etag))
        rows.append(Annotation(MIRROR, "", value, mirror.author, mirror.time))
    for name, segment in annotations.followed.items():
        rows.append(Annotation(FOLLOWED, name, json.dumps({"segment": segment}), "", 0.0))
    return rows
