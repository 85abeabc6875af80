"""Merging: alignment of stored maps and the merged map of several robots."""
