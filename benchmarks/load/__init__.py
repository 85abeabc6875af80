"""Load benchmarks: throughput and latency of the service and of inference."""
