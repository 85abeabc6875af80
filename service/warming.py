"""Compilation before the first request: runs each compiled loop of recognition once.

Where no cache of machine code can be read (a fresh checkout, a container whose file system is
read-only), compiling takes longer than a request may, so the first robot would get a 504.
"""

from contextlib import suppress

import numpy as np

from segments.localisation import Candidates, localise
from service import json_arrays, ranking
from service.models import Models
from service.problems import Problem
from service.scan import Scan
from service.settings import Limits
from service.timing import Timing

SEGMENTS = 6
POINTS = 60
"""Points of each segment."""


def warm(models: Models, limits: Limits) -> None:
    """Compile what a request of recognition needs, by a made-up scan.

    Limits that would refuse the scan leave describing to the first request.
    """
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
    localise(Candidates(centers, rows, centers[:, None], np.ones((SEGMENTS, 1))))
