"""Compact maps: their canonical form, files, edits and unions."""
