"""Standing attack on the service: one case for each fault of load and security."""
