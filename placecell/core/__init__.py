"""Core types: point segments in columns, parameters, compiled loops and spatial helpers."""
