"""Folders of point cloud files: PCD, PLY, LAS, NumPy, text, and files without a header."""

from placecell.sources.clouds.folder import FolderOfClouds

__all__ = ["FolderOfClouds"]
