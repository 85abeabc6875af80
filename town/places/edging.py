"""Objects beside the paths of a place: lamps, benches, hedges, rows of trees."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from town.objects.vegetation import hedge, tree
from town.places.builder import Builder, Make


@dataclass(frozen=True, slots=True)
class Edging:
    """Kind of object beside a path.

    Attributes:
        kind: name of the kind.
        make: function that builds the object.
        share: share of these objects among all beside the paths.
        radius: radius of the object, meters.
    """

    kind: str
    make: Make
    share: float
    radius: float


def edge_paths(
    builder: Builder,
    lines: Sequence[Float64],
    kinds: Sequence[Edging],
    width: float,
    *,
    step: tuple[float, float] = (6.0, 10.0),
    rows: float = 0.3,
    hedges: float = 0.25,
) -> None:
    """Add objects on both sides of paths.

    Args:
        builder: builder of the place.
        lines: (k, 2) each, points of each path, meters.
        kinds: kinds of objects.
        width: width of the free ground along a path, meters.
        step: smallest and largest distance of two objects of one side, meters.
        rows: share of the sides with a row of trees instead.
        hedges: share of the sides with a piece of hedge.
    """
    rng = builder.rng
    shares = np.array([each.share for each in kinds])
    shares /= shares.sum()
    for line in lines:
        ahead = line[-1] - line[0]
        length = float(np.linalg.norm(ahead))
        heading = float(np.arctan2(ahead[1], ahead[0]))
        right = np.array([ahead[1], -ahead[0]]) / length
        for side in (-1.0, 1.0):
            row = Edging("tree", tree, 1.0, 1.2) if rng.random() < rows else None
            for along in np.arange(4.0, length - 4.0, float(rng.uniform(*step))):
                what = row or kinds[int(rng.choice(len(kinds), p=shares))]
                middle = point_on(line, (along + float(rng.uniform(-1.5, 1.5))) / length)
                away = width / 2 + what.radius + float(rng.uniform(0.1, 1.2))
                x, y = (middle + side * away * right).tolist()
                # The street side of an object's frame is -y: it faces the path.
                turn = heading + (np.pi if side > 0 else 0.0)
                builder.stand(what.kind, what.make, x, y, what.radius, turn)
            if rng.random() < hedges:
                edge_hedge(builder, line, side, width)


def edge_hedge(builder: Builder, line: Float64, side: float, width: float) -> None:
    """Add a piece of hedge along a path, where the ground is free."""
    rng = builder.rng
    first = float(rng.uniform(0.05, 0.6))
    start, end = point_on(line, first), point_on(line, first + float(rng.uniform(0.15, 0.35)))
    ahead = end - start
    length = float(np.linalg.norm(ahead))
    right = np.array([ahead[1], -ahead[0]]) / length
    x, y = ((start + end) / 2 + side * (width / 2 + 1.6) * right).tolist()
    heading = float(np.arctan2(ahead[1], ahead[0]))
    mesh = hedge(rng, length).moved(y=0.6)
    builder.block("hedge", mesh, (length, 1.2), x, y, heading, 0.2)


def point_on(line: Float64, share: float) -> Float64:
    """Return the point of a line (k, 2) of equal steps at a share of its length, (2,)."""
    place = np.clip(share, 0, 1) * (len(line) - 1)
    return np.array([np.interp(place, np.arange(len(line)), line[:, axis]) for axis in (0, 1)])
