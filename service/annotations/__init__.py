"""Annotations of maps: tags, the place of a map on the Earth, and named poses."""
