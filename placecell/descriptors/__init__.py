"""Descriptors: orientation, voxels, neighborhood, extractors and stored codes."""
