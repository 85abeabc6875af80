"""Memory of the loops of earlier optimizations."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client.maps.edit import take

from placecell.core.types import Int64
from placecell.pose_graph.known_loops import KnownLoops
from service.core.preconditions import Preconditions
from service.engine import Engine
from service.merging.loop_memory import LoopMemory
from tests.service.merging.drifting_maps import drifting_map
from tests.service.service_builders import write_eigenvalue_model


def test_least_recently_optimized_map_is_forgotten() -> None:
    memory = LoopMemory(2)
    loops = [KnownLoops(frozenset({(number, 0.0)}), ()) for number in range(3)]
    memory.put("a", "m", loops[0])
    memory.put("b", "m", loops[1])
    memory.put("a", "m", loops[0])
    memory.put("c", "m", loops[2])
    assert memory.get("a", "m") is loops[0]
    assert memory.get("b", "m") is None
    assert memory.get("c", "m") is loops[2]
    assert memory.get("c", "other") is None


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
        again = engine.optimize_map("block")
        assert localized[0] > 60
        assert localized[1] == 0
        np.testing.assert_array_equal(again.bent.positions, first.bent.positions)
        engine.put_map("block", grown, conditions=Preconditions("*"))
        last = engine.optimize_map("block")
    assert 0 < localized[2] < 0.4 * localized[0]
    assert last.bent.accepted > first.bent.accepted
    assert last.bent.after < 0.3
