"""Point cloud files that clients send: reading with limits, and segmentation."""
