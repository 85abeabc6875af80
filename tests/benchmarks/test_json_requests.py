import pytest

from benchmarks.load.json_requests import measure_json_requests


@pytest.mark.slow
def test_report_names_its_baseline_and_has_both_readers() -> None:
    report = measure_json_requests(seconds=0.1)
    assert set(report["rows"]) == {"baseline", "compiled"}
    assert report["saturation_ratio"] > 0
    assert report["longest_pause_ms"] > 0
    assert "pydantic" in report["baseline"]
