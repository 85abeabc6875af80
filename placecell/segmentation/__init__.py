"""Segmentation: the steps from a drive's scans to groups of segments (paper III-A)."""
