"""The cache of compiled code is optional: a broken cache never prevents compilation."""

import errno
import importlib.util
import logging
import pickle
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import numpy as np
import pytest

from placecell.core import jit

SOURCE = """
from placecell.core.jit import compiled

@compiled
def double(values):
    for place in range(len(values)):
        values[place] *= 2
"""


@pytest.fixture
def _nothing_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jit, "_logged", set())


@pytest.fixture
def cached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, _nothing_told: None
) -> Iterator[Callable[[], Any]]:
    """Return a loader of the compiled function, as another process, from the same cache."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    file = tmp_path / "doubling.py"
    file.write_text(SOURCE)

    def load() -> Any:
        spec = importlib.util.spec_from_file_location("doubling", file)
        assert spec is not None
        assert spec.loader is not None
        module: ModuleType = importlib.util.module_from_spec(spec)
        sys.modules["doubling"] = module
        spec.loader.exec_module(module)
        return module.double

    yield load
    sys.modules.pop("doubling", None)


def doubles(function: Any) -> bool:
    """Return whether the function works."""
    values = np.arange(4)
    function(values)
    return values.tolist() == [0, 2, 4, 6]


def hits(function: Any) -> int:
    return sum(function.stats.cache_hits.values())


def files(tmp_path: Path) -> dict[str, Path]:
    return {file.suffix: file for file in (tmp_path / "cache").rglob("*.nb?")}


class Foreign:
    """Class that the reader of the file does not know."""


def _cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def _empty(file: Path) -> None:
    file.write_bytes(b"")


def _flip(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) * 2 // 3] ^= 0xFF
    file.write_bytes(content)


def _other_numba(file: Path) -> None:
    file.write_bytes(pickle.dumps("0.1.0") + b"of another form")


def _same_version_but_no_index(file: Path) -> None:
    file.write_bytes(pickle.dumps(jit.CACHE_VERSION) + pickle.dumps(("stamp", 7)))


def _foreign(file: Path) -> None:
    file.write_bytes(pickle.dumps(Foreign()).replace(b"Foreign", b"Unknown"))


def _gone(file: Path) -> None:
    file.unlink()


def _folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


DAMAGES = [
    _cut,
    _empty,
    _flip,
    _other_numba,
    _same_version_but_no_index,
    _foreign,
    _gone,
    _folder,
]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_B2_damaged_cache_is_compiled_again_and_replaced(
    tmp_path: Path,
    cached: Callable[[], Any],
    caplog: pytest.LogCaptureFixture,
    damage: Callable[[Path], None],
    suffix: str,
) -> None:
    assert doubles(cached())
    before = cached()
    assert doubles(before)
    assert hits(before) == 1  # else the test would test nothing
    damage(files(tmp_path)[suffix])
    with caplog.at_level(logging.WARNING):
        after = cached()
        assert doubles(after)
    assert hits(after) == 0
    assert len(caplog.records) <= 2  # one that it cannot be read, one that it cannot be written
    last = cached()
    assert doubles(last)
    assert hits(last) == (damage is not _folder)


def test_B2_full_disk_leaves_the_cache_unwritten(
    cached: Callable[[], Any], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(self: object, path: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", path)

    monkeypatch.setattr(jit.CheckedCacheFile, "_open_for_write", full)
    with caplog.at_level(logging.WARNING):
        assert doubles(cached())
        assert doubles(cached())
    assert [record.getMessage()[:40] for record in caplog.records] == [
        "the cache of compiled code is unwritable"
    ]


def test_B2_cache_folder_that_is_a_file(tmp_path: Path, cached: Callable[[], Any]) -> None:
    function = cached()
    folder = tmp_path / "cache"
    for below in sorted(folder.rglob("*"), reverse=True):
        below.rmdir()
    folder.rmdir()
    folder.write_text("no folder")
    assert doubles(function)
    assert doubles(cached())


def test_B2_cache_that_cannot_be_made(
    cached: Callable[[], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(self: object, function: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr("numba.core.caching.Cache.__init__", fail)
    assert doubles(cached())


def test_B2_every_compiled_function_has_the_one_decorator() -> None:
    root = Path(jit.__file__).parents[2]
    using = [
        file.relative_to(root).as_posix()
        for folder in (
            "placecell",
            "service",
            "town",
            "evaluation",
            "benchmarks",
            "cli",
            "training",
        )
        for file in (root / folder).rglob("*.py")
        if "njit(" in file.read_text() or "numba.jit" in file.read_text()
    ]
    assert using == ["placecell/core/jit.py"]
