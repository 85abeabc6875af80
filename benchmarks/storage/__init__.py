"""Storage benchmarks: large maps, descriptor compression and stored views."""
