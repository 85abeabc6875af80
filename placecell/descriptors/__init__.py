"""Descriptors: orientation, voxels, neighborhood, extractors and codes."""
