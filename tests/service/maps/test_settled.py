"""B6: merging the same maps again changes nothing."""

from collections.abc import Sequence

import numpy as np
import pytest
from placecell_client import CompactMap, originated
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import difference, empty

from placecell.descriptors.quantizer import Quantizer
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from service.maps.writes.deduplication import RADIUS, VIEWS, SameView
from service.merging.join import ROUNDED, MergePart, PartOutcome, join, join_settled, known_pose

PARAMETERS = AlignmentParameters()
SAME = SameView(Quantizer(0.01), 40.0)
NAMES = ("a", "b", "c")


def drawn(
    random: np.random.Generator, name: str, things: np.ndarray, looks: np.ndarray
) -> MergePart:
    """Return a map of objects with more views than a map keeps, one time per sensor position."""
    count = int(random.integers(40, 120))
    which = random.integers(0, len(things), count)
    moments = random.integers(0, 30, count)
    stands = np.column_stack([np.arange(30) * 4.0 - 60, random.uniform(-3, 3, 30), np.zeros(30)])
    pose = Pose.of_yaw(float(random.uniform(-3, 3)), random.uniform(-500, 500, 3))
    back = pose.inverse()
    content = CompactMap(
        model_id="tiny-0123456789abcdef",
        preprocessing="1",
        frame=f"{name}'s odometry",
        codes=(looks[which] + random.normal(0, 20, (count, 16))).round().astype(np.int8),
        centroids=back.apply(things[which] + random.normal(0, 0.12, (count, 3))),
        ids=np.arange(count, dtype=np.uint32),
        robots=(name,),
        robot=np.zeros(count, np.uint16),
        frame_index=moments.astype(np.uint32),
        frame_times=np.arange(30.0) * 10.0 + (1e9 + ord(name)),
        frame_positions=back.apply(stands),
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (30, 1)),
    )
    return MergePart(name, originated(canonical(content), name), pose, RADIUS)


def parts_of(seed: int) -> list[MergePart]:
    random = np.random.default_rng(seed)
    things = random.uniform(-8, 8, (12, 3)) * (1, 1, 0.1)
    things[6:] = things[:6] + random.uniform(-0.4, 0.4, (6, 3))  # some stand close together
    looks = random.uniform(-60, 60, (12, 16))
    return [drawn(random, name, things, looks) for name in NAMES]


def merged(
    parts: Sequence[MergePart], same: SameView | None, site: CompactMap | None = None
) -> tuple[CompactMap, list[PartOutcome]]:
    """Merge as a request does: parts that were merged before keep their pose."""
    if site is None:
        site = empty("tiny-0123456789abcdef", "1", "site", 16)
    first_id = int(site.ids.max()) + 1 if len(site) else 0
    laid = []
    for part in parts:
        pose = known_pose(site, part.content, PARAMETERS)
        slack = RADIUS if pose is None else ROUNDED
        laid.append(MergePart(part.name, part.content, pose or part.pose, slack))
    return join_settled(site, laid, first_id, same, PARAMETERS)


def is_same(one: CompactMap, other: CompactMap) -> bool:
    changed, removed = difference(one, other)
    return not len(changed) and not len(removed)


@pytest.mark.parametrize("same", [SAME, None], ids=["deduplicated", "whole"])
@pytest.mark.parametrize("seed", range(12))
def test_B6_merge_again_in_any_order_adds_nothing(seed: int, same: SameView | None) -> None:
    parts = parts_of(seed)
    site, shares = merged(parts, same)
    assert len(site) == sum(share.added for share in shares)
    for order in ([0, 1, 2], [0, 1, 2], [2, 0, 1], [1], [2, 1, 0]):
        again, shares = merged([parts[place] for place in order], same, site)
        assert is_same(site, again), order
        assert [share.added for share in shares] == [0] * len(order)
        assert [share.removed for share in shares] == [0] * len(order)
    for part, share in zip(parts, merged(parts, same, site)[1], strict=True):
        assert share.known + share.repeats == len(part.content)


def test_B6_single_join_would_add_more_the_next_time() -> None:
    added = 0
    for seed in range(12):
        parts = parts_of(seed)
        site, _ = join(empty("tiny-0123456789abcdef", "1", "site", 16), parts, 0, SAME)
        laid = [
            MergePart(
                name=part.name,
                content=part.content,
                pose=known_pose(site, part.content, PARAMETERS) or part.pose,
                slack=ROUNDED,
            )
            for part in parts
        ]
        _, shares = join(site, laid, int(site.ids.max()) + 1, SAME)
        added += sum(share.added for share in shares)
    assert added  # else the test above would test nothing


def test_B6_ids_have_no_gap_and_views_stay_limited() -> None:
    parts = parts_of(3)
    site, _ = merged(parts, SAME)
    assert site.ids.tolist() == list(range(len(site)))
    assert site.views is not None
    first = np.count_nonzero(site.source == site.sources.index("a") + 1)
    # The first map is stored as it is; later maps add views up to the limit of each object.
    views, counts = np.unique(site.views, return_counts=True)
    own = np.bincount(np.searchsorted(views, site.views[:first]), minlength=len(views))
    assert ((counts <= VIEWS) | (counts == own)).all()
