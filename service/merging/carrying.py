"""Carrying: takes the anchors of merged maps into the merged map, by the merge's transforms."""

from typing import Any

import numpy as np

from placecell.core.geodesy import GeoAnchor, ecef_of, to_geodetic
from placecell.localization import Pose
from service.annotations.annotations import (
    GEO,
    NAMED,
    NOTHING,
    Annotations,
    MapAnnotations,
    geo_value,
    pose_value,
)
from service.annotations.moving import CaptureMovement
from service.maps.repository import MapRepository
from service.maps.snapshot import MapSnapshot
from service.merging.merge import CarriedAnchor, MergeResult

SAME_METERS, SAME_DEGREES = 0.5, 3.0
"""Largest distance and angle between two anchors of one name that are the same."""

DEVIATIONS = 3.0
"""Number of standard deviations by which two places on the Earth may differ."""


def carry_anchors(
    merged: MergeResult, name: str, maps: MapRepository, annotations: Annotations, author: str
) -> tuple[CarriedAnchor, ...]:
    """Carry the anchors of the merged maps into the merged map; a dry run writes nothing.

    Args:
        merged: result of the merge.
        name: name of the merged map.
        maps: all maps.
        annotations: annotations of all maps.
        author: name of the key.
    """
    with maps.writing(name):
        snapshot = maps.find(name)
        present = NOTHING if snapshot is None else annotations.of(snapshot)
        frame = merged.plan.maps[0].frame
        outcomes, put = _planned(merged, present, frame, annotations)
        if put and merged.written is not None and snapshot is not None:
            annotations.write(snapshot, author, put)
    return outcomes


def _planned(
    merged: MergeResult, present: MapAnnotations, frame: str, annotations: Annotations
) -> tuple[tuple[CarriedAnchor, ...], list[tuple[str, str, dict[str, Any]]]]:
    """Return the outcome of each anchor, and the annotations to write."""
    geo = present.geo.anchor if present.geo is not None and present.geo.frame == frame else None
    named = {key: each.pose for key, each in present.named.items() if each.frame == frame}
    taken = {*present.named}
    # Captures that the optimization moved take the anchors beside them along.
    bent = None if merged.bent is None else CaptureMovement(*merged.bent)
    outcomes: list[CarriedAnchor] = []
    put: list[tuple[str, str, dict[str, Any]]] = []
    for number in merged.outcomes:
        part, pose = merged.plan.maps[number], merged.plan.poses[number]
        # The captures of a map that drifted may have been moved before it was aligned.
        own = None
        if len(annotations.of(part)):
            own = CaptureMovement(part.layers.content(), merged.plan.sides[number].content)
        found = annotations.geo_anchor(part)
        if found is not None:
            if own is not None:
                move = own.at(np.array(found.position))
                found = found.moved(move.rotation, move.translation)
            placed = found.moved(pose.rotation, pose.translation)
            if bent is not None:
                move = bent.at(np.array(placed.position))
                placed = placed.moved(move.rotation, move.translation)
            outcomes.append(_geo_outcome(part, placed, geo))
            if geo is None:
                geo = placed
                put.append((GEO, "", geo_value(placed, frame)))
        for key, each in annotations.of(part).named.items():
            if each.frame != part.frame:
                continue
            here = each.pose if own is None else own.at(each.pose.translation).after(each.pose)
            there = pose.after(here)
            if bent is not None:
                there = bent.at(there.translation).after(there)
            outcomes.append(_named_outcome(part, key, there, named, taken))
            if key not in taken:
                taken.add(key)
                named[key] = there
                put.append((NAMED, key, pose_value(there, frame)))
    return tuple(outcomes), put


def _geo_outcome(part: MapSnapshot, placed: GeoAnchor, geo: GeoAnchor | None) -> CarriedAnchor:
    if geo is None:
        return CarriedAnchor(part.name, None, "carried", None)
    try:
        lat, lon, height = to_geodetic(np.array(placed.position), geo)[0].tolist()
    except ValueError:  # the anchored points are too far apart
        return CarriedAnchor(part.name, None, "conflict", None)
    here, there = ecef_of(lat, lon, height), ecef_of(placed.lat, placed.lon, height)
    meters = float(np.linalg.norm(here - there))
    most = SAME_METERS + DEVIATIONS * float(np.hypot(placed.accuracy, geo.accuracy))
    return CarriedAnchor(part.name, None, "kept" if meters <= most else "conflict", meters)


def _named_outcome(
    part: MapSnapshot, key: str, there: Pose, named: dict[str, Pose], taken: set[str]
) -> CarriedAnchor:
    if key not in taken:
        return CarriedAnchor(part.name, key, "carried", None)
    if key not in named:  # the merged map's own anchor is of another frame
        return CarriedAnchor(part.name, key, "conflict", None)
    meters, angle = named[key].difference(there, np.zeros(3))
    is_same = meters <= SAME_METERS and np.degrees(angle) <= SAME_DEGREES
    return CarriedAnchor(part.name, key, "kept" if is_same else "conflict", meters)
