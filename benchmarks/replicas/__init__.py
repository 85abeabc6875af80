"""Benchmarks of replicas on PostgreSQL behind a balancer: faults, and throughput."""
