"""Memory of the loops of earlier optimizations."""

from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client.maps.edit import take

from placecell.core.types import Int64
from placecell.pose_graph.known_loops import KnownLoops
from placecell.pose_graph.parameters import PoseGraphParameters
from service.core.preconditions import Preconditions
from service.engine import Engine
from service.merging.loop_memory import LoopMemory
from tests.placecell.pose_graph.graph_builders import frames_of, loops_between, square_path
from tests.service.merging.drifting_maps import drifting_map
from tests.service.service_builders import write_eigenvalue_model


def test_least_recently_optimized_map_is_forgotten() -> None:
    memory = LoopMemory(most=2)
    loops = [KnownLoops(frozenset({(number, 0.0)}), ()) for number in range(3)]
    memory.put("a", "m", loops[0])
    memory.put("b", "m", loops[1])
    memory.put("a", "m", loops[0])
    memory.put("c", "m", loops[2])
    assert memory.get("a", "m") is loops[0]
    assert memory.get("b", "m") is None
    assert memory.get("c", "m") is loops[2]
    assert memory.get("c", "other") is None


def test_loops_survive_a_restart_and_damaged_files_are_ignored(tmp_path: Path) -> None:
    positions, yaws = square_path(20, 2)
    pairs = np.array([[0, 80], [10, 90]])
    loops = loops_between(pairs, positions, yaws, np.random.default_rng(1))
    frames = frames_of(positions, yaws)
    known = KnownLoops.of(frames, np.arange(0, 160, 2), loops)
    folder = tmp_path / "cache"
    LoopMemory(folder).put("a", "finder", known)
    found = LoopMemory(folder).get("a", "finder")
    assert found is not None
    assert found.localized == known.localized
    parameters = PoseGraphParameters()
    kept, before, _ = found.in_map(frames, np.arange(160), parameters)
    wanted, _, _ = known.in_map(frames, np.arange(160), parameters)
    assert [[each.one, each.other] for each in kept] == pairs.tolist()
    for one, other in zip(kept, wanted, strict=True):
        np.testing.assert_array_equal(one.covariance, other.covariance)
        np.testing.assert_array_equal(one.position, other.position)
        assert (one.yaw, one.probability, one.inliers) == (
            other.yaw,
            other.probability,
            other.inliers,
        )
    assert before.tolist() == list(range(0, 160, 2))
    assert LoopMemory(folder).get("a", "another model") is None
    assert LoopMemory(folder).get("b", "finder") is None
    (file,) = folder.iterdir()
    data = file.read_bytes()
    for wrong in (b"", data[: len(data) // 2], b"no archive", data.replace(b"tracks", b"trucks")):
        file.write_bytes(wrong)
        assert LoopMemory(folder).get("a", "finder") is None
    file.write_bytes(data)
    with np.load(BytesIO(data)) as arrays:
        shorter = {**arrays, "yaws": arrays["yaws"][:1]}
    with file.open("wb") as written:
        np.savez(written, **shorter)
    assert LoopMemory(folder).get("a", "finder") is None


def test_map_without_loops_is_remembered_too(tmp_path: Path) -> None:
    LoopMemory(tmp_path).put("a", "finder", KnownLoops(frozenset(), ()))
    found = LoopMemory(tmp_path).get("a", "finder")
    assert found is not None
    assert (found.localized, found.loops) == (frozenset(), ())


@pytest.mark.slow
def test_only_new_captures_of_a_grown_map_are_localized(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_eigenvalue_model(tmp_path, pair_threshold=0.8)
    localized: list[int] = []
    bending = import_module("placecell.pose_graph.bend")  # the package has a function of this name
    find = bending.find_loops

    def counted(*args: Any) -> Any:
        chosen: Int64 = args[4]
        localized.append(len(chosen))
        return find(*args)

    monkeypatch.setattr(bending, "find_loops", counted)
    with Engine.temporary(tmp_path / "tiny") as engine:
        grown, _ = drifting_map(engine.model.id, 1, odometry=True)
        some = take(grown, np.flatnonzero(grown.frame_index < 150))
        engine.put_map("block", some)
        first = engine.optimize_map("block", dry_run=True)
        engine.loops = LoopMemory(engine.loops._folder)  # as after a restart
        again = engine.optimize_map("block")
        assert localized[0] > 60
        assert localized[1] == 0
        np.testing.assert_array_equal(again.bent.positions, first.bent.positions)
        engine.put_map("block", grown, conditions=Preconditions("*"))
        last = engine.optimize_map("block")
    assert 0 < localized[2] < 0.4 * localized[0]
    assert last.bent.accepted > first.bent.accepted
    assert last.bent.after < 0.3
