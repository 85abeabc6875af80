"""What routes answer, made of what the service holds."""

from typing import Any

from scipy.spatial.transform import Rotation

from segments.localisation import Pose
from service.map_schemas import MapOut, VersionOut, WrittenOut
from service.map_store import Commit
from service.stored_map import StoredMap, tag_of
from service.writer import Written


def summary_of(stored: StoredMap) -> MapOut:
    """A map in short; looks at all of it, so not for the event loop."""
    head, layers = stored.head, stored.layers
    return MapOut(
        name=stored.name,
        segments=len(stored),
        sequence=head.sequence,
        etag=stored.tag,
        bytes=head.bytes,
        model_id=stored.model_id,
        frame=stored.frame,
        robots=dict(sorted(layers.robots.items())),
        sources=dict(sorted(layers.sources.items())),
        time_span=layers.time_span,
        optional=sorted(layers.optional),
    )


def outcome_of(written: Written) -> WrittenOut:
    """What a write did."""
    stored = written.stored
    return WrittenOut(
        map=stored.name,
        sequence=stored.head.sequence,
        etag=stored.tag,
        segments=len(stored),
        changed=written.changed,
        removed=written.removed,
        repeats=written.repeats,
    )


def version_of(commit: Commit) -> VersionOut:
    """A version, as it stands in the history."""
    note = commit.note
    return VersionOut(
        sequence=commit.sequence,
        etag=tag_of(commit.sequence, commit.mark),
        time=note.time,
        author=note.author,
        operation=note.operation,
        changed=note.changed,
        removed=note.removed,
    )


def pose_of(pose: Pose) -> dict[str, Any]:
    """A pose, as `PoseOut` says."""
    rotation = Rotation.from_matrix(pose.rotation).as_quat(canonical=True)
    return {
        "translation": pose.translation.tolist(),
        "rotation": rotation.tolist(),
        "yaw": pose.yaw,
    }
