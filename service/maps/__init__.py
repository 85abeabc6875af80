"""Stored maps: snapshots, indexes, history and the repository that holds them."""
