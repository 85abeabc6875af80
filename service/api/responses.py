"""Parts of responses, made from the engine's results."""

from collections.abc import Sequence
from typing import Any

from scipy.spatial.transform import Rotation

from placecell.core.segment_classes import class_names, class_probabilities
from placecell.core.types import UInt8
from placecell.descriptors.site_calibration import SiteCalibration
from placecell.localization import Pose
from service.annotations.annotations import MapAnnotations, MirrorMark, StoredGeoAnchor
from service.api.schemas.anchors import GeoAnchorOut
from service.api.schemas.maps import MapDetailOut, MapOut, MirrorOut, VersionOut, WrittenOut
from service.core.auth import Principal
from service.core.problems import title_of, type_of
from service.inference.describer import SegmentError
from service.maps.snapshot import MapEntry, MapSnapshot, tag_of
from service.maps.store import Commit
from service.maps.visibility import author_for, sources_for
from service.maps.writes.writer import WriteResult
from service.search.query import MapSelection


def segment_error(error: SegmentError) -> dict[str, Any]:
    """Return the error of a segment, as a `Failed`."""
    return {
        "error": {
            "type": type_of(error.kind),
            "title": title_of(error.kind),
            "detail": error.detail,
        }
    }


def listed_classes(classes: UInt8) -> list[dict[str, Any] | None]:
    """Return the class of each segment, as a `ClassOut`; None for unknown."""
    return [
        None if name is None else {"name": name, "probability": probability}
        for name, probability in zip(
            class_names(classes), class_probabilities(classes).round(3).tolist(), strict=True
        )
    ]


def skipped_maps(selection: MapSelection) -> list[dict[str, str]]:
    """Return the maps that were not searched, each as a `SkippedOut`."""
    return [{"map": each.name, "model_id": each.model_id} for each in selection.skipped]


def summary_of(snapshot: MapEntry, principal: Principal, tags: Sequence[str]) -> MapOut:
    """Summarize a map as a key may see it; reads the whole map, so call it in a thread."""
    head, summary = snapshot.head, snapshot.summary
    return MapOut(
        name=snapshot.name,
        segments=len(snapshot),
        sequence=head.sequence,
        etag=snapshot.tag,
        bytes=head.bytes,
        model_id=snapshot.model_id,
        frame=snapshot.frame,
        robots=dict(sorted(summary.robots.items())),
        sources=sources_for(principal, summary.sources),
        time_span=summary.time_span,
        optional=[*summary.optional],
        tags=[*tags],
        classes=summary.classes,
    )


def detail_of(
    snapshot: MapSnapshot,
    principal: Principal,
    site: SiteCalibration | None,
    annotations: MapAnnotations,
    *,
    shapes: bool,
) -> MapDetailOut:
    """Return the summary of a map with its calibration and anchor; call it in a thread."""
    summary = summary_of(snapshot, principal, annotations.tags).model_dump()
    anchor, mirror = annotations.geo, annotations.mirror
    return MapDetailOut.model_validate(
        summary
        | {
            "calibration": None if site is None else site.as_dict(),
            "anchor": None if anchor is None else geo_anchor_of(snapshot, anchor, principal),
            "mirror": None if mirror is None else mirror_of(mirror),
            "shapes": shapes,
        }
    )


def mirror_of(mark: MirrorMark) -> MirrorOut:
    """Return the mark of a mirror."""
    return MirrorOut(source=mark.source, etag=mark.etag, time=mark.time)


def outcome_of(written: WriteResult) -> WrittenOut:
    """Return the result of a write."""
    snapshot = written.snapshot
    return WrittenOut(
        map=snapshot.name,
        sequence=snapshot.head.sequence,
        etag=snapshot.tag,
        segments=len(snapshot),
        changed=written.changed,
        removed=written.removed,
        repeats=written.repeats,
    )


def version_of(commit: Commit, principal: Principal) -> VersionOut:
    """Return a version of the history as a key may see it."""
    note = commit.note
    return VersionOut(
        sequence=commit.sequence,
        etag=tag_of(commit.sequence, commit.mark),
        time=note.time,
        author=author_for(principal, note.author),
        operation=note.operation,
        changed=note.changed,
        removed=note.removed,
    )


def pose_of(pose: Pose) -> dict[str, Any]:
    """Return a pose, as a `PoseOut`."""
    rotation = Rotation.from_matrix(pose.rotation).as_quat(canonical=True)
    return {
        "translation": pose.translation.tolist(),
        "rotation": rotation.tolist(),
        "yaw": pose.yaw,
    }


def geo_anchor_of(
    snapshot: MapSnapshot, stored: StoredGeoAnchor, principal: Principal
) -> GeoAnchorOut:
    """Return the WGS 84 anchor of a map as a key may see it."""
    anchor = stored.anchor
    return GeoAnchorOut(
        map=snapshot.name,
        lat=anchor.lat,
        lon=anchor.lon,
        height=anchor.height,
        yaw_deg=anchor.yaw_deg,
        accuracy=anchor.accuracy,
        position=anchor.position,
        frame=stored.frame,
        applies=stored.frame == snapshot.frame,
        author=author_for(principal, stored.author),
        time=stored.time,
    )
