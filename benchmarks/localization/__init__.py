"""Localization benchmarks: map alignment, look-alike floors and tables."""
