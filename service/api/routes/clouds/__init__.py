"""Routes of point cloud files: scans that clients send, and maps for other programs."""
