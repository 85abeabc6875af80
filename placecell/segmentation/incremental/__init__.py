"""Incremental segmentation: segments of the local map at each scan, with ids that persist."""

from placecell.segmentation.incremental.live_segments import LiveSegments
from placecell.segmentation.incremental.segmentation import IncrementalSegmentation

__all__ = ["IncrementalSegmentation", "LiveSegments"]
