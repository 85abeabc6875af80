"""Paper's three trainings: losses and samplers by hand, and improvement of recognition."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from evaluation.recognition.retrieval import top1
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.segmentation.recording import Recording
from tests.training_sets import make_shapes
from training.data.augmentation import Augmentation, elevations
from training.data.training_set import Source, TrainingSet
from training.export.publishing import whole
from training.methods import contrastive, group_based, siamese
from training.methods.fit import Sgd
from training.methods.networks import describe
from training.methods.run import Run

SMALL = Sgd(learning_rate=0.05, batch=16)


def test_contrastive_loss_by_hand() -> None:
    # A match at squared distance 0.3, a non-match inside the margin and one beyond it.
    matches = torch.tensor([1.0, 0.0, 0.0])
    squared = torch.tensor([0.3, 0.25, 1.7])
    loss = contrastive.contrastive_loss(matches, squared, margin=1.0)
    assert loss.item() == pytest.approx((0.3 + (1.0 - 0.25) + 0.0) / 3)


def test_hard_pairs_on_a_toy_set() -> None:
    # Two groups on a line: 0 at 0, 1, 9 and 1 at 2, 3; one segment without a mate at 20.
    descriptors = np.array([[0.0], [1.0], [9.0], [2.0], [3.0], [20.0]], dtype=np.float32)
    groups = np.array([0, 0, 0, 1, 1, 2])
    random = np.random.default_rng(0)
    matches, others = contrastive.hard_pairs(descriptors, groups, 1, random)
    # The nearest non-match of each segment, and no match for the segment without a mate.
    assert others.tolist() == [[0, 3], [1, 3], [2, 4], [3, 1], [4, 1], [5, 2]]
    assert set(matches[:, 0].tolist()) == {0, 1, 2, 3, 4}
    assert all(groups[a] == groups[b] and a != b for a, b in matches)
    # The farther of two mates is drawn with probability 3/4.
    drawn = [contrastive.hard_pairs(descriptors, groups, 1, random)[0][0, 1] for _ in range(400)]
    assert np.mean(np.array(drawn) == 2) == pytest.approx(0.75, abs=0.07)


def test_random_pairs_do_not_follow_distance() -> None:
    groups = np.repeat(np.arange(5), 4)
    random = np.random.default_rng(0)
    strangers = np.concatenate([contrastive.random_pairs(groups, random)[1] for _ in range(300)])
    of_first = strangers[strangers[:, 0] == 0, 1]
    assert set(of_first.tolist()) == set(range(4, 20))


def test_pair_sampler_is_one_to_one_without_duplicates() -> None:
    groups = np.array([0, 0, 0, 1, 1, 2, 3, 3, 3, 3])
    pairs, labels = siamese.sample_pairs(groups, 12, np.random.default_rng(5))
    assert len(pairs) == 12
    assert labels.sum() == 6
    assert (pairs[:, 0] != pairs[:, 1]).all()
    unordered = {tuple(sorted(pair)) for pair in pairs.tolist()}
    assert len(unordered) == 12
    assert ((groups[pairs[:, 0]] == groups[pairs[:, 1]]) == (labels == 1)).all()


def test_random_pairs_are_drawn_uniformly() -> None:
    groups = np.array([0, 0, 0, 0, 1, 1, 1])
    random = np.random.default_rng(0)
    drawn = [contrastive.random_pairs(groups, random) for _ in range(600)]
    mates = np.array([matches[0, 1] for matches, _ in drawn])
    strangers = np.array([others[0, 1] for _, others in drawn])
    assert np.bincount(mates)[1:] / 600 == pytest.approx([1 / 3] * 3, abs=0.06)
    assert np.bincount(strangers)[4:] / 600 == pytest.approx([1 / 3] * 3, abs=0.06)


def test_pair_sampler_stops_when_non_matches_run_out() -> None:
    groups = np.array([0] * 10 + [1])  # 45 matches, 10 others
    pairs, labels = siamese.sample_pairs(groups, 4000, np.random.default_rng(0))
    assert labels.sum() == 10
    assert len(pairs) == 20
    with pytest.raises(ValueError, match="No pairs"):
        siamese.sample_pairs(np.zeros(5, dtype=np.int64), 10, np.random.default_rng(0))


@pytest.mark.slow
def test_checkpoint_of_other_data_is_refused(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = group_based.GroupBasedRecipe(epochs=1, sgd=SMALL)
    group_based.train(shapes, other_views, Run(tmp_path, 0, "these drives"), recipe=recipe)
    with pytest.raises(ValueError, match="other drives"):
        group_based.train(shapes, other_views, Run(tmp_path, 0, "those drives"), recipe=recipe)


def test_checkpoint_of_an_earlier_version_asks_to_begin_anew(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = group_based.GroupBasedRecipe(epochs=1, sgd=SMALL)
    group_based.train(shapes, other_views, Run(tmp_path, 0), recipe=recipe)
    state = torch.load(tmp_path / "checkpoint.pt", weights_only=True)
    del state["optimizer"]
    torch.save(state, tmp_path / "checkpoint.pt")
    with pytest.raises(ValueError, match=r"no state of the optimizer.* Begin anew"):
        group_based.train(shapes, other_views, Run(tmp_path, 0), recipe=recipe)


def test_pair_sampler_stays_one_to_one_when_matches_run_out() -> None:
    groups = np.array([0, 0, 0, 1, 1, 2, 3, 3, 3, 3])  # 3 + 1 + 6 matches
    pairs, labels = siamese.sample_pairs(groups, 1000, np.random.default_rng(5))
    assert labels.sum() == 10
    assert len(pairs) == 20


def test_third_network_does_not_depend_on_the_order() -> None:
    match = siamese.MatchNetwork()
    a, b = torch.randn(2, 20, 64)
    assert match(a, b).detach().numpy() == pytest.approx(match(b, a).detach().numpy(), abs=1e-6)


@pytest.mark.slow
def test_group_based_training_improves_recognition(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = group_based.GroupBasedRecipe(epochs=8, sgd=SMALL)
    run = Run(tmp_path, seed=0)
    network = group_based.train(shapes, other_views, run, recipe=recipe)
    assert top1(describe(network, other_views), other_views.groups) > 0.8
    assert run.history[-1]["accuracy"] > run.history[0]["accuracy"]


@pytest.mark.slow
def test_siamese_training_improves_recognition(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = siamese.SiameseRecipe(epochs=4, pairs=200, sgd=SMALL)
    run = Run(tmp_path, seed=0)
    siamese.train(shapes, other_views, run, recipe=recipe)
    assert run.history[-1]["validation_accuracy"] > 0.85


@pytest.mark.slow
def test_contrastive_training_improves_recognition(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = contrastive.ContrastiveRecipe(epochs=8, sgd=SMALL)
    network = contrastive.train(shapes, other_views, Run(tmp_path, seed=0), recipe=recipe)
    assert top1(describe(network, other_views), other_views.groups) > 0.85


@pytest.mark.slow
def test_resumed_run_equals_an_uninterrupted_run(
    shapes: TrainingSet, other_views: TrainingSet, tmp_path: Path
) -> None:
    recipe = group_based.GroupBasedRecipe(epochs=3, sgd=SMALL)
    at_once = group_based.train(shapes, other_views, Run(tmp_path / "a", seed=1), recipe=recipe)

    class StoppedError(Exception):
        pass

    class Stopping(Run):
        def note(self, **figures: float) -> None:
            if len(self.history) == 2:
                raise StoppedError
            super().note(**figures)

    with pytest.raises(StoppedError):
        group_based.train(shapes, other_views, Stopping(tmp_path / "b", seed=1), recipe=recipe)
    resumed = Run(tmp_path / "b", seed=1)
    network = group_based.train(shapes, other_views, resumed, recipe=recipe)
    assert len(resumed.history) == 3
    assert describe(network, shapes) == pytest.approx(describe(at_once, shapes), abs=1e-5)


def test_small_groups_are_left_out() -> None:
    points = np.zeros((10, 3), dtype=np.float32)
    data = TrainingSet(
        Segments.of([points] * 6, np.ones((6, 3))), np.array([0, 0, 0, 1, 2, 2]), PROTOCOL_V1
    )
    assert data.without_small_groups(2).groups.tolist() == [0, 0, 0, 1, 1]
    assert data.without_small_groups(3).groups.tolist() == [0, 0, 0]


def test_held_out_segments_leave_three_per_group(shapes: TrainingSet) -> None:
    held_out = group_based.held_out_segments(shapes, 0.1, np.random.default_rng(0))
    assert len(held_out) == 5  # a tenth of 48, rounded up
    assert len(set(held_out.tolist())) == 5
    most = group_based.held_out_segments(shapes, 1.0, np.random.default_rng(0))
    left = np.bincount(np.delete(shapes.groups, most))
    assert (left == 3).all()


def test_different_parameters_and_shared_scans_are_refused() -> None:
    recording = Recording(
        name="toy",
        parameters=PROTOCOL_V1,
        segments=make_shapes(views=1, seed=0).segments,
        captures=np.arange(8),
        groups=np.arange(8),
        distinct=np.ones(8, dtype=bool),
        scans=8,
        scan_hashes=tuple("abcdefgh"),
        path_length=1.0,
    )
    other = replace(
        recording,
        parameters=replace(recording.parameters, growing_radius=0.5),
        scan_hashes=tuple("ijklmnop"),
    )
    all_scans = Source(recording, 0, recording.scans - 1)
    with pytest.raises(ValueError, match="different parameters"):
        TrainingSet.of([all_scans, Source(other, 0, other.scans - 1)])
    with pytest.raises(ValueError, match="shares scans"):
        TrainingSet.of([all_scans, Source(recording, 0, 0)])


def test_split_keeps_groups_whole(shapes: TrainingSet) -> None:
    training, validation = shapes.split(0.25, seed=3)
    assert len(training) + len(validation) == len(shapes)
    assert len(validation.group_sizes()) == 2
    assert (validation.group_sizes() == 6).all()


def test_augmentation_drops_points_but_no_segment(shapes: TrainingSet) -> None:
    harsh = Augmentation(cut_share=1.0, cut_most=1.0, drop_most=1.0)
    occupancy, _ = harsh.copies(shapes.segments, shapes.parameters, np.random.default_rng(0))
    assert (occupancy.reshape(len(shapes), -1).sum(axis=1) >= 1).all()
    gentle = Augmentation(yaw=0.0, cut_share=0.0, drop_most=0.0)
    from placecell.descriptors.voxels import voxelize

    as_it_is, extents = voxelize(shapes.segments, shapes.parameters)
    same, same_extents = gentle.copies(shapes.segments, shapes.parameters, np.random.default_rng(0))
    assert (same == as_it_is).all()
    assert (same_extents == extents).all()
    assert replace(gentle, yaw=0.3) != gentle


def test_elevations_are_angles_above_the_horizon_of_the_sensor() -> None:
    points = np.array([[10, 0, 2], [10, 0, 12], [0, 10, -8]], dtype=np.float32)
    segments = Segments.of([points], np.array([[0.0, 0.0, 2.0]]))
    assert elevations(segments).tolist() == [0.0, 45.0, -45.0]


def test_thinned_copies_keep_whole_beams() -> None:
    # A wall 10 m ahead: 400 elevations from -14 to 14 degrees, three points at each.
    heights = np.linspace(-2.5, 2.5, 400)
    wall = np.stack([np.full(1200, 10.0), np.tile([-1.0, 0.0, 1.0], 400), heights.repeat(3)], 1)
    small = wall[:: 1200 // 19]
    segments = Segments.of(
        [wall.astype(np.float32)] * 20 + [small.astype(np.float32)], np.zeros((21, 3))
    )
    change = Augmentation(cut_share=0.0, drop_most=0.0, beam_share=1.0)
    thinned = change.segments(segments, np.random.default_rng(0))
    shares = thinned.counts / segments.counts
    assert (shares[:20] > 0.1).all()
    assert (shares[:20] < 0.7).all()
    assert shares[20] == 1
    middle = thinned.cloud(0)[thinned.cloud(0)[:, 1] == 0]
    degrees = np.degrees(np.arctan2(middle[:, 2], 10))
    gaps = np.diff(degrees)[np.diff(degrees) > 0.1]
    # Beams have one spacing, so the gaps between them are equal.
    assert len(gaps) >= 3
    assert np.ptp(gaps) < 0.15


def test_replaced_model_folder_keeps_its_confidence(tmp_path: Path) -> None:
    folder = tmp_path / "context"
    for constants in ("before", None):
        with whole(folder) as unfinished:
            (unfinished / "manifest.json").write_text("{}")
            if constants is not None:
                (unfinished / "confidence.json").write_text(constants)
    assert (folder / "confidence.json").read_text() == "before"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["context"]
