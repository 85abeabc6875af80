"""Events as JSON lines: fixes, changes of state, keyframes."""

import json
from pathlib import Path
from typing import Any, TextIO

from scipy.spatial.transform import Rotation

from placecell.core.segments import Segments
from placecell.core.types import Float64, Int64
from robot.core.status import AgentStatus, Fix
from robot.outputs.output import NoOutput


class EventLog(NoOutput):
    """File with one JSON object a line; each line is written at once.

    `event` is `fix`, `state` or `keyframe`. `time` is that of the scan, seconds.
    """

    def __init__(self, file: Path) -> None:
        """Open the file for appending.

        Raises:
            OSError: the file cannot be written.
        """
        self.path = file
        file.parent.mkdir(parents=True, exist_ok=True)
        self._file: TextIO = file.open("a", encoding="utf-8", buffering=1)

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Write a keyframe with its number of segments."""
        self._write("keyframe", time, segments=len(ids), points=len(segments.points))

    def fix(self, fix: Fix) -> None:
        """Write a fix."""
        self._write(
            "fix",
            fix.time,
            map=fix.map,
            **pose_values(fix.pose),
            probability=round(fix.probability, 4),
            source=fix.source,
            meters=round(fix.meters, 2),
            accepted=fix.accepted,
            reason=fix.reason,
        )

    def status(self, status: AgentStatus) -> None:
        """Write a change of the state or of the link."""
        self._write(
            "state",
            status.time,
            state=status.state.value,
            reason=status.reason,
            link=status.link.value,
            meters=round(status.meters, 2),
            spool_entries=status.spool.entries,
        )

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _write(self, event: str, time: float, **values: Any) -> None:
        self._file.write(json.dumps({"event": event, "time": time} | values) + "\n")


def pose_values(pose: Float64) -> dict[str, list[float]]:
    """Return position and quaternion x, y, z, w of a pose."""
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
    return {
        "position": [round(float(value), 4) for value in pose[:3, 3]],
        "orientation": [round(float(value), 6) for value in turn],
    }
