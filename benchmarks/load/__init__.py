"""Load benchmarks: speed and saturation of the service and of inference."""
