"""First picture of the demo: both paths, both maps, and a line for each match."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from demo.score import in_frame
from evaluation.poses.robot import Answer, Robot
from placecell.core.types import Bool, Float64

RIGHT, WRONG = "#1b9e77", "#d95f02"
MOST_LINES = 200


def draw_matches(
    file: Path,
    mapper: Robot,
    asker: Robot,
    map_centroids: Float64,
    answers: Sequence[Answer],
    right: Bool,
    title: str,
) -> None:
    """Draw robot B's segments beside robot A's map, each with a line to its first candidate.

    Args:
        file: PNG file to write.
        mapper: robot A.
        asker: robot B.
        map_centroids: float64 (n, 3), segment centroids of robot A's map, in its frame.
        answers: candidates of each query.
        right: bool (queries,), whether the first candidate is right.
        title: title of the picture.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    map_points = in_frame(mapper.to_common, map_centroids)[:, :2]
    queries = np.array([answer.centroid[:2] for answer in answers])
    # Robot B's half is moved aside, along the shorter side of the map.
    extent = np.ptp(map_points, axis=0)
    axis = int(extent.argmin())
    aside = np.zeros(2)
    aside[axis] = -1.15 * (extent[axis] + 10)
    figure, axes = plt.subplots(figsize=(11, 11), layout="constrained")
    axes.scatter(
        map_points[:, 0],
        map_points[:, 1],
        s=3,
        color="0.6",
        label=f"segments of {mapper.name}: the map",
    )
    shifted = queries + aside
    axes.scatter(
        shifted[:, 0],
        shifted[:, 1],
        s=3,
        color="0.8",
        label=f"segments of {asker.name}: the queries",
    )
    for robot, shift, color in ((mapper, 0 * aside, "#1f5fa8"), (asker, aside, "#7a3fa0")):
        for recording in robot.recordings:
            scans = np.unique(recording.captures)
            path = robot.in_common(robot.drive.poses[scans, :3, 3])[:, :2] + shift
            axes.plot(*path.T, color=color, linewidth=2.5)
    answered = [index for index, answer in enumerate(answers) if len(answer.candidates)]
    shown = np.random.default_rng(0).permutation(answered)[:MOST_LINES]
    for is_right, color, width in ((False, WRONG, 0.4), (True, RIGHT, 0.9)):
        lines = [
            (
                in_frame(mapper.to_common, answers[index].candidates[:1])[0, :2],
                answers[index].centroid[:2] + aside,
            )
            for index in shown
            if right[index] == is_right
        ]
        axes.add_collection(LineCollection(lines, colors=color, linewidths=width, alpha=0.7))
    handles = [
        Line2D([], [], color="#1f5fa8", linewidth=2.5, label=f"path of {mapper.name}, the map"),
        Line2D([], [], color="#7a3fa0", linewidth=2.5, label=f"path of {asker.name}, moved aside"),
        Line2D([], [], color=RIGHT, label="first candidate right (within 1.5 m)"),
        Line2D([], [], color=WRONG, label="first candidate wrong"),
    ]
    axes.legend(handles=handles, loc="upper center", ncols=2)
    axes.set(title=title, xlabel="x, meters", ylabel="y, meters", aspect="equal")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=110)
    plt.close(figure)
