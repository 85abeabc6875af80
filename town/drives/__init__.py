"""Drives: simulated recordings of one or several robots."""
