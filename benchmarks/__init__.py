"""What measures from outside: the demo with its robots and its score, benchmarks."""
