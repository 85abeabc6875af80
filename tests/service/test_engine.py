"""The engine does in one process, without HTTP, what the service does for its clients."""

import os
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Delta

import service.engine
from placecell.descriptors.manifest import Manifest, ModelError
from service.core.auth import Key, Principal
from service.core.problems import Problem
from service.core.settings import Settings
from service.engine import Engine, StartError
from service.inference.scan import Scan
from tests.service.service_builders import (
    cloud,
    map_of,
    random_codes,
    request_of,
    write_eigenvalue_model,
)

SENSOR = (9.0, -3.0, 1.7)


@pytest.fixture
def engine(models_dir: Path, data_dir: Path) -> Iterator[Engine]:
    with Engine.open(Settings(data_dir=data_dir, models_dir=models_dir, model="tiny")) as engine:
        yield engine


def clouds(count: int = 12) -> list[np.ndarray]:
    """Clouds apart from each other, so that they can be localized."""
    return [cloud(seed) + (10 * seed, 5 * (seed % 3), 0) for seed in range(count)]


def yard_of(engine: Engine, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
    """A map of the clouds, shifted."""
    seen = engine.describe(clouds(), SENSOR)
    assert seen.centroids is not None
    yard = map_of(seen.codes, seen.model_id)
    return replace(yard, centroids=seen.centroids + shift)


def test_docstring_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    documented = service.engine.__doc__
    assert documented is not None
    lines = documented.splitlines()
    example = textwrap.dedent("\n".join(each for each in lines if each.startswith("    ")))
    write_eigenvalue_model(tmp_path / "models", "context")
    monkeypatch.chdir(tmp_path)
    with Engine.temporary(tmp_path / "models" / "context") as engine:
        yard = yard_of(engine, (5.0, 1.0, 0.0))
    names: dict[str, Any] = {"yard": yard, "clouds": clouds(), "sensors": SENSOR}
    exec(compile(example, "example", "exec"), names)
    pose = names["result"][0].localization.pose
    np.testing.assert_allclose(pose.translation, (5.0, 1.0, 0.0), atol=0.01)


def test_engine_needs_no_http_library() -> None:
    program = """
        import sys
        for name in ("fastapi", "starlette", "uvicorn", "h11", "service.api", "service.app"):
            sys.modules[name] = None  # its import fails
        from service.engine import Engine
        print(Engine.__name__)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ,
        timeout=120,
    )
    assert done.stdout == "Engine\n", done.stderr


def test_engine_describes_bit_for_bit_as_the_service(engine: Engine, start: Any) -> None:
    mine = engine.describe(clouds(), SENSOR)
    engine.close()
    with start() as client:
        told = client.post("/describe", json=request_of(clouds(), SENSOR)).json()
    assert mine.values is not None
    assert mine.codes.tolist() == [each["codes"] for each in told["descriptors"]]
    assert mine.values.tolist() == [each["descriptor"] for each in told["descriptors"]]


def test_unusable_segment_keeps_its_place(engine: Engine) -> None:
    seen = engine.describe([cloud(1), cloud(2, 3), cloud(3)], SENSOR)
    assert len(seen) == 3
    assert seen.usable.tolist() == [0, 2]
    assert seen.errors[1].kind == "too-few-points"
    assert seen.values is not None
    assert np.isnan(seen.values[1]).all()
    assert seen.codes[2].tolist() == engine.describe([cloud(3)], SENSOR).codes[0].tolist()
    assert engine.match(seen)[1] == seen.errors[1]


def test_match_finds_the_same_segments_by_scan_and_by_descriptors(engine: Engine) -> None:
    engine.put_map("yard", yard_of(engine))
    by_codes = engine.match(engine.describe(clouds(), SENSOR), k=3)
    by_scan = engine.match(Scan.from_clouds(clouds(), SENSOR), k=3)
    assert len(by_codes) == len(by_scan) == 12
    for query in range(12):
        assert by_codes[query] == by_scan[query]
        assert by_codes[query][0]["id"] == 100 + query  # type: ignore[index]


def test_match_without_maps_has_no_candidates(engine: Engine) -> None:
    assert list(engine.match(engine.describe(clouds(3), SENSOR))) == [[], [], []]
    assert list(engine.match(Scan.from_clouds(clouds(3), SENSOR))) == [[], [], []]
    assert len(engine.localize(engine.describe(clouds(3), SENSOR))) == 0


def test_map_is_written_read_restored_and_deleted(engine: Engine, manifest: Manifest) -> None:
    codes = random_codes(20)
    first = engine.put_map("yard", map_of(codes[:10], manifest.model_id))
    added = map_of(codes[10:], manifest.model_id, first_id=200)
    engine.edit_map("yard", Delta(added, np.zeros(0, np.uint32)))
    assert len(engine.get_map("yard")) == 20
    assert len(engine.get_map("yard", version=1)) == 10
    assert [each.sequence for each in engine.versions("yard")] == [1, 2]
    assert len(engine.changes("yard", since=1).delta.changed) == 10
    assert first.is_new
    engine.restore_map("yard", 1)
    assert len(engine.get_map("yard")) == 10
    engine.delete_map("yard")
    with pytest.raises(Problem, match="No map is named 'yard'"):
        engine.get_map("yard")


def test_maps_are_aligned_and_merged(engine: Engine) -> None:
    engine.put_map("a", yard_of(engine))
    engine.put_map("b", yard_of(engine, (3.0, -2.0, 0.0)))
    pose = engine.align("a", "b").pose
    assert pose is not None
    np.testing.assert_allclose(pose.translation, (-3.0, 2.0, 0.0), atol=0.01)
    planned = engine.merge_maps("site", ["a", "b"], dry_run=True)
    assert planned.written is None
    merged = engine.merge_maps("site", ["a", "b"], deduplicate=False)
    assert merged.segments == planned.segments + 12 == len(engine.get_map("site"))


def test_writes_outside_the_scope_of_a_principal_are_refused(engine: Engine) -> None:
    reader = Principal("reader", Key(sha256="0" * 64))
    yard_only = Principal("yard", Key(sha256="1" * 64, write=True, maps=("yard",)))
    other = engine.put_map("other", yard_of(engine)).snapshot
    nothing = Delta(other.layers.take(np.zeros(0, np.uint32)), np.zeros(0, np.uint32))
    refused: list[Callable[[], object]] = [
        lambda: engine.put_map("yard", yard_of(engine), principal=reader),
        lambda: engine.put_map("other", yard_of(engine), principal=yard_only),
        lambda: engine.edit_map("other", nothing, principal=yard_only),
        lambda: engine.restore_map("other", 1, principal=yard_only),
        lambda: engine.prune_map("other", 0.0, principal=yard_only),
        lambda: engine.compact_map("other", principal=yard_only),
        lambda: engine.delete_map("other", principal=yard_only),
        lambda: engine.merge_maps("other", ["yard"], principal=yard_only),
        lambda: engine.merge_maps("yard", ["other", "more"], principal=yard_only),
    ]
    for write in refused:
        with pytest.raises(Problem) as caught:
            write()
        assert caught.value.status == 403
    assert [each.name for each in engine.maps.all()] == ["other"]


def test_session_of_one_robot_is_remembered(engine: Engine) -> None:
    engine.put_map("yard", yard_of(engine))
    seen = engine.describe(clouds(), SENSOR)
    engine.localize(seen, session="robot-1")
    assert len(engine.sessions) == 1


def test_data_directory_is_released_on_close(models_dir: Path, data_dir: Path) -> None:
    settings = Settings(data_dir=data_dir, models_dir=models_dir, model="tiny")
    with Engine.open(settings), pytest.raises(StartError, match="data directory"):
        Engine.open(settings)
    with Engine.open(settings) as engine:
        assert len(engine.maps) == 0


def test_unknown_model_is_refused(models_dir: Path, data_dir: Path) -> None:
    settings = Settings(data_dir=data_dir, models_dir=models_dir, model="none")
    with pytest.raises(StartError, match="model 'none' cannot be loaded"):
        Engine.open(settings)
    with pytest.raises(ModelError):
        Engine.temporary(models_dir / "none")


def test_temporary_engine_leaves_nothing(models_dir: Path) -> None:
    engine = Engine.temporary(models_dir / "tiny")
    folder = engine.settings.data_dir
    assert folder.is_dir()
    engine.close()
    assert not folder.exists()
