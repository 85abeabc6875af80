"""Compilation before the first request: runs each compiled loop of recognition once.

Where no cache of machine code can be read (a fresh checkout, a container whose file system is
read-only), compiling takes longer than a request may, so the first robot would get a 504.
"""

import logging
from contextlib import suppress

import numpy as np

from placecell.localization import Candidates, localize
from service.api.body import json_arrays
from service.core.problems import Problem
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.model_registry import Models
from service.inference.scan import Scan
from service.search import ranking

logger = logging.getLogger("placecell")

SEGMENTS = 6
POINTS = 60
"""Points of each segment."""


def warm(models: Models, limits: Limits) -> None:
    """Compile what a request of recognition needs, by a made-up scan.

    Whatever fails here is left to the first request: it is no condition of the start.
    """
    try:
        _warm(models, limits)
    except Exception:
        logger.exception("The loops of recognition were not compiled at the start.")


def _warm(models: Models, limits: Limits) -> None:
    json_arrays.warm()
    ranking.warm()
    random = np.random.default_rng(0)
    centers = random.uniform(-20, 20, (SEGMENTS, 3))
    points = min(max(limits.min_points, POINTS), limits.max_points)
    scan = Scan(
        points=(centers[:, None] + random.random((SEGMENTS, points, 3))).reshape(-1, 3),
        counts=np.full(SEGMENTS, points),
        sensors=np.zeros((SEGMENTS, 3)),
        dropped=np.zeros(SEGMENTS, np.int64),
    )
    for model in models.all():
        with suppress(Problem):
            model.describer.prepare(scan, Timing())
    rows = np.arange(SEGMENTS)[:, None]
    localize(Candidates(centers, rows, centers[:, None], np.ones((SEGMENTS, 1))))
