"""Writes to maps: validation, rules, partial uploads and maintenance."""
