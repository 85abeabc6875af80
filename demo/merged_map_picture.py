"""Second picture of the demo: the merged map of both robots, and the poses of robot B."""

from pathlib import Path

import numpy as np

from demo.match_picture import RIGHT, WRONG
from demo.meeting import Meeting
from evaluation.poses.robot import Robot
from placecell.core.types import Float64

MAPPER, ASKER = "#1f5fa8", "#7a3fa0"


def draw_site(
    file: Path, mapper: Robot, asker: Robot, centroids: Float64, meeting: Meeting
) -> None:
    """Draw the segments of both robots, the path of robot A, and each pose of robot B.

    Args:
        file: PNG file to write.
        mapper: robot A.
        asker: robot B.
        centroids: float64 (n, 3), segment centroids of robot A's map, in its frame.
        meeting: results of the localization and the merge.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(figsize=(11, 8), layout="constrained")
    axes.scatter(centroids[:, 0], centroids[:, 1], s=14, color="0.6", linewidths=0)
    axes.plot([], [], "o", color="0.6", markersize=4, label=f"segments of {mapper.name}")
    path = mapper.drive.poses[np.unique(np.concatenate([r.captures for r in mapper.recordings]))]
    axes.plot(*path[:, :2, 3].T, ".", color=MAPPER, markersize=3, label=f"path of {mapper.name}")
    if meeting.alignment is not None:
        seen = np.concatenate([each.segments.centroids() for each in asker.recordings])
        seen = meeting.alignment.apply(seen)
        axes.scatter(seen[:, 0], seen[:, 1], s=3, color=ASKER, linewidths=0)
        label = f"segments of {asker.name}, aligned"
        axes.plot([], [], "o", color=ASKER, markersize=4, label=label)
    localized = [each for each in meeting.answers if each.position is not None]
    for right, color, name in ((True, RIGHT, "right"), (False, WRONG, "wrong")):
        shown = [each.position for each in localized if each.is_right == right]
        places = np.array(shown).reshape(-1, 3)
        label = f"poses of {asker.name}, {name}: {len(places)}"
        axes.plot(
            *places[:, :2].T, "o", color=color, markersize=7, markeredgecolor="black", label=label
        )
    unknown = np.array([each.sensor for each in meeting.answers if each.position is None]).reshape(
        -1, 3
    )
    label = f"not localized: {len(unknown)}"
    axes.plot(*unknown[:, :2].T, "x", color="black", markersize=7, label=label)
    axes.legend(loc="upper center", ncols=3, bbox_to_anchor=(0.5, 1.14))
    axes.set(xlabel="x, meters", ylabel="y, meters", aspect="equal")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=110)
    plt.close(figure)
