"""Benchmarks: load, durability, storage, localization, attacks, and other systems."""
