"""Shapes of stored segments: occupancy, points and meshes, decoded from the codes of a map."""
