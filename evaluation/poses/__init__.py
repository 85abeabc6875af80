"""Evaluation of poses: queries with known answers and the report on them."""
