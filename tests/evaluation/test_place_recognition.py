"""Figures of place recognition equal those computed by hand, on files in published layouts."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cli import app
from evaluation.poses.place_recognition import (
    PROTOCOLS,
    PlaceAnswer,
    PlaceProtocol,
    place_answer,
    place_figures,
)
from evaluation.poses.places import TOGETHER, earlier, evaluate_places, robots_of_places
from evaluation.poses.queries import PoseQuery
from placecell.localization import Pose, localize
from service.engine import Engine
from tests.benchmarks.drive_builders import BOXES, trip
from tests.placecell.datasets.dataset_builders import write_helipr, write_mulran
from tests.placecell.localization.scene_builders import scene
from tests.placecell.segment_builders import pose
from tests.service.service_builders import write_eigenvalue_model

LOOPS = PROTOCOLS["kitti-loops"]


def answer(score: float, retrieved: float, nearest: float = 1.0) -> PlaceAnswer:
    return PlaceAnswer(score, retrieved, nearest)


NEW_PLACE = 100.0


def test_recall_at_1_counts_the_revisits_only() -> None:
    told = place_figures(
        [
            answer(0.9, 2.0),
            answer(0.2, 3.0),  # right at any score
            answer(0.9, 40.0),
            answer(0.0, np.inf),  # no answer is a miss
            answer(0.9, 150.0, NEW_PLACE),
        ],
        LOOPS,
    )
    assert (told["queries"], told["revisits"]) == (5, 4)
    assert told["recall_at_1"] == 2 / 4


def test_f1_max_by_hand() -> None:
    told = place_figures(
        [
            answer(0.9, 1.0),
            answer(0.8, 40.0, NEW_PLACE),  # a false positive
            answer(0.7, 1.0),
            answer(0.6, 10.0),  # between 3 m and 20 m: neither right nor wrong
            answer(0.5, 50.0),
            answer(0.0, np.inf),
        ],
        LOOPS,
    )
    # From 0.7: 2 true, 1 false, and 3 revisits missed: 4 / (4 + 1 + 3). From 0.6: the fourth is
    # positive and not counted, so 2 are missed: 4 / 7. From 0.5: 1 more false, 1 missed: 4 / 7.
    assert told["f1_max"] == pytest.approx(4 / 7, abs=1e-5)
    # Of equal ones, the threshold with the higher precision.
    assert told["f1_max_precision"] == pytest.approx(2 / 3, abs=1e-5)
    assert told["f1_max_recall"] == 0.5


def test_f1_max_of_perfect_answers_is_one() -> None:
    told = place_figures([answer(0.9, 1.0), answer(0.1, 60.0, NEW_PLACE)], LOOPS)
    assert (told["f1_max"], told["f1_max_precision"], told["f1_max_recall"]) == (1.0, 1.0, 1.0)


def test_recall_within_each_radius_has_its_own_revisits() -> None:
    told = place_figures([answer(0.9, 8.0, 4.0), answer(0.9, 24.0, 22.0)], LOOPS)
    within = told["recall_at_1_within_m"]
    assert within == {"3": None, "5": 0.0, "10": 1.0, "20": 1.0, "25": 1.0}


def test_figures_without_revisits_are_undefined() -> None:
    for answers in ([], [answer(0.9, 60.0, NEW_PLACE)], [answer(0.0, np.inf, np.inf)]):
        told = place_figures(answers, LOOPS)
        assert (told["recall_at_1"], told["f1_max"]) == (None, None)
        json.dumps(told, allow_nan=False)


def test_retrieved_frame_is_nearest_to_the_best_pose() -> None:
    made = scene(1)
    found = localize(made.candidates)
    sensor = made.candidates.centroids.mean(axis=0)
    place = made.pose.apply(sensor)
    query = PoseQuery(
        0, 0.0, 0.0, np.zeros((1, 2), np.int8), np.zeros((1, 3)), sensor, made.pose, mapped=True
    )
    frames = place + np.array([[9.0, 0, 0], [3.0, 0, 4.0], [0, 30.0, 0]])
    told = place_answer(found, query, frames)
    assert told.score == found.probability
    assert told.retrieved_m == pytest.approx(5.0)
    assert told.nearest_m == pytest.approx(5.0)
    assert place_answer(found, query, frames, flat=True).retrieved_m == pytest.approx(3.0)
    lost = localize(scene(2, found=0.0).candidates)
    assert place_answer(lost, query, frames) == PlaceAnswer(0.0, np.inf, told.nearest_m)
    assert place_answer(found, query, frames[:0]) == PlaceAnswer(0.0, np.inf, np.inf)


AREA = np.concatenate(BOXES)


def lap(count: int) -> list[np.ndarray]:
    """Return sensor poses out and back along x: each place is visited twice."""
    out = [float(step) for step in range(count // 2)]
    return [pose(x, 0.0, 0.0) for x in (*out, *reversed(out))]


def seen(at: np.ndarray) -> np.ndarray:
    """Return the points of the built-up area in the sensor's frame."""
    return np.asarray(AREA - at[:3, 3])


