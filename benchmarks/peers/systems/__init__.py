"""Compared systems, each behind the interface `Locator` of `benchmarks/peers/runner.py`."""
