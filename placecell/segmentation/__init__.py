"""Segmentation: from the scans of a drive to groups of segments (paper III-A)."""
