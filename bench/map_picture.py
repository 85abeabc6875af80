"""A map from above."""

from pathlib import Path

import numpy as np
from placecell_client import CompactMap

from training.figure import figure

MOST = 50_000
"""Segments that are drawn; of more, so many at random."""


def draw_map(file: Path, content: CompactMap, title: str) -> None:
    """Each robot's segments as points in a colour, and where its sensor was as a line."""
    with figure(file, size=9) as (axes,):
        for place, robot in enumerate(content.robots):
            rows = np.flatnonzero(content.robot == place)
            frames = np.unique(content.frame_index[rows])
            drawn = np.random.default_rng(0).permutation(rows)[:MOST]
            (path,) = axes.plot(*content.frame_positions[frames, :2].T, linewidth=1.5, label=robot)
            axes.scatter(*content.centroids[drawn, :2].T, s=2, color=path.get_color(), alpha=0.5)
        axes.set(
            title=f"{title}: {len(content):,} segments",
            xlabel="x, metres",
            ylabel="y, metres",
            aspect="equal",
        )
        if content.robots:
            axes.legend()
