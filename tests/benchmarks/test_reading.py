"""The measurement of readers, on small clouds."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.load import reading


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "POINTS", 1500)


@pytest.mark.usefixtures("small")
def test_every_format_is_read_as_it_was_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def theirs(name: str, path: Path) -> Any:
        if name == "MCAP":
            print("a plugin is missing")
            raise SystemExit(1)
        return reading.read_ours(path)

    monkeypatch.setattr(reading, "read_theirs", theirs)
    with reading.one_core():
        report = reading.measure_reading(3, 1, 7, tmp_path)
    assert list(report["rows"]) == list(reading.FORMATS)
    for row in report["rows"].values():
        assert row["placecell"]["clouds_per_second"] > 0
        assert row["megabytes"] > 0
    assert report["rows"]["MCAP"]["kiss_icp"]["failed"] == "SystemExit: 1 a plugin is missing"
    assert report["rows"]["PCD binary"]["ratio"] > 0
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("small")
def test_reader_that_returns_other_points_is_refused() -> None:
    table = reading.drawn(1)
    with pytest.raises(ValueError, match="not the"):
        reading.best(lambda: iter([np.zeros((1500, 3))]), [table], 1)
