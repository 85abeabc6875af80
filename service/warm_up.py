"""Compilation before the first request: runs each compiled loop of recognition once.

Where no cache of machine code can be read, such as in a fresh checkout or on a read-only file
system, compilation takes longer than a request may. The first robot would get a 504.
"""

import logging
from contextlib import suppress

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.descriptors.reranking import supports
from placecell.localization import Candidates, LocalizationParameters, localize
from placecell.localization.pose_height import edge_likelihood
from placecell.segmentation.pipeline import segment_rows
from service.core.problems import Problem
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.model_registry import Models
from service.inference.scan import Scan
from service.search import ranking

logger = logging.getLogger("placecell")

SEGMENTS = 6
"""Number of segments of the made-up scan."""

POINTS = 60
"""Number of points of each of these segments."""


def warm_up(models: Models, limits: Limits) -> None:
    """Compile the loops of recognition with a made-up scan.

    A failure does not prevent the start; the loop is then compiled in the first request.
    """
    try:
        _compile_all(models, limits)
    except Exception:
        logger.exception("The loops of recognition were not compiled at the start.")


def _compile_all(models: Models, limits: Limits) -> None:
    ranking.warm_up()
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
    candidates = Candidates(centers, rows, centers[:, None], np.ones((SEGMENTS, 1)))
    # With a lower limit, correspondences are also voted on, as in requests of many segments.
    parameters = LocalizationParameters(most=SEGMENTS - 1)
    localize(candidates, parameters, models.default.confidence)
    edge_likelihood(centers, np.ones(SEGMENTS), centers, np.ones(SEGMENTS))
    segment_rows(random.uniform(-5, 5, (POINTS, 3)).astype(np.float32), PROTOCOL_V1)
    supports(centers, centers[:, None], np.zeros((SEGMENTS, 1), np.int64))
