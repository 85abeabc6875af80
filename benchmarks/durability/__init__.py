"""Durability benchmarks: crashes, broken links and power loss."""
