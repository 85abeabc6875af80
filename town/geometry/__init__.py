"""Geometry: triangle meshes, solids and ray casting."""
