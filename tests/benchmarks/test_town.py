from pathlib import Path

import pytest

from benchmarks.town import measure_town


def test_figures_are_those_of_the_simulated_drive(tmp_path: Path) -> None:
    report = measure_town(tmp_path, meters=600.0, scans=6, spacing=0.5)
    assert report["scans"] == len(list((tmp_path / "velodyne").iterdir())) == 6
    assert report["street_metres"] >= 600.0
    assert report["whole_scans"] == int(report["route_metres"] / 0.5)
    assert report["segments_per_frame"] > 5
    assert report["megabytes_per_scan"] == pytest.approx(0.95, abs=0.2)
    minutes = report["whole_scans"] * report["simulation_seconds_per_scan"] / 60
    assert report["whole_simulation_minutes"] == pytest.approx(minutes, abs=0.1)
