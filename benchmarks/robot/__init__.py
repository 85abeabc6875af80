"""Measurements of a robot's own steps, from its scans to its pose."""
