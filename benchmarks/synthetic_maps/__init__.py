"""Synthetic maps: random segments, sampled descriptors, and a road."""
