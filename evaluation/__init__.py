"""Evaluation: measures recognition and poses on drives."""
