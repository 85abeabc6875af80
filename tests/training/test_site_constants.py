"""Site constants are fitted on normalized distances, and each drive counts the same."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.segments import Segments
from placecell.core.types import Int8
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.site_calibration import SiteConstants
from training.data.training_set import TrainingSet
from training.export.publishing import NORMALIZED, site_entry
from training.export.site_constants import LabeledSite, fit_site_constants, sites_of

QUANTIZER = Quantizer(0.05)
CONSTANTS = SiteConstants(1.0, 0.0, 1.0, 0.1)


def codes_of(objects: int, views: int, scale: float, seed: int) -> Int8:
    random = np.random.default_rng(seed)
    looks = np.tile(random.normal(size=(objects, 16)), (views, 1)) * 25
    noisy = (looks + random.normal(size=looks.shape) * 12) * scale
    return np.asarray(noisy.round().clip(-127, 127), dtype=np.int8)


def drive(objects: int = 80, views: int = 4, scale: float = 1.0, seed: int = 0) -> LabeledSite:
    groups = np.tile(np.arange(objects), views)
    centroids = np.zeros((len(groups), 3))
    centroids[:, 0] = 5.0 * groups
    captures = np.repeat(np.arange(views), objects)
    held_out = np.ones(len(groups), dtype=bool)
    return LabeledSite(codes_of(objects, views, scale, seed), centroids, captures, groups, held_out)


def test_constants_carry_over_to_another_scale() -> None:
    fitted = fit_site_constants([drive(seed=1), drive(scale=0.6, seed=2)], QUANTIZER)
    assert fitted is not None
    constants, auc = fitted
    assert auc > 0.98
    other = drive(scale=0.35, seed=3)
    site = other.calibration(QUANTIZER, constants)
    # Row r and row r + 80 are views of one object; row r + 81 is another object.
    same = site.pair_log_ratios(other.codes[:200], other.codes[80:280])
    different = site.pair_log_ratios(other.codes[:200], other.codes[81:281])
    assert ((same > 0).mean() + (different < 0).mean()) / 2 > 0.95


def test_only_held_out_groups_are_drawn() -> None:
    site = drive()
    spoiled = replace(site, groups=np.where(site.groups < 40, 0, site.groups))
    held_out = replace(spoiled, held_out=site.groups >= 40)
    assert fit_site_constants([held_out], QUANTIZER) != fit_site_constants([spoiled], QUANTIZER)
    nothing = replace(site, held_out=np.zeros(len(site.groups), dtype=bool))
    assert fit_site_constants([nothing], QUANTIZER) is None


def test_split_training_set_is_divided_by_drive() -> None:
    def part(rows: int, drives: list[int]) -> TrainingSet:
        clouds = [np.full((3, 3), row, dtype=np.float32) for row in range(rows)]
        return TrainingSet(
            Segments.of(clouds, np.zeros((rows, 3))),
            np.zeros(rows, dtype=np.int64),
            None,  # type: ignore[arg-type]
            drives=np.array(drives),
        )

    codes = np.arange(5, dtype=np.int8)[:, None]
    one, other = sites_of(part(3, [0, 1, 1]), part(2, [1, 0]), codes)
    assert (one.codes.ravel().tolist(), one.groups.tolist()) == ([0, 4], [0, 1])
    assert (one.held_out.tolist(), one.captures.tolist()) == ([False, True], [0, 0])
    assert (other.codes.ravel().tolist(), other.groups.tolist()) == ([1, 2, 3], [0, 0, 1])
    assert other.centroids[:, 0].tolist() == [1.0, 2.0, 0.0]


@pytest.mark.parametrize(
    ("kind", "auc", "kept"),
    [("distance", 0.8, True), ("forest", 0.95, True), ("forest", 0.8, False)],
)
def test_better_pair_classifier_keeps_its_probabilities(kind: str, auc: float, kept: bool) -> None:
    pair = {"kind": kind, "auc": {"distance": 0.85, "forest": 0.9}}
    entry = site_entry(pair, (CONSTANTS, auc))
    assert entry["auc"][NORMALIZED] == auc
    assert entry.get("site") == (CONSTANTS.as_dict() if kept else None)
    assert site_entry(pair, None) == {}