@pytest.fixture
def model(tmp_path: Path) -> Path:
    write_eigenvalue_model(tmp_path / "models")
    return tmp_path / "models" / "tiny"


@pytest.mark.slow
def test_loop_is_searched_in_what_is_old_enough(tmp_path: Path, model: Path) -> None:
    drive = trip(tmp_path / "a", 40, left=range(0))  # a scan each 0.1 s
    pair = robots_of_places(drive.folder, None)
    with Engine.temporary(model) as engine:
        whole = pair.mapper.build_map(engine, "map")
        queries = list(pair.queries(engine, Pose(np.eye(3), np.zeros(3))))
    steps = list(earlier(pair.mapper, whole, queries, skip_seconds=1.5))
    assert [query.scan for step in steps for query in step.queries] == [*range(15, 40)]
    for step in steps:
        assert len(step.queries) <= TOGETHER
        newest = step.queries[0].scan - 15
        assert len(step.frames) == newest + 1
        seen_at = step.content.frame_times[step.content.frame_index]
        assert seen_at.max() <= step.queries[0].time - 1.5 + 1e-9
    report = evaluate_places(pair, model, PlaceProtocol("near", 3.0, 20.0, 1.5))
    assert (report["queries"], report["skip_seconds"]) == (25, 1.5)


@pytest.mark.slow
def test_mulran_sequence_finds_its_loops(tmp_path: Path, model: Path) -> None:
    way = lap(24)
    folder = write_mulran(tmp_path / "KAIST01", [seen(at) for at in way], way, 10_000_000_000)
    file = tmp_path / "loops.json"
    words = ["--protocol", "mulran", "--model", str(model), "--json", str(file)]
    run = CliRunner().invoke(app, ["evaluate", str(folder), *words])
    assert run.exit_code == 0, run.output
    report = json.loads(file.read_text())
    assert report["evaluation"] == "mulran"
    (figures,) = report["models"].values()
    # Scans are 10 s apart: the first 90 s are no queries.
    assert figures["queries"] == 24 - 9
    assert figures["revisits"] > 0
    assert figures["recall_at_1"] > 0.9
    assert "recall_at_1 within 25 m" in run.stdout


@pytest.mark.slow
def test_helipr_sensors_share_a_map(tmp_path: Path, model: Path) -> None:
    way = [pose(1_000.0 + step, 2_000.0, 30.0) for step in range(8)]
    at_origin = [pose(float(step), 0.0, 0.0) for step in range(8)]
    folders = [
        write_helipr(tmp_path / name, sensor, [seen(at) for at in at_origin], way)
        for name, sensor in (("Town01", "Ouster"), ("Town03", "Aeva"))
    ]
    words = ["--map-drive", str(folders[0]), "--protocol", "helipr", "--model", str(model)]
    file = tmp_path / "places.json"
    run = CliRunner().invoke(app, ["evaluate", str(folders[1]), *words, "--json", str(file)])
    assert run.exit_code == 0, run.output
    (figures,) = json.loads(file.read_text())["models"].values()
    assert (figures["map_drive"], figures["query_drive"]) == ("Town01-Ouster", "Town03-Aeva")
    assert (figures["queries"], figures["revisits"], figures["recall_at_1"]) == (8, 8, 1.0)
    assert figures["skip_seconds"] is None


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--protocol", "kitty"], "Invalid --protocol 'kitty': expected one of kitti-loops"),
        (["--map-drive", "b"], "--map-drive needs --protocol"),
        (["--protocol", "mulran", "--scans", "0:9"], "Omit it with --protocol"),
    ],
)
def test_wrong_protocol_is_refused(words: list[str], said: str) -> None:
    result = CliRunner().invoke(app, ["evaluate", "a", *words])
    assert result.exit_code != 0
    assert said in result.stderr
