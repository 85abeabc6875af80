"""Storage benchmarks: large maps, compression and stored views."""
