"""Writes of annotations for one request, under its key and its preconditions."""

from collections.abc import Sequence
from dataclasses import dataclass

from placecell.core.geodesy import GeoAnchor
from placecell.localization import Pose
from service.annotations.annotations import (
    GEO,
    MIRROR,
    NAMED,
    TAG,
    Annotations,
    MapAnnotations,
    MirrorMark,
    NamedAnchor,
    StoredGeoAnchor,
    geo_value,
    mirror_value,
    pose_value,
)
from service.core.auth import Principal
from service.core.preconditions import Preconditions
from service.core.problems import Problem
from service.maps.repository import MapRepository
from service.maps.snapshot import MapSnapshot
from service.maps.writes.newest import on_newest


@dataclass(frozen=True, slots=True)
class AnnotationWriter:
    """Writes annotations of maps for one request.

    A key that is bound to a robot replaces and removes only anchors that it wrote itself, and no
    tags. The caller checks that the key may write the map.

    Attributes:
        maps: the repository.
        annotations: annotations of all maps.
        principal: principal of the request.
        conditions: preconditions of the request, about the map's version.
    """

    maps: MapRepository
    annotations: Annotations
    principal: Principal
    conditions: Preconditions

    @on_newest
    def set_tags(self, name: str, tags: Sequence[str]) -> MapAnnotations:
        """Replace the tags of a map."""
        self.principal.check_all()
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.tags(snapshot)
            if sorted({*tags}) == list(before):
                return self.annotations.of(snapshot)
            return self.annotations.write(
                snapshot,
                self.principal.name,
                [(TAG, tag, {}) for tag in sorted({*tags} - {*before})],
                [(TAG, tag) for tag in before if tag not in tags],
            )

    @on_newest
    def set_geo(self, name: str, anchor: GeoAnchor) -> tuple[MapSnapshot, StoredGeoAnchor]:
        """Set the WGS 84 anchor of a map."""
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.of(snapshot).geo
            self._check_author(before)
            value = geo_value(anchor, snapshot.frame)
            if before is None or geo_value(before.anchor, before.frame) != value:
                self.annotations.write(snapshot, self.principal.name, [(GEO, "", value)])
            after = self.annotations.of(snapshot).geo
            assert after is not None  # it was written
            return snapshot, after

    @on_newest
    def remove_geo(self, name: str) -> None:
        """Remove the WGS 84 anchor of a map; 404 if it has none."""
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.of(snapshot).geo
            if before is None:
                raise no_anchor(name)
            self._check_author(before)
            self.annotations.write(snapshot, self.principal.name, [], [(GEO, "")])

    @on_newest
    def set_named(self, name: str, anchor: str, pose: Pose) -> tuple[MapSnapshot, NamedAnchor]:
        """Add or replace a named anchor of a map."""
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.of(snapshot).named.get(anchor)
            self._check_author(before)
            value = pose_value(pose, snapshot.frame)
            if before is None or pose_value(before.pose, before.frame) != value:
                self.annotations.write(snapshot, self.principal.name, [(NAMED, anchor, value)])
            return snapshot, self.annotations.of(snapshot).named[anchor]

    @on_newest
    def remove_named(self, name: str, anchor: str) -> None:
        """Remove a named anchor of a map; 404 if there is none."""
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.of(snapshot).named.get(anchor)
            if before is None:
                raise unknown_anchor(name, anchor)
            self._check_author(before)
            self.annotations.write(snapshot, self.principal.name, [], [(NAMED, anchor)])

    @on_newest
    def set_mirror(self, name: str, source: str, etag: str) -> MirrorMark:
        """Mark a map as a copy of another service's map.

        Raises:
            Problem: 409 if the map has segments and is no copy of this source.
        """
        self.principal.check_all()
        with self.maps.writing(name):
            snapshot = self._checked(name)
            before = self.annotations.of(snapshot).mirror
            if before is None and len(snapshot):
                raise Problem(
                    409,
                    "not-a-mirror",
                    f"Map {name!r:.80} has {len(snapshot):,} segments and is no mirror. Mirror "
                    "into an empty map, or a new one.",
                )
            value = mirror_value(source, etag)
            after = self.annotations.write(
                snapshot, self.principal.name, [(MIRROR, "", value)]
            ).mirror
            assert after is not None  # it was written
            return after

    @on_newest
    def remove_mirror(self, name: str) -> None:
        """Make a mirror a map of this service, which takes writes; 404 if it is none."""
        self.principal.check_all()
        with self.maps.writing(name):
            snapshot = self._checked(name)
            if self.annotations.of(snapshot).mirror is None:
                raise Problem(404, "not-a-mirror", f"Map {name!r:.80} is no mirror.")
            self.annotations.write(snapshot, self.principal.name, [], [(MIRROR, "")])

    def _checked(self, name: str) -> MapSnapshot:
        snapshot = self.maps.get(name)
        self.conditions.check(snapshot.tag)
        return snapshot

    def _check_author(self, before: StoredGeoAnchor | NamedAnchor | None) -> None:
        """Check that a key that is bound to a robot does not change another key's anchor."""
        if before is not None and before.author != self.principal.name:
            self.principal.check_all()


def no_anchor(name: str) -> Problem:
    """Return the problem of a map without a WGS 84 anchor."""
    return Problem(
        404,
        "no-anchor",
        f"Map {name!r:.80} has no WGS 84 anchor. Set one by hand (PUT /maps/MAP/anchor), or fit "
        "one to GNSS fixes (POST /maps/MAP/anchor/fit).",
    )


def unknown_anchor(name: str, anchor: str) -> Problem:
    """Return the problem of a name that no anchor of a map has."""
    return Problem(
        404,
        "unknown-anchor",
        f"Map {name!r:.80} has no anchor {anchor!r:.80}. GET /maps/MAP/anchors lists the anchors.",
    )
