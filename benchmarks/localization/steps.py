"""CPU time of each step from candidates to a pose, for ordinary and hard queries, in one process.

`placecell bench localize --steps` prints it. It is the time of the thread, not wall time, so that
other processes disturb it less.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import thread_time
from typing import Any, TypeVar

import numpy as np

from benchmarks.localization.hard_queries import HARD_QUERIES, HardQuery
from placecell.core.spatial import within
from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from placecell.localization import Candidates, LocalizationParameters
from placecell.localization.correspondences import correspond
from placecell.localization.guided_matching import match_guided
from placecell.localization.hypothesis import find_hypotheses
from placecell.localization.localize import judge
from placecell.localization.voting import most_voted
from service.engine import Engine
from service.inference.match_probability import match_probabilities
from service.inference.model_registry import Model

STEPS = ("probabilities", "correspond", "vote", "search", "match", "judge")
"""Match probabilities of the candidates; weighted pairs; the most voted; consistency graph, cliques
and refinement; guided matching; probability of the pose."""

Result = TypeVar("Result")


def measure_steps(
    sizes: Sequence[int], k: int = 25, repetitions: int = 20, seed: int = 0
) -> list[dict[str, Any]]:
    """Measure each arrangement of each size; return a row for each.

    Args:
        sizes: segments of a query.
        k: candidates of a segment.
        repetitions: queries of each arrangement.
        seed: random seed.
    """
    rows = []
    with Engine.temporary(MODELS_FOLDER / DEFAULT_MODEL) as engine:
        for size in sizes:
            for name, arrange in HARD_QUERIES.items():
                random = np.random.default_rng(seed)
                spent = [
                    _spent(engine.model, arrange(size, k, random), random)
                    for _ in range(repetitions + 1)
                ][1:]  # the first one may compile loops
                rows.append(
                    {
                        "descriptors": size,
                        "query": name,
                        "milliseconds": _percentiles([sum(each.values()) for each in spent]),
                        "steps": {
                            step: _percentiles([each[step] for each in spent]) for step in STEPS
                        },
                    }
                )
    return rows


def _spent(model: Model, query: HardQuery, random: np.random.Generator) -> dict[str, float]:
    """Localize a query; return the CPU milliseconds of each step."""
    parameters = LocalizationParameters()
    wide = model.manifest.code_bytes
    codes = random.integers(-128, 128, (len(query.map_centroids), wide)).astype(np.int8)
    # Descriptors a little different from those of the first candidates.
    seen = codes[query.rows[:, 0]].copy()
    seen[:, : wide // 4] = random.integers(-128, 128, (len(seen), wide // 4))
    spent: dict[str, float] = {}

    def timed(step: str, work: Callable[[], Result]) -> Result:
        started = thread_time()
        result = work()
        spent[step] = spent.get(step, 0.0) + 1e3 * (thread_time() - started)
        return result

    of_rows = np.repeat(np.arange(len(seen)), query.rows.shape[1])
    probabilities = timed(
        "probabilities",
        lambda: match_probabilities(model, seen[of_rows], codes[query.rows.ravel()]),
    ).reshape(query.rows.shape)
    candidates = Candidates(
        query.centroids, query.rows, query.map_centroids[query.rows], np.maximum(probabilities, 0.1)
    )
    found = timed("correspond", lambda: correspond(candidates, parameters))
    voted = timed("vote", lambda: most_voted(found, parameters))
    hypotheses = timed("search", lambda: find_hypotheses(voted, parameters))
    there = HardMap(seen, codes, query.map_centroids, model)
    matched = timed(
        "match",
        lambda: [match_guided(each, candidates, there, parameters) for each in hypotheses],
    )
    timed(
        "judge",
        lambda: (
            judge(matched, candidates, there, found.usable, parameters, model.confidence)
            if matched
            else None
        ),
    )
    return spent


@dataclass(frozen=True, slots=True, eq=False)
class HardMap:
    """Segments of a map in memory, for guided matching (`MapSegments`).

    Attributes:
        query_codes: int8 (q, code bytes).
        codes: int8 (n, code bytes), codes of the map.
        centroids: float64 (n, 3), meters.
        model: model of all codes.
    """

    query_codes: Int8
    codes: Int8
    centroids: Float64
    model: Model

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Return the rows near some places, and their centroids."""
        rows = within(self.centroids, places, meters)
        return rows, self.centroids[rows]

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """Return the match probability of each pair of query and row."""
        return match_probabilities(self.model, self.query_codes[queries], self.codes[rows])


def _percentiles(times: Sequence[float]) -> dict[str, float]:
    found = np.percentile(times, [50, 99]).round(3).tolist()
    return dict(zip(("p50", "p99"), found, strict=True))
