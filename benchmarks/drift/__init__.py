"""Drift: maps that bend, before and after the optimization of their pose graph."""
